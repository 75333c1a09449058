// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/imu_presets.hpp"

namespace devices {

namespace {

// The values are the typical ones of the data sheets, unless noted otherwise.  A limit given with +- is taken as three
// standard deviations, a typical value as one.  Data sheets give no correlation time of the bias: with 100 s the peak
// of the Allan deviation is at 189 s, close to the flat part of the published curves.  Values that a sheet does not
// state (rate random walk, or the bias instability of the BMI088 accelerometers) are zero. The complete sheets were not
// available.  "Checked" values are on the first page of the sheet or in the named public quote of it; "not checked"
// values have no verified source.

/// Analog Devices, data sheet ADIS16470 Rev. C.  Checked, first page: gyros 2000 deg/s, in-run bias stability 8 deg/h;
/// accelerometers 40 g, 13 ug.  Checked, a public simulator that quotes table 1: angular random walk 0.34 deg/sqrt(h).
/// Not checked: velocity random walk 0.037 m/s/sqrt(h), axis-to-axis misalignment 0.05 deg (the ADIS16467 of the same
/// family has it on its first page).  Its 32-bit output is finer than the noise: no resolution.
ImuPreset adis16470() {
  ImuPreset preset{"adis16470", {}, {}};
  preset.gyro.random_walk = 0.34 * unit::deg_per_sqrt_h;
  preset.gyro.bias_instability = 8 * unit::deg_per_h;
  preset.gyro.misalignment_rad = sim::degrees_to_radians(0.05);
  preset.gyro.range = 2000 * unit::degps;
  preset.accel.random_walk = 0.037 * unit::mps_per_sqrt_h;
  preset.accel.bias_instability = 13 * unit::ug;
  preset.accel.misalignment_rad = sim::degrees_to_radians(0.05);
  preset.accel.range = 40 * unit::mps2_per_g;
  return preset;
}

/// Bosch Sensortec, data sheet BST-BMI088-DS001.  Checked, first page: 24 g, 16 bits.  Checked, Bosch's forum
/// (community.bosch-sensortec.com, td-p/18011): gyro noise density 0.014 deg/s/sqrt(Hz) (times 60: 0.84 deg/sqrt(h)),
/// zero-rate offset 1 deg/s.  Checked, public quotes of the sheet: 2000 deg/s, gyro sensitivity tolerance 1 %, zero-g
/// offset 20 mg (at 6 g); accelerometer 230 ug/sqrt(Hz) at 24 g (160 for x and y, 190 for z at smaller ranges).
/// Checked, public quotes of the product flyer: gyro bias stability below 2 deg/h.
ImuPreset bmi088() {
  ImuPreset preset{"bmi088", {}, {}};
  preset.gyro.random_walk = 0.014 * unit::degps;
  preset.gyro.bias_instability = 2 * unit::deg_per_h;
  preset.gyro.turn_on_bias = 1 * unit::degps;
  preset.gyro.scale = 1e4 * unit::ppm;
  preset.gyro.range = 2000 * unit::degps;
  preset.gyro.resolution = 2000.0 / 32768 * unit::degps;
  preset.accel.random_walk = 230 * unit::ug;
  preset.accel.turn_on_bias = 20 * unit::mg;
  preset.accel.range = 24 * unit::mps2_per_g;
  preset.accel.resolution = 24.0 / 32768 * unit::mps2_per_g;
  return preset;
}

/// Sensonor (now Safran), data sheet STIM300, TS1524, with the accelerometers of 10 g.  Checked, documentation of
/// IS4S NavToolkit (stim300_model, rev. 9): gyros 0.5 deg/h, 0.15 deg/sqrt(h), 500 ppm, non-linearity up to 400 deg/s;
/// accelerometers 0.05 mg, 300 ppm; misalignment 1 mrad.  Checked, a table of the journal NAVIGATION
/// (navi.ion.org/highwire/markup/10540): the same noise and, as 1 sigma, bias repeatability 4 deg/h and 0.75 mg.
/// Velocity random walk: 0.07 m/s/sqrt(h) in that table and in a quote of rev. 27, 0.06 in rev. 9, 0.024 in a quote of
/// rev. 31. Full scale 400 deg/s: stated for the STIM377H of the same family.  Errors of scale and misalignment are
/// taken as 1 sigma, which the quotes do not state.
ImuPreset stim300() {
  ImuPreset preset{"stim300", {}, {}};
  preset.gyro.random_walk = 0.15 * unit::deg_per_sqrt_h;
  preset.gyro.bias_instability = 0.5 * unit::deg_per_h;
  preset.gyro.turn_on_bias = 4 * unit::deg_per_h;
  preset.gyro.scale = 500 * unit::ppm;
  preset.gyro.misalignment_rad = 1 * unit::mrad;
  preset.gyro.range = 400 * unit::degps;
  preset.accel.random_walk = 0.07 * unit::mps_per_sqrt_h;
  preset.accel.bias_instability = 50 * unit::ug;
  preset.accel.turn_on_bias = 0.75 * unit::mg;
  preset.accel.scale = 300 * unit::ppm;
  preset.accel.misalignment_rad = 1 * unit::mrad;
  preset.accel.range = 10 * unit::mps2_per_g;
  return preset;
}

/// VectorNav VN-100.  Checked, its specification in issue 111 of ethz-asl/kalibr: gyros 0.0035 deg/s/sqrt(Hz),
/// accelerometers 0.14 mg/sqrt(Hz), in-run bias stability below 10 deg/h and below 0.04 mg.  Checked, a public list of
/// IMUs (NitinJSanket/RoboticsHardware): 2000 deg/s, 16 g.  The typical 5 deg/h and the alignment within 0.05 deg are
/// quoted of the VN-200, which has the same noise.
ImuPreset vn100() {
  ImuPreset preset{"vn100", {}, {}};
  preset.gyro.random_walk = 0.0035 * unit::degps;
  preset.gyro.bias_instability = 5 * unit::deg_per_h;
  preset.gyro.misalignment_rad = sim::degrees_to_radians(0.05) / 3;
  preset.gyro.range = 2000 * unit::degps;
  preset.accel.random_walk = 140 * unit::ug;
  preset.accel.bias_instability = 40 * unit::ug;
  preset.accel.misalignment_rad = sim::degrees_to_radians(0.05) / 3;
  preset.accel.range = 16 * unit::mps2_per_g;
  return preset;
}

}  // namespace

const std::vector<ImuPreset>& imu_presets() {
  static const std::vector<ImuPreset> presets = {{"ideal", {}, {}}, adis16470(), bmi088(), stim300(), vn100()};
  return presets;
}

}  // namespace devices
