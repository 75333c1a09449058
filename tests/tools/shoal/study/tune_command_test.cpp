// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

TEST(TuneCommand, NeedsAStudyAndAFigure) {
  EXPECT_THAT(test::call_shoal({"tune"}).err, HasSubstr("required"));
  EXPECT_EQ(test::call_shoal({"tune"}).exit_code, 2);
}

TEST(TuneCommand, OptionsHaveTheirLimits) {
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{
           {"--generations", "0"}, {"--sigma", "0"}, {"--goal", "middle"}, {"--population", "-1"}}) {
    const test::Called called = test::call_shoal({"tune", "s.yaml", "--figure", "e.rms_m", option, value});
    EXPECT_EQ(called.exit_code, 2) << option;
    EXPECT_THAT(called.err, HasSubstr(option)) << option;
  }
}

}  // namespace
