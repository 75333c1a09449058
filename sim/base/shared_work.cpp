// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/shared_work.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr double min_gain = 1.1;

}  // namespace

double SharedWork::shared_part() const {
  const double all_s = alone_s + shared_s;
  return all_s > 0 ? shared_s / all_s : 0;
}

double SharedWork::time_s(int threads) const {
  return alone_s + std::max(shared_s / threads, std::min(max_piece_s, shared_s));
}

int SharedWork::useful_threads() const {
  constexpr int max_threads = 1024;
  int threads = 1;
  while (threads < max_threads && time_s(threads) >= min_gain * time_s(2 * threads)) ++threads;
  return threads;
}

std::string SharedWork::advice(int threads) const {
  constexpr std::int64_t min_steps = 10;
  if (steps < min_steps || time_s(threads) >= min_gain * time_s(2 * threads)) return {};
  const int useful = std::min(threads, useful_threads());
  const std::string reason =
      "they share " + std::to_string(std::lround(100 * shared_part())) + " % of the work of a step";
  return "more than " + std::to_string(useful) + (useful == 1 ? " thread" : " threads") +
         " would gain less than a tenth: " + reason;
}

}  // namespace sim
