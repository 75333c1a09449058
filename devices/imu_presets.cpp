#include "devices/imu_presets.hpp"

namespace devices {

namespace {

// Every figure is one that the data sheet calls typical, unless it says otherwise.  A figure that stands with +- and
// is a limit counts as three standard deviations, a typical one as one.  A data sheet gives no correlation time of the
// bias: 100 s puts the peak of the Allan deviation at 189 s, about where the sheets draw the flat part.  What a sheet
// does not state (rate random walk, or the accelerometers' bias instability of the BMI088) is left at zero.

/// Analog Devices, data sheet ADIS16470 Rev. C, table 1: gyros 2000 deg/s, in-run bias stability 8 deg/h, angular
/// random walk 0.34 deg/sqrt(h), axis-to-axis misalignment 0.05 deg; accelerometers 40 g, 13 ug, 0.037 m/s/sqrt(h). Its
/// 32-bit output is finer than the noise: no resolution.
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

/// Bosch Sensortec, data sheet BST-BMI088-DS001: gyro noise density 0.014 deg/s/sqrt(Hz) (times 60: 0.84 deg/sqrt(h)),
/// zero-rate offset 1 deg/s, sensitivity tolerance 1 %, 2000 deg/s in 16 bits; accelerometer 160 ug/sqrt(Hz) (x and y;
/// z has 190), zero-g offset 20 mg, 24 g in 16 bits.  Gyro bias stability below 2 deg/h: from the product flyer.
ImuPreset bmi088() {
  ImuPreset preset{"bmi088", {}, {}};
  preset.gyro.random_walk = 0.014 * unit::degps;
  preset.gyro.bias_instability = 2 * unit::deg_per_h;
  preset.gyro.turn_on_bias = 1 * unit::degps;
  preset.gyro.scale = 1e4 * unit::ppm;
  preset.gyro.range = 2000 * unit::degps;
  preset.gyro.resolution = 2000.0 / 32768 * unit::degps;
  preset.accel.random_walk = 160 * unit::ug;
  preset.accel.turn_on_bias = 20 * unit::mg;
  preset.accel.range = 24 * unit::mps2_per_g;
  preset.accel.resolution = 24.0 / 32768 * unit::mps2_per_g;
  return preset;
}

/// KVH Industries, data sheet 1750 IMU (fibre-optic gyros, MEMS accelerometers, 10 g version): gyros 490 deg/s, angle
/// random walk 0.012 deg/sqrt(h), bias instability 0.05 deg/h (1 sigma), bias offset +-2 deg/h; accelerometers
/// 0.12 mg/sqrt(Hz), bias stability 0.05 mg (1 sigma), bias offset +-2 mg.
ImuPreset kvh1750() {
  ImuPreset preset{"kvh1750", {}, {}};
  preset.gyro.random_walk = 0.012 * unit::deg_per_sqrt_h;
  preset.gyro.bias_instability = 0.05 * unit::deg_per_h;
  preset.gyro.turn_on_bias = 2.0 / 3 * unit::deg_per_h;
  preset.gyro.range = 490 * unit::degps;
  preset.accel.random_walk = 120 * unit::ug;
  preset.accel.bias_instability = 50 * unit::ug;
  preset.accel.turn_on_bias = 2.0 / 3 * unit::mg;
  preset.accel.range = 10 * unit::mps2_per_g;
  return preset;
}

/// VectorNav, VN-100 product brief: gyros 2000 deg/s, in-run bias stability 5 deg/h, noise density 0.0035
/// deg/s/sqrt(Hz); accelerometers 16 g, in-run bias stability below 0.04 mg, 0.14 mg/sqrt(Hz); alignment +-0.05 deg.
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
  static const std::vector<ImuPreset> presets = {{"ideal", {}, {}}, adis16470(), bmi088(), kvh1750(), vn100()};
  return presets;
}

}  // namespace devices
