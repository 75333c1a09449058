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

/// Configuration of one device of a vehicle: the keys common to all devices, and the parameters of its type.
struct DeviceConfig {
  std::string name;                        ///< unique in its vehicle
  std::string type;                        ///< name of the device type, such as `lidar`
  std::string body;                        ///< body on which it is mounted; empty: first body of the vehicle
  Vector3d position_m = Vector3d::Zero();  ///< position of the sensor frame S in the body frame B
  Vector3d rpy_rad = Vector3d::Zero();     ///< roll, pitch and yaw of S in B
  double rate_hz = 0;                      ///< samples per simulated second; 0: every step
  std::optional<double> phase_s;  ///< time of the first sample; unset: derived from the name, spread over the period
  double latency_s = 0;           ///< sensor: sample to report; actuator: message to effect
  double jitter_s = 0;            ///< added to the latency, uniform in [0, jitter)
  double dropout = 0;             ///< probability that a report or a command is lost
  bool truth = false;             ///< also publish the reading without errors
  double power_W = 0;             ///< constant power drawn from the battery of the vehicle
  std::string channel;            ///< channel of the reports; empty: by the template of the world
  double watchdog_s = 0;          ///< actuator: a command older than this is stale; 0: never
  SafeState safe{};               ///< actuator: behavior without a valid command

  const DeviceType* device_type = nullptr;     ///< the registered type; null when it is unknown
  std::shared_ptr<const DeviceParams> params;  ///< the keys of the type
  SourcePlace place;                           ///< place in the source file, for errors found later
  std::shared_ptr<const ConfigNode> source;    ///< source tree, for changes at run time

  /// Reads the common keys and those of the type.
  void read(ParamReader& in);
  /// Reads the keys common to all devices; also used by `shoal describe` and the documentation.
  void read_common(ParamReader& in);
  /// Reads the keys common to all actuators, with the safe states of the type.
  void read_actuator(ParamReader& in, const DeviceType& of);
  /// Pose of the sensor frame S in the body frame B.
  Pose X_BS() const { return make_pose(position_m, rpy_rad); }
};

}  // namespace sim
