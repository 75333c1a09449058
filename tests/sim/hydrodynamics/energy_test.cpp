// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <ostream>

#include "sim/hydrodynamics/coefficient_model.hpp"
#include "sim/hydrodynamics/immersed_volume.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/sim/hydrodynamics/floating_worlds.hpp"

// Still water takes energy from what moves in it, and never brings any.  Steps of h let the energy of a swing of rate
// omega go up and down within each swing, and on the mean keep it.

namespace {

using sim::Body;
using sim::Vector3d;
using sim::Vector6d;
using test::TestWorld;

std::string name_of_step(double step_s) {
  return "Of" + std::to_string(static_cast<int>(step_s * 1000 + 0.5)) + "ms";
}

class Swings : public testing::TestWithParam<double> {};

constexpr double box_kg = 410, gravity_mps2 = 9.80665, water_kgpm3 = 1025;

/// Of a box of 2 x 1 x 0.5 m: motion, height, and the water that it lifts to the surface.
double energy_of_box_J(const Body& body) {
  const sim::Pose X_WB = body.X_WB();
  const Vector3d w_B = X_WB.linear().transpose() * body.w_WB_W(), p_W = X_WB.translation();
  const sim::ImmersedVolume wet =
      sim::immersed_box({2, 1, 0.5}, {X_WB.linear().transpose() * Vector3d::UnitZ(), -p_W.z()});
  const double wet_z_m = (X_WB * wet.centroid_m).z();
  return (body.mass_kg() * body.v_WB_W().squaredNorm() + w_B.dot(body.inertia_C_B() * w_B)) / 2 +
         gravity_mps2 * (body.mass_kg() * p_W.z() - water_kgpm3 * wet.volume_m3 * wet_z_m);
}

/// A box that heaves, rolls and pitches at once, and no drag: what is left is what the integration adds or takes.
TEST_P(Swings, WithoutDragTheyKeepTheirEnergy) {
  const double step_s = GetParam();
  TestWorld test(test::floating_world("[{shape: box, size_m: [2, 1, 0.5], density_kgpm3: 410, drag_coefficient: [0]}]",
                                      "[0, 0, 0.1]", step_s, ", rpy_deg: [5, 3, 0]"));
  const Body& box = test::body_of(test);
  ASSERT_NEAR(box.mass_kg(), box_kg, 1e-9);
  // Its draft is 0.2 m: the origin lies 5 cm over the surface, the water it has lifted 10 cm below.
  const double at_rest_J = gravity_mps2 * box_kg * (0.05 + 0.1);
  const auto swing_J = [&](double time_s) {
    double sum = 0;
    const int steps = static_cast<int>(std::round(time_s / step_s));
    for (int i = 0; i < steps; ++i) {
      test.world.step();
      sum += energy_of_box_J(box) - at_rest_J;
    }
    return sum / steps;
  };
  // A mean over some ten swings hides what goes up and down within each.  Nothing pumps: no mean of six minutes is 1 %
  // over the first, 2 % with steps of a twentieth of a swing.  What the steps take away is allowed, up to a tenth.
  const double max = step_s < 0.05 ? 1.01 : 1.02;
  const double first_J = swing_J(10);
  EXPECT_GT(first_J, 30);
  for (int i = 1; i <= 35; ++i) {
    const double now_J = swing_J(10);
    ASSERT_LT(now_J, max * first_J) << "after " << 10 * i << " s";
    ASSERT_GT(now_J, 0.9 * first_J) << "after " << 10 * i << " s";
  }
}

TEST_P(Swings, ABallHeavesNoHigherThanItDid) {
  TestWorld test(test::floating_world(
      "[{shape: sphere, radius_m: 0.3, density_kgpm3: 512.5, drag_coefficient: [0], added_mass_coefficient: 0.5}]",
      "[0, 0, 0.1]", GetParam()));
  const Body& ball = test::body_of(test);
  const auto highest_m = [&](double time_s) {
    double max = 0;
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      test.world.step();
      max = std::max(max, std::abs(ball.X_WB().translation().z()));
    }
    return max;
  };
  const double first = highest_m(60);
  for (int minute = 2; minute <= 6; ++minute) EXPECT_LT(highest_m(60), 1.01 * first) << minute;  // a sample may miss it
}

INSTANTIATE_TEST_SUITE_P(Steps, Swings, testing::Values(0.001, 0.005, 0.02, 0.05),
                         [](const auto& each) { return name_of_step(each.param); });

