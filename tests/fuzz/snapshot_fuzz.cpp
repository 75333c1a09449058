// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <limits>

#include "messages/yaml/message_writer.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// A crafted snapshot: that of a world, changed at a few places.  The input is the list of changes, so that it means
// something also when the state has got another form.  What is restored must continue for a few steps.

namespace {

const sim::LoadedWorld& snapshot_world() {
  static const sim::LoadedWorld loaded = [] {
    sim::LoadOptions options;
    options.encode_message = shoal::encode_own_message;
    return sim::load_world_text(R"(
shoal: 1
physics: {step_s: 0.02}
medium:
  water: {}
  current: [{velocity_mps: [0.1, 0, 0]}, {type: gauss_markov, speed_mps: 0.1}]
  wind: {speed_mps: 4, from_compass_deg: 220}
acoustics: {fading: {type: log_normal, std_dB: 6}}
objects:
  - {name: bottom, fixed: true, position_m: [0, 0, -40], parts: [{shape: plane}]}
  - {name: ball, position_m: [5, 5, 1], parts: [{shape: sphere, mass_kg: 2}]}
zones: [{name: zone, shape: box, size_m: [9, 9, 9]}]
vehicles:
  - {name: auv, file: remus100_nav.yaml, position_m: [0, 0, -3]}
  - {name: boat, file: otter_beacon.yaml, position_m: [0, 60, 0]}
  - {name: rover, file: rover_swarm.yaml, position_m: [40, 0, -40]}
events:
  - {name: late, at: 0.9, do: [{move: {name: ball, position_m: [5, 5, 3]}}]}
)",
                                "worlds/fuzz.yaml", options);
  }();
  return loaded;
}

struct Restored {
  sim::InProcessBus bus;
  sim::World world{snapshot_world().config, bus};
  sim::Bytes base;
  Restored() {
    for (int step = 0; step < 40; ++step) world.step();
    base = world.state().snapshot();
  }
};

void put(sim::Bytes& bytes, std::size_t at, const void* from, std::size_t size) {
  size = std::min(size, bytes.size() - at);
  if (size > 0) std::memcpy(bytes.data() + at, from, size);
}

void change(sim::Bytes& bytes, fuzz::Reader& reader) {
  using Double = std::numeric_limits<double>;
  static constexpr std::array doubles{Double::quiet_NaN(), Double::infinity(), -1.0, 0.0, 1e300, -1e-300, 1e18};
  static constexpr std::array<std::int64_t, 8> integers{0,
                                                        -1,
                                                        1,
                                                        1'000'000,
                                                        std::int64_t{1} << 32,
                                                        std::int64_t{1} << 62,
                                                        std::numeric_limits<std::int64_t>::max(),
                                                        std::numeric_limits<std::int64_t>::min()};
  const std::size_t at = reader.number<std::uint32_t>() % bytes.size();
  switch (reader.below(7)) {
    case 0:
      bytes[at] ^= static_cast<std::byte>(1u << reader.below(8));
      break;
    case 1:
      bytes[at] = std::byte{reader.byte()};
      break;
    case 2:
      put(bytes, at, &doubles[reader.below(doubles.size())], sizeof(double));
      break;
    case 3:
      put(bytes, at, &integers[reader.below(integers.size())], sizeof(std::int64_t));
      break;
    case 4: {
      const auto value = reader.number<std::int64_t>();
      put(bytes, at, &value, sizeof value);
      break;
    }
    case 5:
      bytes.resize(at + 1);
      break;
    default: {
      const std::size_t from = reader.number<std::uint32_t>() % bytes.size();
      const sim::Bytes part(bytes.begin() + static_cast<std::ptrdiff_t>(from),
                            bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), from + 16)));
      put(bytes, at, part.data(), part.size());
    }
  }
}

}  // namespace

SHOAL_FUZZ_TARGET(snapshot) {
  static Restored restored;
  restored.world.state().restore(restored.base);
  sim::Bytes bytes = restored.base;
  fuzz::Reader reader(input);
  for (int changes = 0; !reader.ended() && changes < 16; ++changes) change(bytes, reader);
  fuzz::allow<sim::SnapshotError, sim::PhysicsFault>([&] {
    restored.world.state().restore(bytes);
    for (int step = 0; step < 3; ++step) restored.world.step();
  });
}
