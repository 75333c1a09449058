// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// Overload protection of a servo: it switches the servo off when the mean of its effort over a moving window exceeds a
/// share of the largest effort.
class ServoOverload {
 public:
  struct Params {
    double share = 0.78;
    double window_s = 30;
    void read(sim::ParamReader& in);
  };

  /// Adds the effort of a step as a share of the largest one, >= 0.  Returns whether this step switches the servo off,
  /// at the earliest after a whole window.
  bool add(const Params& params, double share, double step_s);
  /// Returns whether the servo is off.
  bool is_off() const { return off_; }
  double mean_share(const Params& params) const;
  /// Switches the servo on and starts a new window.
  void reset();
  void visit_state(sim::StateArchive& archive);

 private:
  /// Sum of the shares of some steps, times their length.
  struct Part {
    double share_s = 0, time_s = 0;
    void visit_state(sim::StateArchive& archive);
  };
  double time_s() const;

  std::vector<Part> parts_;  // of the window, the oldest first; at most about 60
  bool off_ = false;
};

}  // namespace devices
