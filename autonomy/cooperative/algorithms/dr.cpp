// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"

namespace navigation {

namespace {

/// Dead reckoning: motion and satellite fixes only.
class DeadReckoning final : public OwnFilterEstimator<DeadReckoning> {
 public:
  static constexpr const char* meaning = "dead reckoning: own motion and satellite fixes only";
  void on_range(const ReceivedRange&) override {}
  void on_bearing(const Relative&) override {}
  Bytes make_payload(Time, std::size_t) override { return {}; }
};

SHOAL_ESTIMATOR("dr", DeadReckoning);

}  // namespace

}  // namespace navigation
