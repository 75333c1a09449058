// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <utility>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/joint_filter.hpp"

namespace navigation {

namespace {

/// Centralized extended Kalman filter with delayed states (Webster, Eustice, Singh and Whitcomb, IJRR 31(8), 2012): the
/// states of all vehicles, and a copy of a sender's state at each transmission that may still be received.
///
///     z = |x_r(TOA) - x_s(TOL)| + c_r - c_s,   H = (u', 1) on the receiver, (-u', -1) on the copy
///
/// All measurements of all vehicles are used, with their true correlations: the reference for the others.
class CentralizedEkf final : public TeamEstimator {
 public:
  static constexpr const char* meaning = "centralized extended Kalman filter with delayed states: the reference";
  /// A transmission is no longer received after this, 15 km.
  static constexpr double flight_s = 10;

  void start(int vehicle, const Setup& setup) override {
    if (numbers_.empty()) filter_ = JointFilter(setup.sound_speed_mps, setup.gate);
    numbers_[vehicle] = filter_.add(setup.errors(), setup.time, setup.position_W, setup.position_std_m);
  }
  void predict(int vehicle, Time time, const Vector2& v_W, const Matrix2& q) override {
    filter_.move(numbers_.at(vehicle), time, v_W, q);
  }
  void fix(int vehicle, Time, const Vector2& p_W, double std_m) override {
    filter_.fix(numbers_.at(vehicle), p_W, std_m);
  }
  void sent(int vehicle, Time time) override {
    std::erase_if(copies_, [&](const auto& each) {
      const auto& [sent, copy] = each;
      if (sent.first != vehicle || seconds(time - sent.second) < flight_s) return false;
      filter_.remove(copy);
      return true;
    });
    copies_[{vehicle, time}] = filter_.copy(numbers_.at(vehicle));
  }
  void on_range(int vehicle, const ReceivedRange& received) override {
    const auto copy = copies_.find({received.sender, received.payload_time});
    if (copy == copies_.end()) return;
    filter_.range(numbers_.at(vehicle), copy->second, received.own_z_m - received.sender_z_m, received.range_m,
                  received.std_m);
  }
  void on_bearing(int vehicle, const Relative& seen) override {
    const auto other = numbers_.find(seen.other);
    if (other == numbers_.end()) return;
    filter_.see(filter_.relative_row(numbers_.at(vehicle), other->second, seen));
  }
  Estimate now(int vehicle, Time time) const override { return filter_.now(numbers_.at(vehicle), time); }

 private:
  JointFilter filter_;
  std::map<int, int> numbers_;                  ///< of the vehicles in the filter
  std::map<std::pair<int, Time>, int> copies_;  ///< by sender and time of transmission
};

SHOAL_TEAM_ESTIMATOR("cekf", CentralizedEkf);

}  // namespace

}  // namespace navigation
