// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/report/report_page.hpp"

#include <gmock/gmock.h>

#include "experiment/files/html.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/version.hpp"
#include "tests/experiment/report/report_pages.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using namespace report_pages;

using test_support::ScratchFolder;
using testing::HasSubstr;
using testing::Not;

TEST(Report, OfARunIsOnePageWithVerdictsFirst) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  const experiment::Summary summary = run_into(directory,
                                               "metrics: [{name: distance, type: distance, vehicle: r1}]\n"
                                               "pass: [distance.travelled_m < 1, "
                                               "distance.travelled_m > 1]\n");
  ASSERT_EQ(summary.exit_code, 1);
  const std::string page = experiment::report_page({directory});
  EXPECT_EQ(problems_of_page(page), "");
  EXPECT_THAT(page, HasSubstr("<title>small</title>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Seed</th><td>7</td>"));
  EXPECT_THAT(page, HasSubstr(experiment::short_version()));
  EXPECT_THAT(page, HasSubstr("<span class=\"bad\">FAILED</span> distance.travelled_m"));
  EXPECT_THAT(page, HasSubstr("<span class=\"good\">passed</span> distance.travelled_m"));
  EXPECT_THAT(page, HasSubstr("1 of 2 rules holds, 1 failed."));
  EXPECT_LT(page.find("FAILED"), page.find("r1 traveled"));
  EXPECT_LT(page.find("r1 traveled"), page.find("<img"));
  EXPECT_LT(page.find("<img"), page.find("<h2>Figures"));
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64,iVBORw0KGgo"));
  EXPECT_EQ(problems_of_page(experiment::report_page({directory + "/"})), "");
}

TEST(Report, NamesInAWorldAreNoHtml) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  run_into(directory, "", "</title><script>alert(1)</script> \" onload=x");
  write(directory + "/pilot.log", "<img src=x onerror=y>\n\x1b[31m\xff");
  const std::string page = experiment::report_page({directory});
  EXPECT_EQ(problems_of_page(page), "");
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("&lt;img src=x onerror=y&gt;"));
}

TEST(Report, SaysWhatTheWorldIsAndThatNothingWasJudged) {
  const ScratchFolder folder;
  run_into(folder.file("a"), "description: A rover & its <lidar>.\n");
  const std::string page = experiment::report_page({folder.file("a")});
  EXPECT_THAT(page, HasSubstr("<p>A rover &amp; its &lt;lidar&gt;.</p>"));
  EXPECT_THAT(page, HasSubstr("not judged</span>: the world has no rules"));
  EXPECT_THAT(page, Not(HasSubstr("passed</span>")));
  run_into(folder.file("b"),
           "metrics: [{name: distance, type: distance, vehicle: r1}]\n"
           "pass: [distance.travelled_m < 1]\n");
  EXPECT_THAT(experiment::report_page({folder.file("a"), folder.file("b")}),
              HasSubstr("<tr><td>verdict</td><td>not judged</td><td>passed</td></tr>"));
}

TEST(Report, ARunThatWasEndedByHandIsNotJudged) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  experiment::Summary summary = run_into(directory, "");
  summary.ended = "quit";
  experiment::write_summary(directory, summary);
  const std::string page = experiment::report_page({directory});
  EXPECT_THAT(page, HasSubstr("not judged</span>: ended by quit"));
  EXPECT_THAT(page, Not(HasSubstr("passed</span>")));
  EXPECT_THAT(page, Not(HasSubstr("FAILED</span>")));
}

TEST(Report, ReportsProgramsThatFailedAndOfAnOutage) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  const experiment::Summary run = run_into(directory, "");
  experiment::Summary summary = run;
  summary.processes = {{"pilot", "was killed by signal 9 (Killed)", 2, true}};
  summary.metrics["place.max_gap_s"] = 60;
  experiment::write_summary(directory, summary);
  const std::string page = experiment::report_page({directory});
  EXPECT_THAT(page, HasSubstr("Programs of the world failed."));
  EXPECT_THAT(page, HasSubstr("For 60.0 s there was no estimate: place.max_gap_s."));
}

TEST(Report, SaysWhatTouchedWhat) {
  const ScratchFolder folder;
  const std::string directory = folder_of(folder, {}, "");
  EXPECT_THAT(experiment::report_page({directory}), HasSubstr("The world has no metrics: nothing was measured."));
  std::string summary = text_of_file(directory + "/summary.json");
  const std::string none = "\"contacts\": []";
  ASSERT_NE(summary.find(none), std::string::npos) << summary;
  summary.replace(summary.find(none), none.size(),
                  R"("contacts": [{"vehicle": "auv4", "with": "rock", "first_s": 105.7, "count": 3}])");
  write(directory + "/summary.json", summary);
  EXPECT_THAT(experiment::report_page({directory}), HasSubstr("<li>auv4 hits rock at 105.7 s, 3 times in all.</li>"));
}

TEST(ReportPage, ListsMessagesThatShadowsTook) {
  const ScratchFolder folder;
  experiment::Summary summary = run_into(folder.file("run"), "");
  summary.acoustics.emplace();
  summary.acoustics->lost["shadow"] = 1;
  summary.shadowed = {{12.5, "boat/modem", "auv/modem", 431}};
  write(folder.file("run/summary.json"), summary.to_json());
  const std::string page = experiment::report_page({folder.file("run")});
  EXPECT_THAT(page, HasSubstr("Packets in shadows"));
  EXPECT_THAT(page, HasSubstr("12.500 s"));
  EXPECT_THAT(page, HasSubstr("boat/modem to auv/modem, 431 m"));
}

}  // namespace
