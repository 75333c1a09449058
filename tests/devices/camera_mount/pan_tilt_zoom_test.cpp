// SPDX-License-Identifier: BSD-3-Clause
#include "devices/camera_mount/pan_tilt_zoom.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "shoal/estop_t.hpp"
#include "shoal/image_t.hpp"
#include "shoal/pan_tilt_zoom_command_t.hpp"
#include "shoal/pan_tilt_zoom_t.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/state_fixture.hpp"

namespace {

using testing::HasSubstr;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double deg = 0.017453292519943295;

/// A camera on a head of 1 kg and 0.004 kg m2 without gravity, in front of a pole of 0.4 m at 4 m.  It pans to the left
/// from -1 to 1 rad at up to 2 rad/s and tilts up at up to 1 rad/s; its image is 200 pixels wide.
std::string mount_world(const std::string& keys = "", const std::string& camera = "",
                        const std::string& pan_servo = ", max_effort: 10") {
  return R"(shoal: 1
physics: {step_s: 0.002, gravity_mps2: 0}
objects:
  - {name: pole, fixed: true, position_m: [4, 0, 0], parts: [{shape: box, size_m: [0.01, 0.4, 10]}]}
vehicles:
  - name: v
    model:
      shoal: 1
      vehicle: mount
      bodies:
        - {name: base, kinematic: true, position_m: [0, 0, -1], parts: [{shape: sphere, radius_m: 0.1}]}
        - {name: yoke, parts: [{shape: sphere, radius_m: 0.1, mass_kg: 0.5}]}
        - {name: head, parts: [{shape: sphere, radius_m: 0.1, mass_kg: 0.5}]}
        - {name: lift, position_m: [0, 0, -2], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 0.5}]}
      joints:
        - {name: pan, type: hinge, bodies: [base, yoke], anchor_m: [0, 0, 0], axis: [0, 0, 1], low_stop: -1, high_stop: 1}
        - {name: tilt, type: hinge, bodies: [yoke, head], anchor_m: [0, 0, 0], axis: [0, -1, 0], low_stop: -0.5,
           high_stop: 1.2}
        - {name: lift, type: slider, bodies: [base, lift], axis: [0, 0, 1]}
      devices:
        - {name: estop, type: estop}
        - {name: pan, type: joint_servo, joint: pan, max_velocity: 2)" +
         pan_servo + R"(}
        - {name: tilt, type: joint_servo, joint: tilt, max_velocity: 1}
        - {name: lift, type: joint_servo, joint: lift}
        - {name: ptz, type: pan_tilt_zoom, rate_hz: 100, phase_s: 0)" +
         (keys.empty() ? ", pan: pan, tilt: tilt, camera: eye, min_fov_deg: 10, zoom_speed_degps: 20" : keys) + R"(}
        - {name: eye, type: camera, body: head, width: 200, height: 21, fov_deg: 60, rate_hz: 20, phase_s: 0)" +
         (camera.empty() ? ", image: segmentation_vehicles" : camera) + "}\n";
}

shoal::pan_tilt_zoom_command_t command(double pan, double tilt, double fov, double pan_speed = nan,
                                       double tilt_speed = nan, double fov_speed = nan) {
  return {0, pan, tilt, fov, pan_speed, tilt_speed, fov_speed};
}

/// The world with a listener at the reports of the mount.
struct Mount {
  explicit Mount(const std::string& yaml = mount_world()) : test(yaml), reports(test, "v.ptz") {}
  void send(const shoal::pan_tilt_zoom_command_t& message) { test.send("v.ptz.cmd", message); }
  shoal::pan_tilt_zoom_t after(double time_s) {
    test.run_for(time_s);
    return reports.last();
  }
  test::TestWorld test;
  test::Listener<shoal::pan_tilt_zoom_t> reports;
};

