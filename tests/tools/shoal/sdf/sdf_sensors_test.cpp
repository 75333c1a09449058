// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/tools/shoal/sdf/sdf_texts.hpp"

namespace {

using namespace test;
using testing::HasSubstr;

tools::RobotImport with_sensor(const std::string& type, const std::string& content) {
  return imported_sdf(sdf_text(sdf_link("a", "<sensor name=\"s\" type=\"" + type + "\">" + content + "</sensor>")));
}

std::string gaussian(const std::string& more) {
  return "<noise type=\"gaussian\">" + more + "</noise>";
}

TEST(SdfSensors, KeepPlaceRateAndNoiseOfAnImu) {
  const std::string axis =
      gaussian("<mean>0.5</mean><stddev>0.01</stddev><bias_mean>3</bias_mean><bias_stddev>4</bias_stddev>");
  const tools::RobotImport import =
      with_sensor("imu", "<pose>1 2 3 0 0 0</pose><update_rate>50</update_rate><imu><angular_velocity><x>" + axis +
                             "</x><y>" + axis + "</y><z>" + axis + "</z></angular_velocity></imu>");
  const tools::ImportedDevice& imu = device_of(import, "s");
  EXPECT_EQ(imu.type, "imu");
  EXPECT_TRUE(imu.X_BS.translation().isApprox(sim::Vector3d(1, 2, 3)));
  EXPECT_EQ(key_of(imu.keys, "rate_hz"), "50");
  // The bias has a random sign: its mean square is 3^2 + 4^2.
  EXPECT_EQ(key_of(imu.keys, "gyro_noise"), "{bias: 0.5, gaussian_std: 0.01, bias_std: 5}");
  EXPECT_EQ(notes_of(import.vehicle), "");
}

TEST(SdfSensors, TurnADynamicBiasIntoAGaussMarkovProcess) {
  // It settles at 0.02 sqrt(8 / 2) = 0.04.
  const tools::RobotImport import =
      with_sensor("air_pressure", "<air_pressure><pressure>" +
                                      gaussian("<dynamic_bias_stddev>0.02</dynamic_bias_stddev>"
                                               "<dynamic_bias_correlation_time>8</dynamic_bias_correlation_time>") +
                                      "</pressure></air_pressure>");
  EXPECT_EQ(device_of(import, "s").type, "pressure");
  EXPECT_EQ(key_of(device_of(import, "s").keys, "pressure_noise"), "{gauss_markov_std: 0.04, gauss_markov_time_s: 8}");
}

TEST(SdfSensors, TurnTheFrameOfALidarToTheMiddleOfItsFan) {
  const tools::RobotImport import = with_sensor(
      "gpu_lidar",
      "<lidar><scan><horizontal><samples>91</samples><min_angle>0</min_angle><max_angle>1.5707963267948966</max_angle>"
      "</horizontal></scan><range><min>0.1</min><max>inf</max><resolution>0.01</resolution></range>"
      "<noise><type>gaussian</type><stddev>0.02</stddev></noise></lidar>");
  const tools::ImportedDevice& lidar = device_of(import, "s");
  EXPECT_EQ(lidar.type, "lidar");
  EXPECT_EQ(key_of(lidar.keys, "beams"), "91");
  EXPECT_EQ(key_of(lidar.keys, "fov_deg"), "90");
  EXPECT_NEAR(sim::yaw_of(lidar.X_BS.linear()), sim::degrees_to_radians(45), 1e-12);
  EXPECT_EQ(key_of(lidar.keys, "range_max_m"), "1000");
  EXPECT_EQ(key_of(lidar.keys, "noise"), "{gaussian_std: 0.02}");
  EXPECT_THAT(notes_of(import.vehicle), HasSubstr("m.sdf:2: sensor 's': its <max> becomes 1000 m\n"));
}

TEST(SdfSensors, MakeALidarOfSeveralRings) {
  const tools::RobotImport import = with_sensor(
      "gpu_ray",
      "<ray><scan><horizontal><samples>900</samples><min_angle>-3.14159</min_angle><max_angle>3.14159</max_angle>"
      "</horizontal><vertical><samples>16</samples><min_angle>-0.2617993877991494</min_angle>"
      "<max_angle>0.2617993877991494</max_angle></vertical></scan></ray>");
  const tools::ImportedDevice& lidar = device_of(import, "s");
  EXPECT_EQ(lidar.type, "lidar3d");
  EXPECT_EQ(key_of(lidar.keys, "rings"), "16");
  EXPECT_EQ(key_of(lidar.keys, "lowest_deg"), "-15");
  EXPECT_EQ(key_of(lidar.keys, "columns"), "900");
}

TEST(SdfSensors, MakeTwoCamerasOfOneWithDepth) {
  const tools::RobotImport import =
      with_sensor("rgbd_camera",
                  "<camera><horizontal_fov>1.5707963267948966</horizontal_fov><image><width>640</width>"
                  "<height>480</height></image><clip><near>0.1</near><far>12</far></clip>" +
                      gaussian("<stddev>0.01</stddev>") + "</camera>");
  EXPECT_EQ(key_of(device_of(import, "s").keys, "fov_deg"), "90");
  EXPECT_EQ(key_of(device_of(import, "s").keys, "image"), "");
  EXPECT_EQ(key_of(device_of(import, "s_depth").keys, "image"), "depth");
  EXPECT_EQ(key_of(device_of(import, "s_depth").keys, "range_max_m"), "12");
  EXPECT_EQ(key_of(device_of(import, "s_depth").keys, "noise"), "{gaussian_std: 0.01}");
  // Of a camera it is a share of 255 levels.
  const tools::RobotImport camera = with_sensor("camera", "<camera>" + gaussian("<stddev>0.02</stddev>") + "</camera>");
  EXPECT_EQ(key_of(device_of(camera, "s").keys, "noise"), "{gaussian_std: 5.1}");
}

TEST(SdfSensors, TakeTheNoiseOfAMagnetometerInTesla) {
  const tools::RobotImport import =
      with_sensor("magnetometer", "<magnetometer><x>" + gaussian("<stddev>1e-6</stddev>") + "</x></magnetometer>");
  EXPECT_EQ(device_of(import, "s").type, "compass");
  EXPECT_EQ(key_of(device_of(import, "s").keys, "field_noise"), "{gaussian_std: 1}");
  EXPECT_THAT(notes_of(import.vehicle), HasSubstr("the noise of y and z of <magnetometer> is not imported"));
}

TEST(SdfSensors, MeasureAJoint) {
  const tools::RobotImport import = imported_sdf(sdf_text(
      sdf_link("a") + sdf_link("b") +
      sdf_joint("ball", "<sensor name=\"s\" type=\"force_torque\"><force_torque><force><x>" +
                            gaussian("<stddev>2</stddev>") + "</x><y>" + gaussian("<stddev>2</stddev>") + "</y><z>" +
                            gaussian("<stddev>2</stddev>") + "</z></force></force_torque></sensor>")));
  EXPECT_EQ(device_of(import, "s").type, "joint_load");
  EXPECT_EQ(device_of(import, "s").body, "b");
  EXPECT_EQ(key_of(device_of(import, "s").keys, "joint"), "j");
  EXPECT_EQ(key_of(device_of(import, "s").keys, "force_noise"), "{gaussian_std: 2}");
}

TEST(SdfSensors, AreLeftOutWithANoteWhenTheyAreUnknownOrWrong) {
  EXPECT_EQ(
      notes_of(with_sensor("altimeter", "").vehicle),
      "m.sdf:2: sensor 's': a sensor of type 'altimeter' is not imported: that of Shoal is a sonar; `pressure` and "
      "`gps` have heights\n");
  EXPECT_EQ(
      notes_of(with_sensor("wireless_receiver", "").vehicle),
      "m.sdf:2: sensor 's': a sensor of type 'wireless_receiver' is not imported: no device of Shoal is like it\n");
  const tools::RobotImport wrong = with_sensor(
      "imu", "<imu><angular_velocity><x>" + gaussian("<stddev>nan</stddev>") + "</x></angular_velocity></imu>");
  EXPECT_TRUE(wrong.vehicle.devices.empty());
  EXPECT_THAT(notes_of(wrong.vehicle),
              HasSubstr("must be a number between -1e9 and 1e9, got 'nan': this sensor is not imported"));
  EXPECT_THAT(
      notes_of(with_sensor("ray", "<ray><scan><horizontal><samples>1e8</samples></horizontal></scan></ray>").vehicle),
      HasSubstr("are not those of a lidar of Shoal"));
}

}  // namespace
