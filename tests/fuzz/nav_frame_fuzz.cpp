// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/acoustic_frame.hpp"
#include "autonomy/cooperative/driver/nav_frame.hpp"
#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Frames that shoal-nav takes from acoustic modems, and their payloads, which each algorithm receives.

SHOAL_FUZZ_TARGET(nav_frame) {
  using namespace navigation;
  fuzz::Reader reader(input);
  const auto algorithms = all_algorithms();
  const Algorithm& algorithm = *algorithms[reader.below(algorithms.size())];
  const Time tol = reader.number<std::int64_t>() % (std::int64_t{1} << 60);
  const fuzz::Input rest = reader.rest();
  Bytes bytes(rest.size());
  std::transform(rest.begin(), rest.end(), bytes.begin(), [](std::byte byte) { return std::uint8_t(byte); });
  if (bytes.size() >= frame_overhead_bytes) {
    const std::uint16_t sum = autonomy::acoustic_frame::checksum(std::span(bytes).first(bytes.size() - 2));
    bytes[bytes.size() - 2] = static_cast<std::uint8_t>(sum >> 8);
    bytes[bytes.size() - 1] = static_cast<std::uint8_t>(sum);
  }
  if (const auto frame = decode_frame(bytes, tol)) {
    const auto again = decode_frame(encode_frame(*frame, bytes.size()), frame->payload_time);
    fuzz::require(again && again->payload == frame->payload && again->payload_time == frame->payload_time &&
                      again->relatives.size() == frame->relatives.size(),
                  "a frame that was received can be sent");
  }
  if (!algorithm.make) return;
  Setup setup;
  setup.team.resize(3);
  setup.payload_bytes = 200;
  const auto estimator = algorithm.make();
  estimator->start(setup);
  ReceivedRange received;
  received.sender = 1;
  received.range_m = 100;
  received.payload = bytes;
  for (int i = 1; i < 4; ++i) {
    received.toa = i * Time{1'000'000};
    estimator->predict(received.toa, {1, 0.5}, 0.01 * Matrix2::Identity());
    estimator->on_range(received);
    Relative seen;
    seen.time = received.toa;
    seen.other = 1;
    seen.range_m = 100;
    seen.by_other = i % 2 == 0;
    seen.payload = bytes;
    estimator->on_bearing(seen);
    fuzz::require(estimator->make_payload(received.toa, setup.payload_bytes).size() <= setup.payload_bytes,
                  "a payload fits");
  }
}
