// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "devices/inertial/imu.hpp"
#include "shoal/imu_t.hpp"
#include "tests/devices/inertial/imu_fixture.hpp"
#include "tests/devices/inertial/weightless.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/config/parse.hpp"

namespace {

using namespace imu_fixture;

using test::weightless;

TEST(Imu, AKeyWinsOverThePreset) {
  test::TestWorld test(test::box_world(imu(", preset: vn100, gyro_arw_deg_per_sqrt_h: 0"), weightless));
  const auto& sensor = dynamic_cast<const devices::Imu&>(*test.world.find_device("r1/imu")->sensor());
  // The alignment of the preset is there.
  EXPECT_NE(sensor.gyro_errors().matrix(), sim::Matrix3d::Identity());
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.run_for(2);
  const auto all = reports.take_all();
  // Without the white noise two samples differ by the slow part only: 5 deg/h / 0.617 * sqrt(2 * 0.01 s / 100 s)
  // = 5.6e-7 rad/s; with it by 8.6e-4 rad/s.
  for (std::size_t i = 1; i < all.size(); ++i)
    EXPECT_LT((gyro_of(all[i]) - gyro_of(all[i - 1])).norm(), 5 * std::sqrt(3.0) * 5.6e-7);
  EXPECT_NE(gyro_of(all[1]), gyro_of(all[0]));
}

TEST(Imu, PresetsHoldTheFiguresOfTheDataSheetsInSi) {
  const auto find = [](const std::string& name) {
    const sim::ConfigNode node = test::parse("preset: " + name);
    sim::Diagnostics diagnostics;
    sim::ParamReader in(node, "", diagnostics);
    devices::Imu::Params params;
    params.read(in);
    EXPECT_EQ(diagnostics.lines(), std::vector<std::string>{});
    return params;
  };
  // 0.34 deg/sqrt(h) = 0.34 / 60 deg/sqrt(s), and the sheet's 0.008 deg/s/sqrt(Hz) is about 1.4 times that.
  EXPECT_NEAR(find("adis16470").gyro.random_walk, 9.890e-5, 1e-8);
  EXPECT_NEAR(find("adis16470").accel.bias_instability, 1.275e-4, 1e-7);
  EXPECT_NEAR(find("vn100").gyro.random_walk, 6.109e-5, 1e-8);
  EXPECT_NEAR(find("vn100").accel.random_walk, 1.373e-3, 1e-6);
  EXPECT_NEAR(find("stim300").gyro.bias_instability, 2.424e-6, 1e-9);
  EXPECT_NEAR(find("stim300").accel.random_walk, 1.167e-3, 1e-6);
  EXPECT_NEAR(find("bmi088").gyro.random_walk, 0.84 * devices::unit::deg_per_sqrt_h, 1e-10);
  EXPECT_NEAR(find("bmi088").accel.random_walk, 2.256e-3, 1e-6);
  // The decimals of other units than those of the sheets.
  using namespace devices::unit;
  EXPECT_DOUBLE_EQ(find("adis16470").accel.misalignment_rad, sim::degrees_to_radians(0.05));
  EXPECT_DOUBLE_EQ(find("bmi088").gyro.turn_on_bias, 1 * degps);
  EXPECT_DOUBLE_EQ(find("bmi088").gyro.resolution, 2000 * degps / 32768);
  EXPECT_DOUBLE_EQ(find("bmi088").accel.random_walk, 230 * ug);
  EXPECT_DOUBLE_EQ(find("bmi088").accel.resolution, 24 * mps2_per_g / 32768);
  EXPECT_DOUBLE_EQ(find("vn100").gyro.random_walk, 0.0035 * degps);
  EXPECT_DOUBLE_EQ(find("vn100").gyro.misalignment_rad, sim::degrees_to_radians(0.05) / 3);
  EXPECT_DOUBLE_EQ(find("vn100").accel.random_walk, 140 * ug);
}

}  // namespace
