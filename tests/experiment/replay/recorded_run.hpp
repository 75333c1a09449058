// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bridges/control/sim_service.hpp"
#include "bridges/lockstep/lockstep_service.hpp"
#include "bridges/log/event_log.hpp"
#include "bridges/log/recording_bus.hpp"
#include "bridges/log/run_journal.hpp"
#include "experiment/run/version.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "experiment/snapshot/snapshot_pieces.hpp"
#include "shoal/message_codec.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/comms/port_fixture.hpp"

namespace test {

/// A run in this process that is recorded as `shoal run --record` does, with clients that the test plays.
class RecordedRun {
 public:
  /// `from`: it begins with this snapshot, of a RecordedRun of the same world.
  RecordedRun(const std::string& yaml, const std::string& log, const experiment::Snapshot* from = nullptr)
      : loaded(sim::load_world_text(yaml, "worlds/test.yaml", LoadedTestWorld::with_messages({}))),
        recorder(network, log, loaded.config.epoch_us),
        gate(recorder),
        world(loaded.config, gate, ports.wrap([this](sim::PortKind, const std::string& path) {
          ends[path] = std::make_shared<PortEnd>();
          return std::make_unique<FakePort>(ends[path]);
        })),
        journal(gate, world, ports),
        service(gate, network, world, control, lockstep,
                {sim::to_yaml(loaded.resolved), experiment::version_text(), experiment::build_text(),
                 experiment::files_text(loaded.resolved)},
                {.journal = &journal}) {
    if (from != nullptr) {
      world.state().restore(from->state);
      auto owners = sim::StateArchive::restorer(from->owners);
      owners.section("owners");
      service.visit_state(owners);
      owners.end();
      journal.start_branch(0, 1);
    }
    service.publish_info();
    if (from != nullptr)
      for (const auto& piece : experiment::in_pieces(*from, 0, 1))
        gate.publish("sim.snapshot", shoal::encode(piece), world.now());
  }

  experiment::Snapshot snapshot() {
    experiment::Snapshot s;
    s.version = experiment::short_version();
    s.resolved_world = sim::to_yaml(loaded.resolved);
    s.seed = loaded.config.run.seed;
    s.epoch_us = world.epoch_us();
    s.step_us = world.step_time().count();
    s.step = world.step_number();
    s.state_hash = world.state().hash();
    s.state = world.state().snapshot();
    auto owners = sim::StateArchive::saver();
    owners.section("owners");
    service.visit_state(owners);
    owners.end();
    s.owners = owners.take_bytes();
    return s;
  }

  /// `clients` act before each step, `after` after the last; then requests are executed.
  void run(std::int64_t steps, const std::function<void(std::int64_t step)>& clients = {},
           const std::function<void()>& after = {}) {
    service.handle_requests();
    journal.start();
    service.publish_step();
    journal.after_step();
    for (std::int64_t i = 0; i < steps; ++i) {
      if (clients) clients(world.step_number());
      service.handle_requests();
      recorder.set_time(world.now());
      const auto& input_record = gate.admit();
      recorder.admitted(input_record);
      journal.admitted("", input_record);
      world.step();
      service.publish_step();
      journal.after_step();
    }
    if (after) after();
    service.handle_requests();
    journal.finish();
    recorder.close();
  }

  template <typename Message>
  void send(const std::string& channel, const Message& message) {
    network.publish(channel, shoal::encode(message), world.now());
  }
  void request(const std::string& command, const std::string& text) {
    shoal::sim_control_request_t request{};
    request.client = "pilot";
    request.command = command;
    request.text = text;
    send("sim.control", request);
  }

  std::map<std::string, std::shared_ptr<PortEnd>> ends;
  sim::LoadedWorld loaded;
  sim::InProcessBus network;
  bridges::RecordingBus recorder;
  sim::MessageGate gate;
  bridges::JournalPorts ports;
  sim::RunControl control;
  sim::World world;
  bridges::RunJournal journal;
  bridges::LockstepService lockstep{world, control};
  bridges::SimService service;
};

/// Copies a log; `keep` may change an event, or say that it goes.
inline void change_log(const std::string& from, const std::string& to,
                       const std::function<bool(bridges::LogEvent&)>& keep) {
  bridges::EventLogReader in(from);
  std::string bytes;
  const auto add = [&bytes](std::uint64_t value, int size) {
    for (int i = size - 1; i >= 0; --i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
  };
  while (auto event = in.next()) {
    if (!keep(*event)) continue;
    add(0xEDA1DA01, 4);
    add(static_cast<std::uint64_t>(event->number), 8);
    add(static_cast<std::uint64_t>(event->utime), 8);
    add(event->channel.size(), 4);
    add(event->payload.size(), 4);
    bytes += event->channel;
    bytes.append(reinterpret_cast<const char*>(event->payload.data()), event->payload.size());
  }
  std::FILE* out = std::fopen(to.c_str(), "wb");
  std::fwrite(bytes.data(), 1, bytes.size(), out);
  std::fclose(out);
}

/// Copies a log without the events that `leave_out` names.
inline void copy_log(const std::string& from, const std::string& to,
                     const std::function<bool(const bridges::LogEvent&)>& leave_out) {
  change_log(from, to, [&](const bridges::LogEvent& event) { return !leave_out(event); });
}

}  // namespace test
