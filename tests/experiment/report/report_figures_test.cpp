// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/report/report_figures.hpp"

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

TEST(Report, GroupsFiguresByMetricWithUnitsAndFoldsZeros) {
  const ScratchFolder folder;
  const std::string page = experiment::report_page({folder_of(folder, sea_figures(), sea_metrics)});
  const auto of_link = page.find("<h3>link ");
  // The order is that of the world, not of the alphabet.
  EXPECT_LT(page.find("<h3>cooperative "), page.find("<h3>alone "));
  EXPECT_LT(page.find("<h3>alone "), of_link);
  EXPECT_THAT(page, HasSubstr("delivery of auv"));
  EXPECT_THAT(page, HasSubstr("<td>0.912 m</td>"));
  EXPECT_THAT(page, HasSubstr("<td>1951 estimates</td>"));
  EXPECT_THAT(page, HasSubstr("<td>0.025 %</td>"));
  EXPECT_THAT(page, HasSubstr("<td>0.75</td>"));
  // 13 causes but noise, bytes_sent, unsent and dropped.
  const auto folded = page.find("<summary>15 figures that are 0</summary>", of_link);
  ASSERT_NE(folded, page.npos);
  EXPECT_GT(page.find("lost_doppler", of_link), folded);
  EXPECT_LT(page.find("lost_noise", of_link), folded);
}

TEST(Report, TakesFiguresOfAnyName) {
  const ScratchFolder folder;
  const std::string page = experiment::report_page(
      {folder_of(folder, {{"a", 1}, {"a.", 2}, {".b", 3}, {"c.d.e", 4}, {"", 5}, {"<x>.rms_m", experiment::no_figure}},
                 "metrics: [1, {name: [a]}, {name: a}]")});
  EXPECT_EQ(problems_of_page(page), "");
  EXPECT_THAT(page, HasSubstr("&lt;x&gt;"));
  EXPECT_THAT(page, HasSubstr("<td>none</td>"));
}

}  // namespace
