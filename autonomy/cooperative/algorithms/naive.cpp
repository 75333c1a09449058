// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"

namespace navigation {

namespace {

/// Extended Kalman filter of the own vehicle that regards what the others say as independent of what it knows:
///
///     S = u' P u + u' B u + R,   K = P u / S
///
/// with the own covariance P, that of the sender B, and the unit vector u from the sender.  Information that left this
/// vehicle and comes back is counted again, so that P becomes too small.
class Naive final : public OwnFilterEstimator<Naive> {
 public:
  static constexpr const char* meaning = "EKF that treats received estimates as independent";

  void start(const Setup& setup) override {
    need_bytes(setup, "naive", position_bytes);
    OwnFilterEstimator::start(setup);
  }
  void on_range(const ReceivedRange& received) override { add_independent_range(received); }
  void on_bearing(const Relative& seen) override { add_independent_bearing(seen); }
  Bytes make_payload(Time time, std::size_t) override { return payload_of(own_position(time)); }
};

SHOAL_ESTIMATOR("naive", Naive);

}  // namespace

}  // namespace navigation
