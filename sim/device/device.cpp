// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/device.hpp"

#include "sim/clock/vehicle_clock.hpp"

namespace sim {

std::int64_t Publisher::utime(Time at) const {
  return epoch_us_ + (clock_ ? clock_->reading(at) : at).count();
}

Bytes& Publisher::buffer() {
  static thread_local Bytes buffer;
  return buffer;
}

Pose SweepContext::X_WS_at(Time at) const {
  if (at >= now || now == from) return X_WS;
  const double share = to_seconds(at - from) / to_seconds(now - from);
  Pose X = Pose::Identity();
  X.linear() = Quaterniond(X_WS_from.linear()).slerp(share, Quaterniond(X_WS.linear())).toRotationMatrix();
  X.translation() = X_WS_from.translation() + share * (X_WS.translation() - X_WS_from.translation());
  return X;
}

}  // namespace sim
