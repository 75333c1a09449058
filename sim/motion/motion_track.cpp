// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/motion_track.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

constexpr double same_time_s = 1e-9;  // of a frame and a key: 25 * 0.008 need not be 0.2

/// Slope of the spline at a key, 1/s times the unit of the value.
double slope_at(const std::vector<TrackKey>& keys, std::size_t i) {
  if (i == 0 || i + 1 == keys.size()) return 0;
  return (keys[i + 1].value - keys[i - 1].value) / (keys[i + 1].at_s - keys[i - 1].at_s);
}

double hermite(const std::vector<TrackKey>& keys, std::size_t i, double s) {
  const double duration_s = keys[i].at_s - keys[i - 1].at_s;
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * keys[i - 1].value + (3 * s2 - 2 * s3) * keys[i].value +
         duration_s * ((s3 - 2 * s2 + s) * slope_at(keys, i - 1) + (s3 - s2) * slope_at(keys, i));
}

/// Share of the way at a share of the time.
double eased(Easing ease, double s) {
  switch (ease) {
    case Easing::cosine:
      return (1 - std::cos(std::numbers::pi * s)) / 2;
    case Easing::smooth:
      return s * s * (3 - 2 * s);
    case Easing::step:
      return 0;
    case Easing::linear:
    case Easing::spline:
      break;
  }
  return s;
}

}  // namespace

double MotionTrack::value_at(double t_s) const {
  const auto next =
      std::upper_bound(keys.begin(), keys.end(), t_s, [](double t, const TrackKey& key) { return t < key.at_s; });
  if (next == keys.begin()) return keys.front().value;
  if (next == keys.end()) return keys.back().value;
  const TrackKey& before = *(next - 1);
  // Times near a key count as the key, so that frames at keys have exactly its value in spite of rounding.
  if (next->at_s - t_s < same_time_s) return next->value;
  if (t_s - before.at_s < same_time_s) return before.value;
  const double s = (t_s - before.at_s) / (next->at_s - before.at_s);
  if (next->ease == Easing::spline) return hermite(keys, static_cast<std::size_t>(next - keys.begin()), s);
  return before.value + eased(next->ease, s) * (next->value - before.value);
}

}  // namespace sim
