// SPDX-License-Identifier: BSD-3-Clause
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
using testing::Not;

TEST(Report, NamesImagesThatAreMissingOrNone) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  run_into(directory, "");
  fs::remove(directory + "/tracks.png");
  write(directory + "/errors.png", "GIF89a");
  const std::string page = experiment::report_page({directory});
  EXPECT_THAT(page, HasSubstr("tracks.png is missing."));
  EXPECT_THAT(page, HasSubstr("errors.png is not a complete PNG file."));
  EXPECT_EQ(problems_of_page(page), "");
}

TEST(Report, TakesNoImageThatIsCutOffOrDamaged) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  run_into(directory, "");
  const std::string good = text_of_file(directory + "/tracks.png");
  ASSERT_TRUE(experiment::is_whole_png(good));
  std::string damaged = good;
  damaged[good.size() / 2] ^= 1;
  for (const std::string& bad : {good.substr(0, 8), good.substr(0, good.size() / 2), good + "x", damaged}) {
    EXPECT_FALSE(experiment::is_whole_png(bad));
    write(directory + "/tracks.png", bad);
    const std::string page = experiment::report_page({directory});
    EXPECT_THAT(page, HasSubstr("tracks.png is not a complete PNG file."));
    EXPECT_THAT(page, Not(HasSubstr("<img")));
  }
}

}  // namespace
