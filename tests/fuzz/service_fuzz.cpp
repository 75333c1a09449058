// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "bridges/control/sim_service.hpp"
#include "bridges/lockstep/lockstep_service.hpp"
#include "messages/yaml/message_writer.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_resend_t.hpp"
#include "shoal/sim_resent_t.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// A stranger on the bus: requests to the simulator and messages of the lockstep, in any order, good and bad.

namespace {

const sim::LoadedWorld& world_file() {
  static const sim::LoadedWorld loaded = [] {
    sim::LoadOptions options;
    options.encode_message = shoal::encode_own_message;
    return sim::load_world_text(
        "shoal: 1\nphysics: {step_s: 0.01}\nlockstep: {timeout_s: 0.001, join_timeout_s: 0.001}\n"
        "objects: [{name: ground, fixed: true, parts: [{shape: plane}]}, {name: box, position_m: [3, 0, 1], parts: "
        "[{shape: box, mass_kg: 1}]}]\n"
        "zones: [{name: zone, shape: box, size_m: [1, 1, 1]}]\n"
        "vehicles: [{name: a, model: {shoal: 1, bodies: [{name: b, parts: [{shape: box, mass_kg: 1}]}], devices: "
        "[{name: gps, type: gps, rate_hz: 10}, {name: push, type: body_wrench}]}, position_m: [0, 0, 1]}]\n",
        "worlds/fuzz.yaml", options);
  }();
  return loaded;
}

struct Served {
  sim::InProcessBus network;
  sim::MessageGate gate{network};
  sim::World world{world_file().config, gate};
  sim::RunControl control;
  bridges::LockstepService lockstep{world, control, {{network, gate}}};
  bridges::SimService service{gate, network, world, control, lockstep, {"{}", "fuzz"}};
};

constexpr std::array clients{"pilot", "a", "", "helper", "pilot\n"};
constexpr std::array channels{"sim.control", "sim.ack", "sim.resend", "sim.resent", "a.push.cmd"};
constexpr std::array commands{"join", "leave", "alive", "follow", "spawn",  "remove",   "describe", "do",
                              "quit", "pause", "step",  "until",  "rewind", "snapshot", "restore",  "where"};

std::string client_of(fuzz::Reader& reader) {
  return clients[reader.below(clients.size())];
}

template <typename Message>
void send(Served& served, const char* channel, const Message& message) {
  fuzz::allow<shoal::MessageError>(
      [&] { served.network.publish(channel, shoal::encode(message), served.world.now()); });
}

void send_request(Served& served, fuzz::Reader& reader) {
  shoal::sim_control_request_t request{};
  request.id = reader.byte();
  request.client = client_of(reader);
  request.command = commands[reader.below(commands.size())];
  request.value = reader.below(4) == 0 ? reader.number<double>() : 0.01 * static_cast<double>(reader.byte());
  request.text = reader.text();
  send(served, "sim.control", request);
}

void send_ack(Served& served, fuzz::Reader& reader) {
  shoal::sim_ack_t ack{};
  ack.step = reader.below(2) == 0 ? served.world.step_number() : reader.number<std::int64_t>();
  ack.client = client_of(reader);
  ack.session = reader.byte();
  ack.sequence = reader.below(2) == 0 ? reader.byte() : reader.number<std::int64_t>();
  ack.listed = reader.below(2) == 0;
  ack.count = static_cast<std::int32_t>(reader.below(4));
  for (std::int32_t i = 0; i < ack.count; ++i) {
    ack.channel.push_back(channels[reader.below(channels.size())]);
    ack.crc.push_back(reader.number<std::int64_t>());
  }
  send(served, "sim.ack", ack);
}

void send_question(Served& served, fuzz::Reader& reader) {
  shoal::sim_resend_t question{};
  question.client = client_of(reader);
  question.session = reader.byte();
  question.sequence = reader.number<std::int64_t>();
  question.of_client = reader.below(2) == 0;
  question.first = reader.number<std::int32_t>();
  send(served, "sim.resend", question);
}

void send_bundle(Served& served, fuzz::Reader& reader) {
  shoal::sim_resent_t bundle{};
  bundle.client = client_of(reader);
  bundle.session = reader.byte();
  bundle.sequence = reader.byte();
  bundle.of_client = reader.below(2) == 0;
  bundle.first = reader.number<std::int32_t>();
  bundle.count = static_cast<std::int32_t>(reader.below(4));
  for (std::int32_t i = 0; i < bundle.count; ++i) {
    shoal::sim_payload_t payload{};
    payload.channel = channels[reader.below(channels.size())];
    const fuzz::Input data = reader.bytes(reader.byte());
    payload.size = static_cast<std::int32_t>(data.size());
    for (const std::byte byte : data) payload.data.push_back(static_cast<std::uint8_t>(byte));
    bundle.message.push_back(payload);
  }
  send(served, "sim.resent", bundle);
}

/// A step, and what the clients are waited for; the wall clock moves on by itself.
void step(Served& served) {
  served.gate.admit();
  fuzz::allow<sim::PhysicsFault>([&] { served.world.step(); });
  served.service.publish_step();
  int timeout = 3;
  fuzz::allow<bridges::LockstepTimeout>([&] {
    served.lockstep.synchronize([](std::chrono::milliseconds) {},
                                [&] {
                                  served.service.handle_requests();
                                  return --timeout > 0;
                                });
  });
}

}  // namespace

SHOAL_FUZZ_TARGET(service) {
  Served served;
  fuzz::Reader reader(input);
  for (int messages = 0; !reader.ended() && messages < 30; ++messages) {
    switch (reader.below(8)) {
      case 0:
      case 1:
      case 2:
        send_request(served, reader);
        break;
      case 3:
        send_ack(served, reader);
        break;
      case 4:
        send_question(served, reader);
        break;
      case 5:
        send_bundle(served, reader);
        break;
      case 6: {
        const std::string payload = reader.text();
        served.network.publish(channels[reader.below(channels.size())], std::as_bytes(std::span(payload)),
                               served.world.now());
        break;
      }
      default:
        step(served);
    }
    served.service.handle_requests();
  }
  step(served);
}