TEST(PanTiltZoom, MovesToPositionsAtTheSpeedsOfItsServosAndOfItsLens) {
  Mount mount;
  mount.send(command(0.8, -0.3, 40 * deg));
  const auto moving = mount.after(0.2);
  // 2 rad/s, 1 rad/s and 20 degrees/s, and a servo is a step behind.
  EXPECT_NEAR(moving.pan_rad, 0.4, 0.01);
  EXPECT_NEAR(moving.tilt_rad, -0.2, 0.005);
  EXPECT_NEAR(moving.fov_rad, 56 * deg, 0.1 * deg);
  EXPECT_NEAR(moving.pan_radps, 2, 0.01);
  EXPECT_NEAR(moving.tilt_radps, -1, 0.01);
  EXPECT_NEAR(moving.fov_radps, -20 * deg, 1e-9);
  const auto there = mount.after(1);
  EXPECT_NEAR(there.pan_rad, 0.8, 1e-3);
  EXPECT_NEAR(there.tilt_rad, -0.3, 1e-3);
  EXPECT_NEAR(there.fov_rad, 40 * deg, 1e-12);
  EXPECT_NEAR(there.pan_radps, 0, 1e-3);
  EXPECT_EQ(there.fov_radps, 0);
}

TEST(PanTiltZoom, ASpeedWithAPositionIsTheLargestOne) {
  Mount mount;
  mount.send(command(0.8, 0.8, 40 * deg, 0.5, 0.25, 10 * deg));
  const auto moving = mount.after(0.4);
  EXPECT_NEAR(moving.pan_rad, 0.2, 0.005);
  EXPECT_NEAR(moving.tilt_rad, 0.1, 0.005);
  EXPECT_NEAR(moving.fov_rad, 56 * deg, 0.1 * deg);
}

TEST(PanTiltZoom, ItsOwnKeysLimitTheSpeedsToo) {
  Mount mount(mount_world(", pan: pan, tilt: tilt, pan_speed_degps: 30, tilt_speed_degps: 15"));
  mount.send(command(0.8, nan, nan));
  mount.send(command(nan, nan, nan, nan, 5, nan));
  const auto moving = mount.after(0.5);
  EXPECT_NEAR(moving.pan_rad, 15 * deg, 0.5 * deg);
  EXPECT_NEAR(moving.tilt_rad, 7.5 * deg, 0.5 * deg);
}

TEST(PanTiltZoom, AVelocityGoesOnToTheEndOfTheRange) {
  Mount mount;
  mount.send(command(nan, nan, nan, -0.5, 0.4, 10 * deg));
  const auto moving = mount.after(1);
  EXPECT_NEAR(moving.pan_rad, -0.5, 0.01);
  EXPECT_NEAR(moving.tilt_rad, 0.4, 0.01);
  EXPECT_NEAR(moving.fov_rad, 60 * deg, 1e-12);  // zoomed out from the start
  mount.send(command(nan, nan, nan, nan, 0, -40 * deg));
  const auto stopped = mount.after(3);
  EXPECT_NEAR(stopped.pan_rad, -1, 1e-3);
  EXPECT_NEAR(stopped.tilt_rad, moving.tilt_rad, 0.01);
  EXPECT_NEAR(stopped.tilt_radps, 0, 1e-3);
  EXPECT_NEAR(stopped.fov_rad, 10 * deg, 1e-12);  // 20 degrees/s for 2.5 s
}

TEST(PanTiltZoom, StopsWhereItIs) {
  // Of a velocity above that of its servo, and of a position; without a run-out of the set point.
  for (const auto& [moves, stops] : {std::pair{command(nan, nan, nan, 5), command(nan, nan, nan, 0)},
                                     {command(0.9, nan, nan), command(nan, nan, nan, 0)},
                                     {command(0.9, nan, nan), command(-0.9, nan, nan, 0)}}) {
    Mount mount;
    mount.send(moves);
    mount.after(0.2);
    mount.send(stops);
    EXPECT_NEAR(mount.after(0.3).pan_rad, 0.4, 0.02);  // 2 rad/s for 0.2 s
  }
}

