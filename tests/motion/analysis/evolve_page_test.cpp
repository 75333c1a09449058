// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/evolve_page.hpp"

#include <gmock/gmock.h>

namespace {

using testing::HasSubstr;

TEST(EvolvePage, TheCurveHasAPointForEachGeneration) {
  const std::string svg = motion::evolve_curve({{0, 0.1, 0.1}, {16, 0.1, -0.2}, {32, 0.4, 0.4}});
  // From 70 to 780 pixels over 32 candidates; from -200 to 400 mm/s in marks of 100, 20 to 370 pixels from above.
  EXPECT_THAT(svg, HasSubstr("points=\"70.0,195.0 425.0,195.0 780.0,20.0\""));
  EXPECT_THAT(svg, HasSubstr("<circle cx=\"425.0\" cy=\"370.0\""));
  EXPECT_THAT(svg, HasSubstr(">-200</text>"));
}

TEST(EvolvePage, ASearchWithoutAGenerationHasNoCurve) {
  EXPECT_EQ(motion::evolve_curve({{0, 0.1, 0.1}}), "");
}

TEST(EvolvePage, ThePageHasTheTablesAndNoMarkupOfNames) {
  motion::EvolveReport report;
  report.title = "Search for a gait: <b>";
  report.facts = {{"world", "ers7_studio"}};
  report.world_head = {"world", "mm/s"};
  report.worlds = {{"1", "380.1"}};
  report.numbers = {{"period_s", "0.3", "0.7"}};
  const std::string page = motion::evolve_page(report);
  EXPECT_THAT(page, HasSubstr("Search for a gait: &lt;b&gt;"));
  EXPECT_THAT(page, HasSubstr("<td>380.1</td>"));
  EXPECT_THAT(page, HasSubstr("<td>period_s</td>"));
  EXPECT_THAT(page, testing::Not(HasSubstr("<b>")));
}

}  // namespace
