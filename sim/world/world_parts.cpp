// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_parts.hpp"

#include <utility>

#include "sim/device/device.hpp"

namespace sim {

namespace {

/// Checks restored events: their devices are looked up by number when they are due.
void check_events(EventQueue& queue, std::size_t devices, const AcousticChannel& acoustics,
                  const StateArchive& archive) {
  StateArchive saver = StateArchive::saver();
  saver(queue);
  const Bytes bytes = saver.take_bytes();
  StateArchive reader = StateArchive::restorer(bytes);
  std::int64_t reached = 0;  // written by the queue before its events
  std::uint64_t next_sequence = 0;
  std::vector<Event> events;
  reader(reached, next_sequence, events);
  for (const Event& event : events)
    if (event.device != Event::of_acoustics && static_cast<std::size_t>(event.device) >= devices)
      archive.fail("an event of a device that does not exist");
  acoustics.check_events(events, archive);
}

}  // namespace

WorldParts::WorldParts(const World& world, const WorldConfig& config_, Bus& bus, PortOpener open_port_,
                       BusFinder find_bus)
    : config(config_),
      open_port(std::move(open_port_)),
      clock{from_seconds(config.physics.step_s)},
      geodesy(config.origin.position),
      warnings(clock),
      physics(config.physics, config.materials, config.contacts, config.categories, seed()),
      medium(config.medium, config.physics.gravity_mps2, seed()),
      buses(bus, std::move(find_bus)),
      surfaces(physics),
      host{world,     config.channels, clock,     config.epoch_us, seed(), physics,
           acoustics, events,          open_port, warnings,        shared, awake} {}

void WorldParts::visit_state(StateArchive& archive) {
  visit_beginning(archive);
  for (const auto& vehicle : entities.vehicles()) {
    visit_vehicle(archive, *vehicle);
    for (MountedDevice* device : vehicle->devices()) {
      if (archive.hashing() && is_unused(device->sensor())) continue;
      archive.section(device->full_name());
      archive(*device);
    }
  }
  visit_rest(archive);
}

void WorldParts::visit_beginning(StateArchive& archive) {
  archive.section("world");
  archive(clock.step_number, ended);
  archive.require(clock.step_number, 0, StateArchive::max_time.count() / clock.step.count(), "a step");
  archive.unhashed(entities, schedule.samples(), warnings, buses.run_hash());
  physics.visit_state(archive);
  archive.section("medium");
  archive(medium, *hydrodynamics);
}

void WorldParts::visit_vehicle(StateArchive& archive, Vehicle& vehicle) {
  archive.section(vehicle.name());
  vehicle.clock().advance_time_to(clock.now());  // the schedule advances it only when its history changes
  archive(vehicle);
  // A forged value would make it advance in any number of small steps.
  if (archive.restoring() && !vehicle.clock().is_stopped_at(clock.now()))
    archive.fail("a clock whose time does not match that of the world");
}

void WorldParts::visit_rest(StateArchive& archive) {
  archive.section("objects");
  for (const auto& [name, object] : entities.objects()) object.visit_state(archive);
  archive.section("events");
  archive(events);
  archive.section("acoustics");
  archive(*acoustics);
  if (archive.restoring()) check_events(events, devices.size(), *acoustics, archive);
  archive.section("script");
  archive(*script);
  if (!archive.hashing()) {  // messages of the world to its own devices in the last step
    archive.section("messages");
    devices.visit_messages(archive);
  }
  archive.end();
}

}  // namespace sim
