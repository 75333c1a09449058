// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"

namespace navigation {

namespace {

/// The filter of `naive` without the state of the clock: it assumes that all clocks are synchronized, so that their
/// errors become errors of the position.
class NaiveClockless final : public OwnFilterEstimator<NaiveClockless> {
 public:
  static constexpr const char* meaning = "like naive, but it assumes that all clocks are synchronized";

  void start(const Setup& setup) override {
    need_bytes(setup, "naive_clockless", position_bytes);
    Setup without_clocks = setup;
    for (Member& member : without_clocks.team)
      member.errors.clock_s = member.errors.clock_drift = member.errors.clock_walk_srts = 0;
    OwnFilterEstimator::start(without_clocks);
  }
  void on_range(const ReceivedRange& received) override {
    if (const auto sender = position_in(received.payload))
      filter_.range(own, *sender, received.own_z_m - received.sender_z_m, received.range_m, received.std_m);
  }
  Bytes make_payload(Time time, std::size_t) override { return payload_of(own_position(time)); }
};

SHOAL_ESTIMATOR("naive_clockless", NaiveClockless);

}  // namespace

}  // namespace navigation
