// SPDX-License-Identifier: BSD-3-Clause
#include "verification/fidelity/fidelity_mutations.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::HasSubstr;

/// A case of a vehicle that falls from rest for a second, with small bars.
class MutationFiles : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_.file(name)) << text; }
  verification::FidelityFile read(const std::string& water, const std::string& more_of_case = "",
                                  const std::string& top = "") {
    write("v.yaml", "shoal: 1\nvehicle: v\nbodies:\n  - name: b\n    parts: [{shape: box, size_m: [1, 1, 1]}]\n" +
                        ("    hydrodynamics: {frame: frd, mass_kg: 10, inertia_kgm2: [2, 3, 4], " + water + "}\n"));
    // Half of m g down on m and an added mass of m: 2.45 m/s^2.
    write("c.csv",
          "t,x,y,z,phi,theta,psi,u,v,w,p,q,r\n0,0,0,5,0,0,0,0,0,0,0,0,0\n1,0,0,6.2258,0,0,0,0,0,2.4516,0,0,0\n");
    write("cases.yaml", "shoal: 1\n" + top + "groups:\n  - name: g\n    vehicle: v.yaml\n" +
                            "    world: {physics.gravity_mps2: 9.80665}\n    bars: {position_max_m: 0.001}\n" +
                            "    cases: [{name: c, reference: c.csv" + more_of_case + "}]\n");
    return verification::read_fidelity_file(folder_.file("cases.yaml"));
  }
  static std::vector<verification::FidelityMutation> mutate(const verification::FidelityFile& file) {
    return verification::mutate_fidelity(file, 0.05, [](const std::string&) {});
  }
  static const verification::FidelityMutation& named(const std::vector<verification::FidelityMutation>& all,
                                                     const std::string& end) {
    for (const verification::FidelityMutation& one : all)
      if (one.of.name.ends_with(end)) return one;
    throw std::runtime_error("there is no " + end);
  }
  test_support::ScratchFolder folder_;
};

const std::string half_buoyant = "buoyancy_N: 49.03325, added_mass: [0, 0, 10, 0, 0, 0]";

TEST_F(MutationFiles, WhatMovesTheVehicleIsSeenAndWhatDoesNotIsNot) {
  const auto all = mutate(read(half_buoyant));
  EXPECT_EQ(all.size(), 6u);  // no zeros
  for (const char* seen : {"mass_kg", "buoyancy_N", "added_mass[2]"}) {
    EXPECT_FALSE(named(all, seen).unseen()) << seen;
    EXPECT_EQ(named(all, seen).verdicts[0].seen_by, "c");
    EXPECT_THAT(named(all, seen).verdicts[1].missed, testing::StartsWith("position_max_m "));
  }
  for (const char* unseen : {"inertia_kgm2[0]", "inertia_kgm2[1]", "inertia_kgm2[2]"})
    EXPECT_TRUE(named(all, unseen).unseen()) << unseen;
}

TEST_F(MutationFiles, ACaseThatSetsACoefficientItselfDoesNotSeeIt) {
  const auto all = mutate(read("buoyancy_N: 20, added_mass: [0, 0, 10, 0, 0, 0]",
                               ", overrides: {bodies.b.hydrodynamics.buoyancy_N: 49.03325}"));
  EXPECT_TRUE(named(all, "buoyancy_N").unseen());
  EXPECT_FALSE(named(all, "mass_kg").unseen());
}

TEST_F(MutationFiles, ARefusedValueIsNoMissingCase) {
  // The added mass of a spheroid that is as wide as long.
  const auto all = mutate(read("buoyancy_N: 98, added_mass_of_spheroid: {half_length_m: 0.5, radius_m: 0.5}"));
  const verification::FidelityMutation& radius = named(all, "radius_m");
  EXPECT_THAT(radius.verdicts[1].refused, HasSubstr("'radius_m' must be <= 'half_length_m' 0.5, got 0.525"));
  EXPECT_EQ(radius.verdicts[0].refused, "");
}

TEST_F(MutationFiles, AMatrixStaysSymmetric) {
  const auto all =
      mutate(read("buoyancy_N: 49.03325, added_mass: [1, 0, 0, 0, 0.2, 0,  0, 1, 0, 0, 0, 0, "
                  " 0, 0, 10, 0, 0, 0,  0, 0, 0, 1, 0, 0,  0.2, 0, 0, 0, 1, 0,  0, 0, 0, 0, 0, 1]"));
  EXPECT_EQ(named(all, "added_mass[4]").of.places, (std::vector<std::size_t>{4, 24}));
  EXPECT_THROW(named(all, "added_mass[24]"), std::runtime_error);
  EXPECT_EQ(named(all, "added_mass[4]").verdicts[0].refused, "");
  const auto pairs =
      mutate(read("buoyancy_N: 49.03325, derivatives: {Z_wdot: -10, Z_qdot: -0.3, M_wdot: -0.3, "
                  "M_qdot: -1}"));
  const verification::FidelityMutation& pair = named(pairs, "Z_qdot, M_wdot");
  EXPECT_EQ(pair.of.changes(2).size(), 2u);
  EXPECT_EQ(pair.verdicts[0].refused, "");
}

TEST_F(MutationFiles, ThePageListsWhatIsUnseenWithItsReason) {
  const verification::FidelityFile file =
      read(half_buoyant, "",
           "without_effect: [{coefficient: \"bodies.b.hydrodynamics.inertia_kgm2[0]\", why: it does not roll}]\n");
  const std::string page = verification::fidelity_mutations_page(mutate(file), 0.05, "cases.yaml");
  EXPECT_THAT(page, HasSubstr("| v | bodies.b.hydrodynamics.inertia_kgm2[0] | 2 | it does not roll |"));
  EXPECT_THAT(page, HasSubstr("| v | bodies.b.hydrodynamics.inertia_kgm2[1] | 3 | a case is missing |"));
  EXPECT_THAT(page, HasSubstr("\n| v | 6 |\n"));
  EXPECT_THAT(page, HasSubstr("## Refused values\n\nNone."));
  EXPECT_THAT(verification::fidelity_mutations_csv(mutate(file)),
              HasSubstr("\nv,bodies.b.hydrodynamics.mass_kg,10,c,c\n"));
}

}  // namespace
