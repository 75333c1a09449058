// SPDX-License-Identifier: BSD-3-Clause
#include "python/world/in_process_world.hpp"

#include <chrono>
#include <utility>

#include "messages/yaml/message_writer.hpp"
#include "shoal/message_schema.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/vehicle_loader.hpp"

namespace python {
namespace {

sim::ConfigNode parse(const std::string& text, const std::string& name) {
  sim::Diagnostics diagnostics;
  sim::ConfigNode node = sim::parse_config_text(text, name, diagnostics);
  diagnostics.throw_if_any();
  return node;
}

}  // namespace

std::shared_ptr<const sim::LoadedWorld> load(const WorldSource& source, sim::Warnings* warnings) {
  sim::LoadOptions options;
  options.warnings = warnings;
  options.resolve = false;
  options.sets = source.sets;
  options.seed = source.seed;
  options.encode_message = shoal::encode_own_message;
  options.serial_ports = false;
  return std::make_shared<const sim::LoadedWorld>(source.text ? sim::load_world_text(*source.text, source.file, options)
                                                              : sim::load_world(source.file, options));
}

InProcessWorld::InProcessWorld(std::shared_ptr<const sim::LoadedWorld> loaded)
    : loaded_(std::move(loaded)), world_(loaded_->config, bus_) {
  world_.use_threads(1);  // programs run many worlds; use_threads() of the caller changes it
}

std::int64_t InProcessWorld::step(std::int64_t count, const Stop& stop) {
  using Clock = std::chrono::steady_clock;
  constexpr auto interval = std::chrono::milliseconds(20);
  if (!fault_.empty()) throw sim::WorldError(fault_ + "; the world cannot continue, only be restored");
  auto next_check = stop ? Clock::now() + interval : Clock::time_point::max();
  std::int64_t taken = 0;
  for (; taken < count && !world_.ended(); ++taken) {
    try {
      world_.step();
    } catch (const sim::PhysicsFault& fault) {
      fault_ = fault.what();
      throw;
    }
    if (!stop || (taken & 15) != 15 || Clock::now() < next_check) continue;
    if (stop()) return taken + 1;
    next_check = Clock::now() + interval;
  }
  return taken;
}

void InProcessWorld::publish(const std::string& channel, std::span<const std::byte> payload) {
  if (channel.empty() || channel.size() > sim::Bus::max_channel_length)
    throw sim::WorldError("a channel has 1 to " + std::to_string(sim::Bus::max_channel_length) + " characters, got '" +
                          channel + "'");
  const shoal::MessageSchema* const schema =
      shoal::embedded_types().find(static_cast<std::uint64_t>(shoal::fingerprint(payload)));
  if (schema == nullptr) throw shoal::MessageError("no message type has the fingerprint of this payload");
  if (const auto error = shoal::validate(*schema, payload, shoal::Finite::any)) throw shoal::MessageError(*error);
  world_.bus_of_channel(channel).publish(channel, payload, world_.now());
}

void InProcessWorld::act(const std::string& action) {
  world_.editor().run_action(parse(action, "do"));
}

std::vector<std::string> InProcessWorld::spawn(const std::string& entry) {
  // Read the entry
  const sim::ConfigNode node = parse(entry, "spawn");
  const sim::WorldConfig& config = world_.config();
  sim::Diagnostics diagnostics(config.files);
  sim::VehicleEntry read;
  sim::ParamReader in(node, "", diagnostics);
  for (const sim::BusConfig& bus : config.buses) in.declare("bus", bus.name);
  read.read(in);
  in.finish();
  diagnostics.throw_if_any();
  read.beside.file = sim::intern_file_name(config.file);  // where vehicle files are searched
  const std::vector<sim::VehicleInstance> instances = sim::VehicleLoader(config, diagnostics).load(read);
  diagnostics.throw_if_any();
  if (instances.empty()) sim::throw_config_error(read.place, "vehicle '" + read.name + "'", "has no model");

  // Add all its vehicles, or none
  std::vector<std::string> names;
  try {
    for (const sim::VehicleInstance& instance : instances) {
      world_.editor().add_vehicle(instance);
      names.push_back(instance.name);
    }
  } catch (...) {
    for (const std::string& name : names) world_.editor().remove_vehicle(name);
    throw;
  }
  return names;
}

void InProcessWorld::remove(const std::string& name) {
  if (world_.find_vehicle(name) != nullptr) return world_.editor().remove_vehicle(name);
  if (world_.find_object(name) != nullptr) return world_.editor().remove_object(name);
  throw sim::WorldError("there is no vehicle or object '" + name + "'");
}

void InProcessWorld::restore(std::span<const std::byte> snapshot) {
  world_.state().restore(snapshot);
  bus_.clear();
  fault_.clear();
  ++restores_;
}

std::unique_ptr<InProcessWorld> InProcessWorld::branch() const {
  auto made = std::make_unique<InProcessWorld>(loaded_);
  made->restore(snapshot());
  return made;
}

}  // namespace python