TEST(PanTiltZoom, LeavesAServoThatAVelocityHasBroughtToTheEnd) {
  Mount mount;
  mount.send(command(nan, nan, nan, nan, 5, nan));
  mount.after(2);
  auto* servo = const_cast<devices::JointServo*>(
      dynamic_cast<const devices::JointServo*>(mount.test.world.find_vehicle("v")->find_device("tilt")->actuator()));
  servo->set_position(0.3);
  EXPECT_NEAR(mount.after(2).tilt_rad, 0.3, 0.01);
}

TEST(PanTiltZoom, TheLensOfItsCameraIsNotSet) {
  Mount mount;
  mount.after(0.01);
  for (const char* values : {"{fov_deg: 20}", "{lens: fisheye}"})
    EXPECT_THAT(mount.test.change("v/eye", values), HasSubstr("cannot be set")) << values;
  mount.send(command(nan, nan, 30 * deg));
  EXPECT_NEAR(mount.after(2).fov_rad, 30 * deg, 1e-9);
}

TEST(PanTiltZoom, PositionsBeyondTheRangeAreItsEnds) {
  Mount mount;
  mount.send(command(5, -5, 0.01));
  const auto there = mount.after(4);
  EXPECT_NEAR(there.pan_rad, 1, 1e-3);
  EXPECT_NEAR(there.tilt_rad, -0.5, 1e-3);
  EXPECT_NEAR(there.fov_rad, 10 * deg, 1e-12);
}

TEST(PanTiltZoom, NaNLetsAnAxisGoOnAsBefore) {
  Mount mount;
  mount.send(command(0.8, nan, nan));
  mount.test.run_for(0.1);
  mount.send(command(nan, 0.3, nan));
  const auto there = mount.after(1);
  EXPECT_NEAR(there.pan_rad, 0.8, 1e-3);
  EXPECT_NEAR(there.tilt_rad, 0.3, 1e-3);
  EXPECT_NEAR(there.fov_rad, 60 * deg, 1e-12);
}

TEST(PanTiltZoom, CannotTurnFasterThanTheEffortOfItsServoAllows) {
  // Yoke and head are spheres: inertia 2 * 2/5 m r^2 = 0.004 kg m2, so that 0.002 N m make 0.5 rad/s2.
  Mount mount(mount_world("", "", ", max_effort: 0.002"));
  mount.send(command(0.9, nan, nan));
  const auto moving = mount.after(0.4);
  EXPECT_NEAR(moving.pan_radps, 0.2, 0.01);
  EXPECT_NEAR(moving.pan_rad, 0.04, 0.003);
}

/// Pixels of the pole in the middle row.
int width_of_pole(const shoal::image_t& image) {
  int pixels = 0;
  for (int column = 0; column < image.width; ++column) {
    std::uint16_t label = 0;
    std::memcpy(&label, image.data.data() + image.row_stride * 10 + 2 * column, sizeof label);
    pixels += label != 0;
  }
  return pixels;
}

TEST(PanTiltZoom, ThePictureIsThatOfTheFieldOfView) {
  Mount mount;
  test::Listener<shoal::image_t> images(mount.test, "v.eye");
  mount.test.run_for(0.1);
  // 0.4 m at 4 m: 0.1 focal lengths of 100 px / tan(fov / 2).
  EXPECT_NEAR(width_of_pole(images.last()), 0.1 * 100 / std::tan(30 * deg), 1);
  mount.send(command(nan, nan, 20 * deg));
  mount.test.run_for(2.2);
  const auto zoomed = images.last();
  EXPECT_NEAR(width_of_pole(zoomed), 0.1 * 100 / std::tan(10 * deg), 1);
  const std::string optics(zoomed.metadata.at(0).value.begin(), zoomed.metadata.at(0).value.end());
  EXPECT_THAT(optics, HasSubstr("focal_px: [567.128"));  // 100 / tan(10 degrees)
}

