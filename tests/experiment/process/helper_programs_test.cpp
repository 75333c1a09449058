// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/helper_programs.hpp"

#include <gmock/gmock.h>

namespace {

using testing::HasSubstr;

std::vector<experiment::HelperProgram> all() {
  return experiment::missing_helpers([](const std::string&) { return false; });
}

TEST(HelperPrograms, ThoseThatAreThereAreNotMissing) {
  const auto missing = experiment::missing_helpers([](const std::string& name) { return name != "gnuplot"; });
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_STREQ(missing[0].name, "gnuplot");
  EXPECT_TRUE(experiment::missing_helpers([](const std::string&) { return true; }).empty());
}

TEST(HelperPrograms, DebianAndUbuntuInstallThemByAptFromPackagesOfTheSameNames) {
  for (const char* release :
       {"ID=debian\nVERSION_ID=\"12\"\n", "PRETTY_NAME=\"Debian\"\nID=debian\nVERSION_ID=\"13\"\n",
        "ID=ubuntu\nID_LIKE=debian\nVERSION_ID=\"24.04\"\n"})
    EXPECT_EQ(experiment::install_command(all(), release),
              "apt-get install iproute2 gnuplot-nox ffmpeg python3 parallel slurm-client");
  EXPECT_THAT(experiment::install_command(all(), "ID=linuxmint\nID_LIKE=\"ubuntu debian\"\n"),
              HasSubstr("apt-get install"));
}

TEST(HelperPrograms, OtherSystemsAreToldTheNamesOfThePrograms) {
  EXPECT_EQ(experiment::install_command({all()[0]}, "ID=fedora\n"),
            "install by the package manager of this system: ip");
  EXPECT_THAT(experiment::install_command({all()[1]}, ""), HasSubstr("gnuplot"));
}

}  // namespace
