// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

struct DeviceType;
enum class SafeState;

/// The parameters of one device type, read from YAML.
class DeviceParams {
 public:
  virtual ~DeviceParams() = default;
  /// Reads the keys of the type.
  virtual void read(ParamReader& in) = 0;
};

/// One device of a vehicle as configured.  The keys here are understood by every device.
struct DeviceConfig {
  std::string name;                        ///< unique in its vehicle
  std::string type;                        ///< name of the device type, such as `lidar`
  std::string body;                        ///< where it is mounted; empty: the vehicle's first body
  Vector3d position_m = Vector3d::Zero();  ///< of the sensor frame S in the body frame B
  Vector3d rpy_rad = Vector3d::Zero();     ///< roll, pitch and yaw of S in B
  double rate_hz = 0;                      ///< samples per simulated second; 0: every step
  std::optional<double> phase_s;           ///< time of the first sample; unset: spread over the period by name
  double latency_s = 0;                    ///< sensor: sample to report; actuator: message to effect
  double jitter_s = 0;                     ///< added to the latency, uniform in [0, jitter)
  double dropout = 0;                      ///< probability that a report or a command is lost
  bool truth = false;                      ///< publish the reading without errors beside the report
  double power_W = 0;                      ///< power drawn from the vehicle's battery all the time
  std::string channel;                     ///< of the reports; empty: by the world's template
  double watchdog_s = 0;                   ///< actuator: a command older than this is stale; 0: never
  SafeState safe{};                        ///< actuator: where it goes then

  const DeviceType* device_type = nullptr;     ///< the registered type; null when it is unknown
  std::shared_ptr<const DeviceParams> params;  ///< the keys of the type
  SourcePlace place;                           ///< where the device was written, for errors found later
  std::shared_ptr<const ConfigNode> source;    ///< as it was written, for changes while it runs

  /// Reads the common keys and those of the type.
  void read(ParamReader& in);
  /// The keys common to all devices, for `shoal describe` and the docs.
  void read_common(ParamReader& in);
  /// The keys of every actuator, with the safe states that the type knows.
  void read_actuator(ParamReader& in, const DeviceType& of);
  /// Pose of the sensor frame S in the body frame B.
  Pose X_BS() const { return make_pose(position_m, rpy_rad); }
};

}  // namespace sim