TEST(PanTiltZoom, ThePictureIsThatOfItsDirection) {
  Mount mount;
  test::Listener<shoal::image_t> images(mount.test, "v.eye");
  mount.send(command(0.9, nan, nan));  // 51.6 degrees to the left of the pole, of which the image shows 30
  mount.test.run_for(1);
  EXPECT_EQ(width_of_pole(images.last()), 0);
  mount.send(command(0, nan, nan));
  mount.test.run_for(1);
  EXPECT_GT(width_of_pole(images.last()), 10);
}

TEST(PanTiltZoom, AnEmergencyStopEndsItsMotions) {
  Mount mount;
  mount.send(command(0.8, nan, 20 * deg, nan, nan, nan));
  mount.test.run_for(0.1);
  shoal::estop_t estop{};
  estop.engaged = 1;
  mount.test.send("v.estop.cmd", estop);
  const auto stopped = mount.after(0.5);
  EXPECT_LT(stopped.pan_rad, 0.25);
  EXPECT_NEAR(stopped.fov_rad, 58 * deg, 0.1 * deg);
  estop.engaged = 0;
  mount.test.send("v.estop.cmd", estop);
  const auto released = mount.after(0.5);
  EXPECT_NEAR(released.pan_rad, stopped.pan_rad, 0.01);
  EXPECT_EQ(released.fov_rad, stopped.fov_rad);
  mount.send(command(0.8, nan, nan));
  EXPECT_NEAR(mount.after(1).pan_rad, 0.8, 1e-3);
}

TEST(PanTiltZoom, LeavesItsServosToOthersWhenItHasArrived) {
  Mount mount;
  mount.send(command(0.2, nan, nan));
  mount.test.run_for(0.5);
  auto* servo = const_cast<devices::JointServo*>(
      dynamic_cast<const devices::JointServo*>(mount.test.world.find_vehicle("v")->find_device("pan")->actuator()));
  servo->set_position(-0.4);
  EXPECT_NEAR(mount.after(1).pan_rad, -0.4, 1e-3);
  // From there it continues, not from where it was.
  mount.send(command(nan, nan, nan, 0.5, nan, nan));
  EXPECT_NEAR(mount.after(0.4).pan_rad, -0.2, 0.01);
}

TEST(PanTiltZoom, WithoutAnAxisItReportsNaN) {
  Mount mount(mount_world(", tilt: tilt"));
  const auto report = mount.after(0.1);
  EXPECT_TRUE(std::isnan(report.pan_rad) && std::isnan(report.pan_radps));
  EXPECT_TRUE(std::isnan(report.fov_rad) && std::isnan(report.fov_radps));
  EXPECT_NEAR(report.tilt_rad, 0, 1e-9);
}

TEST(PanTiltZoom, AnglesHaveTheResolutionOfAnEncoder) {
  Mount mount(mount_world(", pan: pan, angle_noise: {quantization: 0.1}"));
  mount.send(command(0.33, nan, nan));
  EXPECT_NEAR(mount.after(1).pan_rad, 0.3, 1e-12);
}

TEST(PanTiltZoom, ContinuesInTheMiddleOfItsMotionsAfterASnapshot) {
  // The shutter cuts each image into rows of different fields of view, and some snapshots cut an image.
  test::SavedRun(mount_world("", ", image: grey, readout_s: 0.04"), [](test::TappedWorld& world, int step) {
    if (step == 10) world.send("v.ptz.cmd", command(0.8, nan, 20 * deg, nan, 0.3, 15 * deg));
    if (step == 200) world.send("v.ptz.cmd", command(-0.5, nan, nan, nan, nan, 10 * deg));
  }).expect_restored_worlds_go_on_alike({5, 90, 207, 400}, 250);
}

TEST(PanTiltZoom, OtherKeysOfTheCameraCanChangeWhileItIsZoomed) {
  Mount mount;
  test::Listener<shoal::image_t> images(mount.test, "v.eye");
  mount.send(command(nan, nan, 20 * deg));
  mount.test.run_for(2.2);
  EXPECT_EQ(mount.test.change("v/eye", "{range_max_m: 100}"), "");
  mount.test.run_for(0.1);
  EXPECT_NEAR(width_of_pole(images.last()), 0.1 * 100 / std::tan(10 * deg), 1);
}

