// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/system/shoal_program.hpp"

namespace {

using namespace system_test;
using testing::HasSubstr;

/// The Otter let go with speed: 10 s of reference.
Ended otter_decay(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"fidelity", source("tests/fidelity/cases.yaml"), "--case", "otter_decay"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_shoal(arguments);
}

TEST(FidelityCommand, SaysHowFarOffACaseIsAndWritesItsReport) {
  const ScratchFolder folder;
  const Ended ended = otter_decay({"--results", folder.file("report"), "--csv"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("| otter_decay |       0 |"));
  EXPECT_THAT(otter_decay({"--step", "0.01"}).output, HasSubstr("| otter_decay |      10 |"));
  EXPECT_THAT(ended.output, HasSubstr("| yes |"));
  EXPECT_THAT(ended.output, testing::Not(HasSubstr("otter_turn")));
  EXPECT_THAT(text_of_file(folder.file("report/fidelity.md")), HasSubstr("otter_decay"));
}

TEST(FidelityCommand, Is1ForABarThatIsMissed) {
  // 25 kg more than the reference has.
  const Ended ended = otter_decay({"--override", "bodies.hull.hydrodynamics.mass_kg=80"});
  EXPECT_EQ(ended.exit_code, 1) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("otter_decay: missed position_rms_m"));
}

TEST(FidelityCommand, NamesTheCoefficientsThatNoCaseSees) {
  const ScratchFolder folder;
  // It stays below the surface.
  const Ended ended = run_shoal({"fidelity", source("tests/fidelity/cases.yaml"), "--case", "bluerov2wu_ascent",
                                 "--mutate", "0.05", "--results", folder.file("report")});
  EXPECT_EQ(ended.exit_code, 1) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("bluerov2: no case sees bodies.frame.hydrodynamics.hull_height_m"));
  EXPECT_THAT(ended.output, testing::Not(HasSubstr("added_mass")));
  EXPECT_THAT(text_of_file(folder.file("report/fidelity_coefficients.md")), HasSubstr("| a case is missing |"));
  EXPECT_THAT(text_of_file(folder.file("report/fidelity/coefficients.csv")),
              HasSubstr("\nbluerov2,bodies.frame.hydrodynamics.hull_height_m,"));
}

TEST(FidelityCommand, Is2ForWrongUsage) {
  EXPECT_EQ(run_shoal({"fidelity"}).exit_code, 2);
  EXPECT_THAT(run_shoal({"fidelity", "none.yaml"}).errors, HasSubstr("none.yaml: cannot read the file"));
  EXPECT_EQ(run_shoal({"fidelity", "none.yaml"}).exit_code, 2);
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{"--case", "otter_flight", "--override", "x"}, "must be PATH=VALUE, such as run.seed=3, got 'x'"},
      {{"--override", "bodies.hull.nothing=1"}, "body 'hull': unknown key 'nothing'"},
      {{"--step", "0"}, "--step"}};
  for (const auto& [arguments, error] : wrong) {
    const Ended ended = otter_decay(arguments);
    EXPECT_EQ(ended.exit_code, 2) << error;
    EXPECT_THAT(ended.errors, HasSubstr(error));
  }
  const Ended unknown = run_shoal({"fidelity", source("tests/fidelity/cases.yaml"), "--case", "otter_flight"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("no case has this name"));
}

}  // namespace
