// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <stdexcept>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"

namespace navigation {

namespace {

/// Set of vehicles, one bit each.
using Set = std::uint32_t;

/// Interleaved update (Bahr, Walter and Leonard, ICRA 2009): a bank of filters, one for each set of vehicles whose
/// information is in it.  A range updates a copy of a filter with set a by what a filter of the sender with set b says,
/// only if a and b are disjoint, so that no information is used twice; the result belongs to the set a + b, and
/// replaces the filter there if the trace of its covariance is less.  The estimate is the filter of least trace.
///
/// The bank grows to 2^(N-1) filters; beyond `max_filters` those of greatest trace are given up, but never the one that
/// has the own vehicle alone.
///
/// The own vehicle is in each of its sets.  A sender whose fixes by satellite replaced all that it said before has the
/// empty set: it is news.
class InterleavedUpdate final : public EstimatorOf<InterleavedUpdate> {
 public:
  static constexpr const char* meaning = "interleaved update: a bank of filters that never uses information twice";
  static constexpr std::size_t max_team = 32;
  static constexpr std::size_t max_filters = 16;

  void start(const Setup& setup) override {
    set_bytes_ = static_cast<int>((setup.team.size() + 7) / 8);
    need_bytes(setup, "iu", filter_bytes());
    if (setup.team.size() > max_team)
      throw std::invalid_argument("iu has up to " + std::to_string(max_team) + " vehicles, this team has " +
                                  std::to_string(setup.team.size()));
    setup_ = setup;
    JointFilter filter(setup.sound_speed_mps, setup.gate);
    filter.add(setup.errors(), setup.time, setup.position_W, setup.position_std_m);
    bank_ = {{own_set(), filter}};
  }
  void predict(Time time, const Vector2& v_W, const Matrix2& q) override {
    for (auto& [set, filter] : bank_) filter.move(own, time, v_W, q);
  }
  void fix(Time, const Vector2& p_W, double std_m) override {
    JointFilter& alone = bank_.at(own_set());
    const Matrix2 before = alone.covariance(own);
    for (auto& [set, filter] : bank_) filter.fix(own, p_W, std_m);
    independence_.fixed(setup_, before, alone.covariance(own));
  }
  void on_range(const ReceivedRange& received) override {
    std::map<Set, JointFilter> results;
    PayloadReader reader(received.payload);
    while (reader.left() >= filter_bytes()) {
      const auto senders_set = static_cast<Set>(reader.whole(set_bytes_));
      const auto sender = read_position(reader);
      if (!sender) break;
      for (const auto& [set, filter] : bank_) {
        // Both contain information of the same vehicle, which must not be used twice.
        if ((set & senders_set) != 0) continue;
        JointFilter result = filter;
        if (result.range(own, *sender, received.own_z_m - received.sender_z_m, received.range_m, received.std_m,
                         sender_clock_variance_m2(setup_, received.sender, received.toa - setup_.time)) ==
            JointFilter::Outcome::refused)
          continue;
        keep_better(results, set | senders_set, result);
      }
    }
    for (const auto& [set, result] : results) keep_better(bank_, set, result);
    // There are 2^n sets of vehicles, so the bank is limited.
    while (bank_.size() > max_filters) bank_.erase(worst());
  }
  Bytes make_payload(Time time, std::size_t max_bytes) override {
    std::vector<std::pair<double, Set>> order;
    for (const auto& [set, filter] : bank_) order.emplace_back(trace(filter), set);
    std::sort(order.begin(), order.end());
    // The filter without ranges contains no information of other vehicles.
    const bool is_independent = independence_.is_independent();
    if (is_independent) order = {{0, own_set()}};
    independence_.shared();
    Bytes payload;
    PayloadWriter writer(payload);
    for (const auto& [trace_m2, set] : order) {
      if (payload.size() + filter_bytes() > max_bytes) break;
      const Estimate estimate = bank_.at(set).now(own, time);
      writer.whole(is_independent ? 0 : set, set_bytes_);
      write_position(writer, {estimate.p_W, estimate.P});
    }
    return payload;
  }
  Estimate now(Time time) const override { return best().now(own, time); }

 private:
  static constexpr int own = 0;

  std::size_t filter_bytes() const { return position_bytes + static_cast<std::size_t>(set_bytes_); }
  Set own_set() const { return Set{1} << setup_.own; }
  static double trace(const JointFilter& filter) { return filter.covariance(own).trace(); }
  static void keep_better(std::map<Set, JointFilter>& bank, Set set, const JointFilter& filter) {
    const auto [place, is_new] = bank.try_emplace(set, filter);
    if (!is_new && trace(filter) < trace(place->second)) place->second = filter;
  }
  const JointFilter& best() const {
    return std::min_element(bank_.begin(), bank_.end(),
                            [](const auto& a, const auto& b) { return trace(a.second) < trace(b.second); })
        ->second;
  }
  /// Filter of greatest trace but the own one.
  std::map<Set, JointFilter>::iterator worst() {
    const auto weight = [this](const auto& each) { return each.first == own_set() ? -1 : trace(each.second); };
    return std::max_element(bank_.begin(), bank_.end(),
                            [&](const auto& a, const auto& b) { return weight(a) < weight(b); });
  }

  Setup setup_;
  int set_bytes_ = 1;  ///< of a set in a payload
  std::map<Set, JointFilter> bank_;
  Independence independence_;  ///< of the filter of the own vehicle alone
};

SHOAL_ESTIMATOR("iu", InterleavedUpdate);

}  // namespace

}  // namespace navigation
