// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/world_file/metric_registry.hpp"

namespace tools {

/// Parameters of a metric of one modem or all of them, of one vehicle or all.
class ModemsParams : public sim::MetricParams {
 public:
  /// `device` must be a modem of `vehicle`.
  void check(const sim::MetricConfig& metric, const sim::WorldConfig& world,
             sim::Diagnostics& diagnostics) const override;

  std::string device;  ///< modem of the vehicle; empty: all of them

 protected:
  void read_modems(sim::ParamReader& in);
};

}  // namespace tools
