// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/world_file/metric_registry.hpp"

namespace experiment {

/// Parameters of a metric of one modem or all modems, of one vehicle or all vehicles.
class ModemsParams : public sim::MetricParams {
 public:
  /// Checks that `device` is a modem of `vehicle`.
  void check(const sim::MetricConfig& metric, const sim::WorldConfig& world,
             sim::Diagnostics& diagnostics) const override;

  std::string device;  ///< modem of the vehicle; empty: all of its modems

 protected:
  void read_modems(sim::ParamReader& in);
};

}  // namespace experiment
