// SPDX-License-Identifier: BSD-3-Clause
#include "devices/common/param_checks.hpp"

#include <gmock/gmock.h>

#include "tests/sim/config/read_yaml.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> errors_of(const std::string& yaml, double beams, double rays) {
  return test::errors_of_reading(yaml, [&](sim::ParamReader& in) {
    int ignored = 0;
    in.read("beams", ignored, sim::at_least(0), "");
    in.read("rays", ignored, sim::at_least(0), "");
    const devices::RayFactor factors[] = {{"beams", beams}, {"rays", rays}};
    devices::check_rays(in, factors);
  });
}

TEST(ParamChecks, ASampleHasAMillionRaysAtMost) {
  EXPECT_THAT(errors_of("{beams: 1000, rays: 1000}", 1000, 1000), testing::IsEmpty());
  EXPECT_THAT(
      errors_of("{beams: 1001, rays: 1000}", 1001, 1000),
      ElementsAre(HasSubstr("w.yaml:1:21: 'beams' x 'rays' must be at most 1000000 rays in a sample, got 1001 x "
                            "1000 = 1001000")));
}

TEST(ParamChecks, TheErrorIsAtTheLastKeyThatIsGiven) {
  EXPECT_THAT(errors_of("{beams: 2000}", 2000, 1000), ElementsAre(HasSubstr("w.yaml:1:9: ")));
}

TEST(ParamChecks, TheRateOfADeviceIsThatOfItsMap) {
  const auto rate = [](const std::string& yaml) {
    double rate_hz = 0;
    test::errors_of_reading(yaml, [&](sim::ParamReader& in) { rate_hz = devices::rate_hz_of(in, 10); });
    return rate_hz;
  };
  EXPECT_EQ(rate("{rate_hz: 4}"), 4);
  EXPECT_EQ(rate("{}"), 10);
  EXPECT_EQ(rate("{rate_hz: every_step}"), 0);
  EXPECT_EQ(rate("{rate_hz: -1}"), 10);  // an error that is reported elsewhere
}

}  // namespace
