// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/run_record.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "experiment/files/html.hpp"
#include "experiment/report/report_page.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/version.hpp"
#include "tests/experiment/report/report_pages.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using namespace report_pages;

namespace fs = std::filesystem;

using test_support::ScratchFolder;
using testing::HasSubstr;

std::string error_of_report(const std::vector<std::string>& directories) {
  try {
    experiment::report_page(directories);
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(Report, ReportsWhatIsNoResultsFolder) {
  const ScratchFolder folder;
  EXPECT_THAT(error_of_report({folder.file("nowhere")}), HasSubstr("nowhere: is not a folder"));
  fs::create_directory(folder.file("empty"));
  EXPECT_THAT(error_of_report({folder.file("empty")}), HasSubstr("it has neither summary.json nor study.json"));
  write(folder.file("file"), "x");
  EXPECT_THAT(error_of_report({folder.file("file")}), HasSubstr("is not a folder"));
}

TEST(Report, ReportsWhatIsWrongWithASummary) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  run_into(directory, "metrics: [{name: distance, type: distance, vehicle: r1}]\n");
  const std::string good = text_of_file(directory + "/summary.json");
  const auto error_with = [&](const std::string& text) {
    write(directory + "/summary.json", text);
    return error_of_report({directory});
  };
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.replace(at, from.size(), to);
  };
  EXPECT_THAT(error_with(good.substr(0, good.size() / 2)), HasSubstr(": must be JSON, got "));
  EXPECT_THAT(error_with(""), HasSubstr("summary.json:1:1: must be JSON, got the end of the file"));
  EXPECT_THAT(error_with("{\n  \"seed\": 7;\n}\n"), HasSubstr("summary.json:2:12: must be JSON, got ';'"));
  EXPECT_THAT(error_with("{\"seed\": 1e999}"), HasSubstr("summary.json: must be JSON with numbers of at most"));
  EXPECT_THAT(error_with("[1, 2]"), HasSubstr("must be an object, got [1,2]"));
  EXPECT_THAT(error_with("{}"), HasSubstr("has no 'world'"));
  EXPECT_THAT(error_with(changed("\"seed\": 7", "\"seed\": \"x\"")),
              HasSubstr("'seed' must be a whole number, got \"x\""));
  EXPECT_THAT(error_with(changed("\"rules\": []", "\"rules\": 3")), HasSubstr("'rules' must be a list, got 3"));
  EXPECT_THAT(error_with(changed("\"rules\": []", "\"rules\": [{\"rule\": 1}]")),
              HasSubstr("rules: 'rule' must be text"));
  EXPECT_THAT(error_with(changed("\"distance.travelled_m\": ", "\"distance.travelled_m\": \"far\", \"x\": ")),
              HasSubstr("'distance.travelled_m' must be a number or null, got \"far\""));
  write(directory + "/summary.json", good);
  EXPECT_EQ(error_of_report({directory}), "");
}

}  // namespace
