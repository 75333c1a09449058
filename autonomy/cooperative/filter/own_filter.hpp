// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "autonomy/cooperative/filter/joint_filter.hpp"

namespace navigation {

/// Variance of a range due to the sender's clock, which only the sender could estimate: by its specification.
double sender_clock_variance_m2(const Setup& setup, int sender, Time since_start);

/// Returns the position that a payload begins with.
std::optional<Position> position_in(std::span<const std::uint8_t> payload);
/// Returns the payload with a position alone.
Bytes payload_of(const Position& position);
/// Throws std::invalid_argument unless the frame has `needed` bytes for the payload.
void need_bytes(const Setup& setup, const char* algorithm, std::size_t needed);

/// Whether what a vehicle knows is independent of all others: its fixes by satellite have replaced all that it said or
/// received before.  A fix keeps the share P+ / P of the errors before it; slow errors of fixes stay.
class Independence {
 public:
  void fixed(const Setup& setup, const Matrix2& P_before, const Matrix2& P_after) {
    if (setup.errors().slow_fix_m == 0) kept_ *= P_after.trace() / P_before.trace();
  }
  /// The estimate was sent to others, or used what they said.
  void shared() { kept_ = 1; }
  bool is_independent() const { return kept_ < 0.05; }

 private:
  double kept_ = 1;  ///< share of the errors at the last exchange that is still in the estimate
};

/// Part of an estimator that filters its own vehicle only: all but on_range() and make_payload().
template <class Own>
class OwnFilterEstimator : public EstimatorOf<Own> {
 public:
  void start(const Setup& setup) override {
    setup_ = setup;
    filter_ = JointFilter(setup.sound_speed_mps, setup.gate);
    filter_.add(setup.errors(), setup.time, setup.position_W, setup.position_std_m);
  }
  void predict(Time time, const Vector2& v_W, const Matrix2& q) override { filter_.move(own, time, v_W, q); }
  void fix(Time, const Vector2& p_W, double std_m) override {
    const Matrix2 before = filter_.covariance(own);
    filter_.fix(own, p_W, std_m);
    independence_.fixed(setup_, before, filter_.covariance(own));
  }
  Estimate now(Time time) const override { return filter_.now(own, time); }

 protected:
  static constexpr int own = 0;  ///< number of the vehicle in the filter

  /// Position that this vehicle sends by default.
  Position own_position(Time time) const {
    const Estimate estimate = filter_.now(own, time);
    return {estimate.p_W, estimate.P};
  }

  /// Updates with a relative measurement of a vehicle whose payload is a position, as if that were independent.
  void add_independent_bearing(const Relative& seen) {
    const auto other = position_in(seen.payload);
    if (!other) return;
    const JointFilter::RelativeRow row = filter_.relative_row(own, *other, seen);
    filter_.see(row, row.J * other->P * row.J.transpose());
  }

  /// Updates with the range to a sender whose payload is a position, as if that were independent.
  void add_independent_range(const ReceivedRange& received) {
    if (const auto sender = position_in(received.payload))
      filter_.range(own, *sender, received.own_z_m - received.sender_z_m, received.range_m, received.std_m,
                    sender_clock_variance_m2(setup_, received.sender, received.toa - setup_.time));
  }

  Setup setup_;
  JointFilter filter_;
  Independence independence_;
};

}  // namespace navigation
