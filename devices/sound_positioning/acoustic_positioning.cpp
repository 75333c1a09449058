// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/acoustic_positioning.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "devices/sound_positioning/transponder.hpp"

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

}  // namespace devices
