// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"

namespace navigation {

namespace {

/// Like `naive`, but a vehicle sends only the estimate of a second filter without ranges.  No information
/// returns through others, but the error of a sender is the same in each of its ranges.
class NaiveOfDeadReckoning final : public OwnFilterEstimator<NaiveOfDeadReckoning> {
 public:
  static constexpr const char* meaning = "like naive, but each vehicle sends only its dead reckoning";

  void start(const Setup& setup) override {
    need_bytes(setup, "naive_dr", position_bytes);
    OwnFilterEstimator::start(setup);
    alone_ = filter_;
  }
  void predict(Time time, const Vector2& v_W, const Matrix2& q) override {
    OwnFilterEstimator::predict(time, v_W, q);
    alone_.move(own, time, v_W, q);
  }
  void fix(Time time, const Vector2& p_W, double std_m) override {
    OwnFilterEstimator::fix(time, p_W, std_m);
    alone_.fix(own, p_W, std_m);
  }
  void on_range(const ReceivedRange& received) override { add_independent_range(received); }
  void on_bearing(const Relative& seen) override { add_independent_bearing(seen); }
  Bytes make_payload(Time time, std::size_t) override {
    const Estimate estimate = alone_.now(own, time);
    return payload_of({estimate.p_W, estimate.P});
  }

 private:
  JointFilter alone_;
};

SHOAL_ESTIMATOR("naive_dr", NaiveOfDeadReckoning);

}  // namespace

}  // namespace navigation