TEST(PanTiltZoom, ItsRangeAndSpeedsCanChange) {
  Mount mount;
  mount.send(command(nan, nan, 20 * deg));
  mount.test.run_for(2.2);
  ASSERT_EQ(mount.test.change("v/ptz", "{min_fov_deg: 30, pan_speed_degps: 10}"), "");
  EXPECT_NEAR(mount.after(0.1).fov_rad, 30 * deg, 1e-12);
  mount.send(command(0.8, nan, nan));
  EXPECT_NEAR(mount.after(0.5).pan_rad, 5 * deg, 0.5 * deg);
  EXPECT_THAT(mount.test.change("v/ptz", "{max_fov_deg: 50}"),
              HasSubstr("'fov_deg' of the camera must be from 30 to 50, got 60"));
  EXPECT_THAT(mount.test.change("v/ptz", "{pan: tilt}"), HasSubstr("pan"));
}

TEST(PanTiltZoom, IgnoresBadCommandsAndGoesOn) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Mount mount(mount_world(", pan: pan, camera: eye, min_fov_deg: 10"));
  mount.send(command(0.2, nan, nan));
  mount.send(command(infinite, nan, nan));
  mount.send(command(nan, nan, nan, -infinite, nan, nan));
  mount.send(command(0.9, nan, nan, -1, nan, nan));
  mount.send(command(0.9, 0.1, nan));
  mount.send(command(0.9, nan, nan, nan, 0.1, nan));
  mount.send(command(nan, nan, nan, nan, 0, nan));  // a tilt that does not exist stands still
  EXPECT_NEAR(mount.after(1).pan_rad, 0.2, 1e-3);
  EXPECT_EQ(mount.test.world.counts().bad_messages, 5u);
}

TEST(PanTiltZoom, SaysWhatIsWrongWithItsParameters) {
  const auto error = [](const std::string& keys, const std::string& camera = "") {
    return test::error_of_world(mount_world(keys, camera));
  };
  EXPECT_THAT(error(", latency_s: 0"), HasSubstr("needs at least one of 'pan', 'tilt' and 'camera'"));
  EXPECT_THAT(error(", pan: pen"), HasSubstr("'pan' must be a joint_servo of the vehicle, got 'pen'"));
  EXPECT_THAT(error(", pan: eye"), HasSubstr("known: pan, tilt, lift"));
  EXPECT_THAT(error(", pan: pan, tilt: pan"), HasSubstr("'pan' and 'tilt' must be two servos, got 'pan' twice"));
  EXPECT_THAT(error(", tilt: lift"), HasSubstr("'tilt' must turn: the joint of 'lift' is a slider"));
  EXPECT_THAT(error(", camera: pan"), HasSubstr("'camera' must be a camera of the vehicle, got 'pan'"));
  EXPECT_THAT(error(", camera: eye, min_fov_deg: 61"),
              HasSubstr("'fov_deg' of the camera must be from 61 to 60, got 60"));
  EXPECT_THAT(error(", camera: eye, max_fov_deg: 190"), HasSubstr("zoomed to 190 degrees, 'fov_deg' of a pinhole"));
  std::string calibrated = mount_world(", camera: eye");
  calibrated.replace(calibrated.find("fov_deg: 60"), 11, "focal_px: [200]");
  EXPECT_THAT(test::error_of_world(calibrated), HasSubstr("'camera' must have 'fov_deg', not 'focal_px'"));
  EXPECT_THAT(error(", camera: eye, zoom_speed_degps: 0"), HasSubstr("'zoom_speed_degps' must be > 0"));
  EXPECT_THAT(error(", pan: pan, min_fov_deg: 0"), HasSubstr("'min_fov_deg' must be > 0"));
}

}  // namespace
