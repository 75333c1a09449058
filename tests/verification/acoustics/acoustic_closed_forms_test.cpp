// SPDX-License-Identifier: BSD-3-Clause
#include "verification/acoustics/acoustic_closed_forms.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"
#include "verification/acoustics/acoustic_link.hpp"
#include "verification/acoustics/ray_picture.hpp"

namespace {

using test_support::ScratchFolder;
using testing::HasSubstr;

TEST(AcousticClosedForms, AllHold) {
  const auto rows =
      verification::acoustic_closed_forms(test_support::source_path("tests/fidelity/reference/closed_forms.csv"));
  EXPECT_EQ(rows.size(), 48u);
  for (const verification::ClosedFormRow& row : rows)
    EXPECT_TRUE(row.within()) << row.name << " " << row.parameters << ": " << row.computed;
}

TEST(AcousticClosedForms, SayWhichRowIsWrong) {
  const ScratchFolder folder;
  const std::string file = folder.file("forms.csv");
  const auto error_of = [&](const std::string& row) -> std::string {
    std::ofstream(file) << "case,parameters,quantity,expected,unit,tolerance,tol_kind,note\n" << row << "\n";
    try {
      verification::acoustic_closed_forms(file);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error_of("absorption_thorp,f_kHz=1,alpha,0.069,dB/km,0.001,rel,"), "");
  EXPECT_THAT(error_of("absorption_thorp,f=1,alpha,0.069,dB/km,0.001,rel,"), HasSubstr(":2: no closed form of"));
  EXPECT_THAT(error_of("absorption_thorp,f_kHz=x,alpha,0.069,dB/km,0.001,rel,"), HasSubstr(":2: no closed form of"));
  EXPECT_THAT(error_of("absorption_thorp,f_kHz=1,alpha"), HasSubstr(":2: no closed form of"));
  EXPECT_THAT(error_of("spar_cylinder,d=1,T,2,s,1,abs,"), HasSubstr("no closed forms about sound"));
  std::filesystem::remove(file);
  EXPECT_THROW(verification::acoustic_closed_forms(file), std::runtime_error);
}

TEST(AcousticClosedForms, OneThatIsOffIsMarked) {
  const ScratchFolder folder;
  std::ofstream(folder.file("forms.csv")) << "header\nabsorption_thorp,f_kHz=1,alpha,0.07,dB/km,0.001,rel,\n";
  const auto rows = verification::acoustic_closed_forms(folder.file("forms.csv"));
  EXPECT_FALSE(rows.at(0).within());
  EXPECT_THAT(verification::closed_forms_text(rows), HasSubstr("FAILS"));
}

}  // namespace
