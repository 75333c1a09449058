// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>

#include "tests/sim/hydrodynamics/floating_worlds.hpp"
#include "tests/sim/hydrodynamics/release_fixture.hpp"

namespace {

using namespace release_fixture;

// Light bodies let go under water: they come up to their terminal speed and leap as high as that takes them.

using test::body_of;
using test::TestWorld;

const char* sphere_03 = "shape: sphere, radius_m: 0.3, mass_kg: 5";

const char* raft = "shape: box, size_m: [1, 1, 0.2], density_kgpm3: 10";

const char* capsule = "shape: capsule, radius_m: 0.15, length_m: 0.6, density_kgpm3: 30";

double highest_within(TestWorld& test, double time_s) {
  double highest = -1e9;
  const sim::Time end = test.world.now() + sim::from_seconds(time_s);
  while (test.world.now() < end) {
    test.world.step();
    highest = std::max(highest, body_of(test).X_WB().translation().z());
  }
  return highest;
}

double highest_after_release(const std::string& part, double step_s) {
  TestWorld test(released(part, step_s));
  return highest_within(test, 20);
}

TEST(Release, ALightBodyLeapsAsHighInLongStepsAsInShortOnes) {
  for (const std::string part : {sphere_02, sphere_03, raft, capsule, bubble}) {
    const double fine = highest_after_release(part, steps_s[0]);
    for (const double step_s : steps_s) {
      const double coarse = highest_after_release(part, step_s);
      EXPECT_LT(coarse, 1.5 * fine) << part << ", step " << step_s;
      EXPECT_GT(coarse, fine / 1.5) << part << ", step " << step_s;
    }
  }
}

TEST(Release, WithoutAddedMassItLeapsNoHigherInLongSteps) {
  for (const std::string part : {sphere_02, sphere_03, raft, capsule, bubble}) {
    const double fine = highest_after_release(part + no_added_mass, steps_s[0]);
    for (const double step_s : steps_s)
      EXPECT_LT(highest_after_release(part + no_added_mass, step_s), 1.5 * fine) << part << ", step " << step_s;
  }
}

TEST(Release, NoEnergyComesOutOfNothing) {
  // Let go askew.  With added mass C of what it displaces a body gets at most g / C of acceleration, so that the first
  // leap is at most 1 / C = 2 times the way up; what it does later is lower and lower.
  for (const std::string part : {sphere_02, sphere_03, raft, capsule, bubble})
    for (const double step_s : steps_s) {
      TestWorld test(released(part, step_s, ", rpy_deg: [20, 10, 0]"));
      double last = highest_within(test, 5);
      EXPECT_LT(last, 2 * (2 + 0.6)) << part << ", step " << step_s;
      for (int i = 0; i < 5; ++i) {
        const double now = highest_within(test, 5);
        EXPECT_LT(now, last + 0.005) << part << ", step " << step_s;
        last = now;
      }
      EXPECT_LT(body_of(test).v_WB_W().norm(), 1) << part << ", step " << step_s;
    }
}

TEST(Release, ARunNeverEndsBecauseOfALightBody) {
  for (const std::string shape : {"shape: sphere, radius_m: 0.3", "shape: box, size_m: [1, 1, 0.02]",
                                  "shape: cylinder, radius_m: 0.05, length_m: 3", "shape: box, size_m: [3, 0.2, 1]"})
    for (const std::string more : {"", no_added_mass})
      for (const double mass_kg : {1e-6, 0.01})
        for (const double step_s : {0.001, 0.05}) {
          TestWorld test(
              released(shape + ", mass_kg: " + sim::number_text(mass_kg) + more, step_s, ", rpy_deg: [30, 60, 0]"));
          EXPECT_LT(highest_within(test, 10), 6) << shape << more << ", " << mass_kg << " kg, step " << step_s;
        }
}

}  // namespace
