// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

std::string file_of(const test_support::ScratchFolder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder.file(name)) << text;
  return folder.file(name);
}

TEST(CheckCommand, AGoodFileIsOfItsKind) {
  const test_support::ScratchFolder folder;
  const std::string model = "bodies: [{name: b, parts: [{shape: box, mass_kg: 1}]}]\n";
  EXPECT_EQ(test::call_shoal({"check", file_of(folder, "w.yaml", "shoal: 1\n")}).exit_code, 0);
  EXPECT_EQ(test::call_shoal({"check", file_of(folder, "v.yaml", "shoal: 1\nvehicle: v\n" + model)}).exit_code, 0);
}

TEST(CheckCommand, MistakesHaveTheirPlaceAndRule) {
  const test_support::ScratchFolder folder;
  const std::string path = file_of(folder, "w.yaml", "shoal: 1\nphysics: {step_s: 0}\nrun: {sed: 3}\n");
  const test::Called called = test::call_shoal({"check", path});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, testing::AllOf(HasSubstr(path + ":2:"), HasSubstr("'step_s' must be"),
                                         HasSubstr(path + ":3:"), HasSubstr("did you mean 'seed'?")));
}

TEST(CheckCommand, AFileThatIsNotThereIsNamed) {
  const test_support::ScratchFolder folder;
  const test::Called called = test::call_shoal({"check", folder.file("missing.yaml")});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("missing.yaml"));
}

}  // namespace
