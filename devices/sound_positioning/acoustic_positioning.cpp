// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/acoustic_positioning.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "devices/sound_positioning/transponder.hpp"
#include "sim/medium/water_column.hpp"

namespace devices {
namespace {

template <typename T>
void append(sim::Bytes& to, const T& value) {
  const std::size_t at = to.size();
  to.resize(at + sizeof(T));
  std::memcpy(to.data() + at, &value, sizeof(T));
}

template <typename T>
T value_at(const sim::Bytes& from, std::size_t at) {
  T value;
  std::memcpy(&value, from.data() + at, sizeof(T));
  return value;
}

}  // namespace

sim::ReceiverConfig receiver_of_tones() {
  sim::ReceiverConfig receiver;
  receiver.doppler_limit_mps = 20;
  return receiver;
}

sim::Bytes encode_ping(std::int64_t number) {
  sim::Bytes payload;
  append(payload, number);
  return payload;
}

std::int64_t decode_ping(const sim::Bytes& payload) {
  return payload.size() == sizeof(std::int64_t) ? value_at<std::int64_t>(payload, 0) : 0;
}

sim::Bytes encode_answer(const PingAnswer& answer) {
  sim::Bytes payload;
  append(payload, answer.ping);
  append(payload, answer.turnaround_s);
  append(payload, answer.out_m);
  const auto* code = reinterpret_cast<const std::byte*>(answer.code.data());
  payload.insert(payload.end(), code, code + answer.code.size());
  return payload;
}

std::optional<PingAnswer> decode_answer(const sim::Bytes& payload) {
  if (payload.size() < 24) return std::nullopt;
  return PingAnswer{value_at<std::int64_t>(payload, 0), value_at<double>(payload, 8), value_at<double>(payload, 16),
                    std::string(reinterpret_cast<const char*>(payload.data()) + 24, payload.size() - 24)};
}

double TransponderNetwork::free_answer_Hz(const std::string& network, double bandwidth_Hz) const {
  constexpr double min_apart_Hz = 1000;
  const auto taken = [&](double answer_Hz) {
    return std::any_of(members_.begin(), members_.end(), [&](const Transponder* member) {
      return member->params().network == network &&
             std::abs(member->answer_Hz() - answer_Hz) < (member->params().bandwidth_Hz + bandwidth_Hz) / 2;
    });
  };
  double answer_Hz = lowest_answer_Hz;
  // Answers must not overlap in frequency, or the interrogator could not tell them apart.
  while (taken(answer_Hz)) answer_Hz += std::max(min_apart_Hz, bandwidth_Hz);
  return answer_Hz;
}

namespace {

sim::SoundProfile profile_of(const sim::WaterConfig& config) {
  constexpr double deepest_m = 12000, gravity_mps2 = 9.80665;
  const sim::WaterColumn column(config, gravity_mps2);
  std::vector<double> rows_m;
  for (const sim::WaterLayerConfig& row : config.profile) rows_m.push_back(row.depth_m);
  return sim::SoundProfile::fitted([&](double depth_m) { return column.sound_speed_mps(depth_m); }, rows_m, deepest_m);
}

}  // namespace

void warn_of_assumed_water(const std::optional<sim::WaterConfig>& water, const sim::DeviceContext& context) {
  if (!water) return;
  for (const std::string& warning : water->warnings)
    context.host.warnings.building().warn(water->place, "device '" + context.config.name + "': assumed_water", warning);
}

AssumedWater::AssumedWater(const sim::WaterConfig& config) : rays_(profile_of(config)) {}

double AssumedWater::first_arrival_s(double own_depth_m, double depth_m, double across_m) const {
  std::vector<sim::SoundRay> rays;
  rays_.find({.source_m = own_depth_m,
              .receiver_m = depth_m,
              .range_m = across_m,
              .water_m = std::numeric_limits<double>::infinity(),
              .max_bounces = 1},
             rays);
  // In a shadow of the assumed water no ray arrives; a straight line at the mean speed is the best guess.
  if (!rays.empty()) return rays.front().travel_time_s;
  const double mean_mps = (profile().speed_mps(own_depth_m) + profile().speed_mps(depth_m)) / 2;
  return std::hypot(across_m, depth_m - own_depth_m) / mean_mps;
}

double AssumedWater::distance_m(double own_depth_m, double depth_m, double time_s) const {
  constexpr double fastest_mps = 2000;
  const double down_m = depth_m - own_depth_m;
  double near_m = 0, far_m = fastest_mps * time_s;
  // Bisection, to a tenth of a millimeter within 10 km.
  for (int i = 0; i < 28; ++i) {
    const double across_m = (near_m + far_m) / 2;
    (first_arrival_s(own_depth_m, depth_m, across_m) < time_s ? near_m : far_m) = across_m;
  }
  return std::hypot((near_m + far_m) / 2, down_m);
}

}  // namespace devices
