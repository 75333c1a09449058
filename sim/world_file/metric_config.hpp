// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/script/event_config.hpp"

namespace sim {

struct WorldConfig;

/// What a metric looks at.
enum class MetricType {
  position_error,   ///< the distance between an estimate on a channel and the truth
  consistency,      ///< whether the covariance of an estimate says how large its errors are
  distance,         ///< how far a vehicle went
  delivery,         ///< packets on the acoustic channel
  bytes_per_metre,  ///< what a metre of better position cost in bytes
  mission_time,     ///< when something became true for the first time
  collisions,       ///< contacts that began
  messages,         ///< how many came on a channel
  lean,             ///< how far a vehicle leans
};

/// One entry of `metrics:`; gives figures that score the run.
struct MetricConfig {
  std::string name;
  MetricType type = MetricType::position_error;
  std::string vehicle;          ///< whose truth counts; empty, where that is allowed: all
  std::string channel;          ///< of the estimate (shoal.pose_t or shoal.estimate_t), or whose messages are counted
  double from_s = 0;            ///< what comes before this time does not count
  int dimensions = 2;           ///< of an error: 2: horizontal, 3
  std::string device;           ///< modem of the vehicle; empty: all of them
  std::string metric, against;  ///< bytes_per_metre: position errors with and without the help of messages
  Condition when;               ///< mission_time; kind none: the vehicle is within radius_m of position_m
  Vector3d position_m = Vector3d::Zero();
  double radius_m = 0;
  std::string with;  ///< collisions: vehicle or object; empty: all, but planes
  SourcePlace place;

  void read(ParamReader& in);
  /// Names of its figures, `NAME.figure`, as pass rules and the summary call them.
  std::vector<std::string> figures() const;

 private:
  void check_keys(ParamReader& in) const;
};

/// The run passes when every rule holds.
struct PassRule {
  std::string metric;  ///< such as `cooperative.rms_m`
  std::optional<double> below, above, equals;
  std::string below_metric, above_metric;  ///< another figure, times `factor`
  double factor = 1;
  void read(ParamReader& in);
};

/// Makes the position errors known that other metrics of the list may name.  Call before `metrics` is read.
void declare_position_errors(ParamReader& in);
/// Makes the figures known that pass rules may name.
void declare_figures(ParamReader& in, const std::vector<MetricConfig>& metrics);
/// Reports devices that are not there.  Call when the vehicles are known.
void check_metrics(const WorldConfig& world, Diagnostics& diagnostics);

/// The words of the SignalLoss, as in `NAME.lost_CAUSE`.
const std::vector<std::string>& loss_causes();

}  // namespace sim