/// A vehicle file let go with speed, turning and out of trim.
struct Release {
  std::string file;
  double depth_m, step_s, roll_deg;
  friend void PrintTo(const Release& release, std::ostream* out) { *out << release.file << ", " << release.step_s; }
};

class ShippedVehicle : public testing::TestWithParam<Release> {
 protected:
  static Vector3d flipped(const Vector3d& v) { return {v.x(), -v.y(), -v.z()}; }

  /// Of rigid and added mass in its motion, and of its place against weight, buoyancy and the springs of a waterline.
  static double energy_J(const sim::CoefficientModel& model, const Body& body) {
    const sim::Pose X_WB = body.X_WB();
    const sim::Matrix3d R = X_WB.linear();
    Vector6d nu;
    nu << flipped(R.transpose() * body.v_WB_W()), flipped(R.transpose() * body.w_WB_W());
    return nu.dot(model.mass() * nu) / 2 + potential_J(model, X_WB);
  }
  static double potential_J(const sim::CoefficientModel& model, const sim::Pose& X_WB) {
    const sim::HydrodynamicsConfig& config = model.config();
    if (!config.waterline) {
      const double buoyancy_N =
          model.buoyancy_N() >= 0 ? model.buoyancy_N() : *config.volume_m3 * water_kgpm3 * gravity_mps2;
      return model.weight_N() * (X_WB * flipped(config.center_of_mass_m)).z() -
             buoyancy_N * (X_WB * flipped(config.center_of_buoyancy_m)).z();
    }
    const sim::WaterlineConfig& plane = *config.waterline;
    const Vector3d rpy = sim::rpy_from_rotation(X_WB.linear());
    const double heave_m = -X_WB.translation().z(), roll = rpy.x(), pitch = -rpy.y();
    return (plane.heave_Npm * heave_m * heave_m + plane.roll_Nmprad * roll * roll +
            plane.pitch_Nmprad * pitch * pitch) /
               2 +
           plane.heave_pitch_N * heave_m * pitch;
  }
};

TEST_P(ShippedVehicle, OnlyLosesEnergyWhenLetGo) {
  const auto& [file, depth_m, step_s, roll_deg] = GetParam();
  TestWorld test("shoal: 1\nphysics: {step_s: " + sim::number_text(step_s) +
                 ", gravity_mps2: 9.80665}\nmedium: {water: {density_kgpm3: 1025}}\nvehicles: [{name: it, file: " +
                 file + ".yaml, position_m: [0, 0, " + sim::number_text(-depth_m) + "], rpy_deg: [" +
                 sim::number_text(roll_deg) + ", " + sim::number_text(-roll_deg / 2) + ", 0]}]\n");
  const sim::BodyConfig& config = test.loaded.config.vehicles[0].config->bodies[0];
  Body& body = test.world.vehicles()[0]->body(config.name);
  const sim::CoefficientModel model(*config.hydrodynamics, gravity_mps2);
  const sim::Matrix3d R = body.X_WB().linear();
  body.set_velocity_W(R * Vector3d(1.5, 0.2, 0.1), R * Vector3d(0.2, 0.3, -0.3));
  sim::Pose upright = body.X_WB();
  upright.linear().setIdentity();
  const double start_J = energy_J(model, body), swing_J = start_J - potential_J(model, upright);
  double min_J = start_J, rise_J = 0;
  while (test.world.now() < sim::from_seconds(60)) {
    test.world.step();
    const double now_J = energy_J(model, body);
    min_J = std::min(min_J, now_J);
    rise_J = std::max(rise_J, now_J - min_J);
  }
  // Drag takes more in each step than the step adds, so that nothing but rounding is left to rise.
  EXPECT_LE(rise_J, 1e-9 * swing_J);
  EXPECT_GT(start_J - min_J, 0.5 * swing_J);
}

std::vector<Release> releases() {
  std::vector<Release> all;
  for (const double step_s : {0.005, 0.02, 0.05}) {
    all.push_back({"remus100", 50, step_s, 30});
    all.push_back({"remus_prestero", 50, step_s, 30});
    all.push_back({"bluerov2_heavy", 50, step_s, 30});
    all.push_back({"otter", 0.05, step_s, 6});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Files, ShippedVehicle, testing::ValuesIn(releases()),
                         [](const auto& each) { return each.param.file + name_of_step(each.param.step_s); });

}  // namespace
