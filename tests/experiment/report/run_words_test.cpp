// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "experiment/files/html.hpp"
#include "experiment/report/report_page.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/version.hpp"
#include "tests/experiment/report/report_pages.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using namespace report_pages;

using test_support::ScratchFolder;
using testing::HasSubstr;

TEST(Report, SaysInWordsWhatCameOut) {
  const ScratchFolder folder;
  const std::string page = experiment::report_page({folder_of(folder, sea_figures(), sea_metrics)});
  EXPECT_EQ(problems_of_page(page), "");
  EXPECT_THAT(page, HasSubstr("auv localizes itself to 0.91 m rms (cooperative); alone: 61.2 m rms, 138 m at the end, "
                              "after 2.80 km."));
  EXPECT_THAT(page, HasSubstr("link: 130 packets sent by auv; 75 % of 100 addressed to auv arrived."));
  // Without the world no one knows whose they are; a world that is not YAML is not known.
  const std::string unknown = experiment::report_page({folder_of(folder, sea_figures(), "}{")});
  EXPECT_THAT(unknown, HasSubstr("cooperative: 0.91 m rms; alone: 61.2 m rms, 138 m at the end, after 2.80 km."));
}

}  // namespace
