// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "sim/config/diagnostics.hpp"
#include "tests/fidelity/fidelity_files.hpp"
#include "verification/fidelity/fidelity.hpp"

namespace {

using namespace fidelity_files;

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(FidelityFiles, TheReportHasTheTableTheImagesAndOurStates) {
  write("c.csv", header + "0,1,2,3,0,0,0.5,0,0,0,0,0,0,0\n0.1,1,2,3,0,0,0.5,0,0,0,0,0,0,0\n");
  const verification::FidelityFile file = verification::read_fidelity_file(cases("    title: Mine\n"));
  verification::write_fidelity_report(folder_.file("report"), "A word before.\n",
                                      {verification::run_fidelity_case(file.cases.front())}, true);
  const auto read = [&](const std::string& name) {
    std::ifstream in(folder_.file("report/" + name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_THAT(read("fidelity.md"),
              AllOf(HasSubstr("A word before."), HasSubstr("## Mine"), HasSubstr("![c](fidelity/c.png)")));
  EXPECT_THAT(read("fidelity/end_states.csv"),
              testing::StartsWith("case,quantity,reference,simulated,difference\nc,north_m,1.0000,1.0000,0.0000\n"));
  EXPECT_THAT(read("fidelity/c.png"), testing::StartsWith("\x89PNG"));
  EXPECT_THAT(read("fidelity/c.csv"), testing::StartsWith("t,x,y,z,phi,theta,psi,u,v,w,p,q,r\n0,1,2,3,0,0,0.5,"));
}

TEST_F(FidelityFiles, ALineReportsHowACaseWent) {
  verification::FidelityResult result;
  result.of.name = "turn";
  result.position_rms_m = 0.03125;
  EXPECT_EQ(verification::fidelity_line(result, 2, 24), "2 of 24: turn: position rms 0.0312 m");
  result.missed = {"position_rms_m 0.03125 > 0.01"};
  EXPECT_EQ(verification::fidelity_line(result, 2, 24), "2 of 24: turn: position rms 0.0312 m, bars missed: 1");
}

}  // namespace
