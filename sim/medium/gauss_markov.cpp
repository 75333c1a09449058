// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/gauss_markov.hpp"

#include <algorithm>

namespace sim {

GaussMarkov::GaussMarkov(const Vector3d& std, double correlation_time_s, Random random)
    : std_(std),
      correlation_time_s_(correlation_time_s),
      tick_us_(std::max<std::int64_t>(1000, from_seconds(correlation_time_s / 50).count())),
      random_(random) {
  from_ = std_.cwiseProduct(draw(0));
  values_ = from_;
  to_ = from_;
  tick_ = -1;
  advance_to(Time{0});
}

Vector3d GaussMarkov::draw(std::int64_t tick) {
  random_.begin_step(tick);
  const double x = random_.gaussian(), y = random_.gaussian(), z = random_.gaussian();
  return {x, y, z};
}

void GaussMarkov::advance_to(Time now) {
  const std::int64_t desired = now.count() / tick_us_;
  const double dt_s = static_cast<double>(tick_us_) * 1e-6;
  // Values from more than 1300 correlation times ago have a weight of e^-1300, below rounding, and are skipped.
  constexpr std::int64_t remembered_ticks = 1 << 16;
  // Only a forged snapshot has a tick in the future.
  tick_ = std::clamp(tick_, desired - remembered_ticks, desired);
  for (; tick_ < desired; ++tick_) {
    from_ = to_;
    to_ = kept_share(dt_s, correlation_time_s_) * from_ +
          fresh_std(1, dt_s, correlation_time_s_) * std_.cwiseProduct(draw(tick_ + 2));
  }
  const double share = static_cast<double>(now.count() - tick_ * tick_us_) / static_cast<double>(tick_us_);
  values_ = from_ + (to_ - from_) * share;
}

}  // namespace sim
