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

TEST(Report, OfSeveralRunsComparesThem) {
  const ScratchFolder folder;
  const std::string metrics = "metrics: [{name: distance, type: distance, vehicle: r1}]\n";
  run_into(folder.file("a"), metrics);
  run_into(folder.file("b"), "metrics: [{name: other, type: collisions}]\n", "large");
  const std::string page = experiment::report_page({folder.file("a"), folder.file("b")});
  EXPECT_EQ(problems_of_page(page), "");
  EXPECT_THAT(page, HasSubstr("<tr><td>world</td><td>small</td><td>large</td></tr>"));
  EXPECT_THAT(page, HasSubstr("<td></td><td>0</td></tr>"));
  EXPECT_THAT(page, HasSubstr("<summary>Figures that are 0</summary>"));  // no one moved, nothing touched
}

}  // namespace
