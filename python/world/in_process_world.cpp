// SPDX-License-Identifier: BSD-3-Clause
#include "python/world/in_process_world.hpp"

#include <Eigen/Geometry>
#include <chrono>
#include <utility>

#include "messages/yaml/message_writer.hpp"
#include "shoal/message_schema.hpp"
#include "sim/config/message_text.hpp"
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

void require_name(const std::string& channel) {
  if (channel.empty() || channel.size() > sim::Bus::max_channel_length)
    throw sim::WorldError("a channel has 1 to " + std::to_string(sim::Bus::max_channel_length) + " characters, got '" +
                          sim::shortened(sim::printable(channel)) + "'");
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
    // The clock is read at every 16th step only: steps of a small world take microseconds.
    if (!stop || (taken & 15) != 15 || Clock::now() < next_check) continue;
    if (stop()) return taken + 1;
    next_check = Clock::now() + interval;
  }
  return taken;
}

void InProcessWorld::publish(const std::string& channel, std::span<const std::byte> payload) {
  // The payload
  require_name(channel);
  const shoal::MessageSchema* const schema =
      shoal::embedded_types().find(static_cast<std::uint64_t>(shoal::fingerprint(payload)));
  if (schema == nullptr) throw shoal::MessageError("no message type has the fingerprint of this payload");
  if (const auto error = shoal::validate(*schema, payload, shoal::Finite::any)) throw shoal::MessageError(*error);
  // Message types that the device accepts
  const auto reader = channels().received.find(channel);
  if (reader != channels().received.end() && !reader->second.empty()) {
    if ((", " + reader->second + ",").find(", " + schema->name + ",") == std::string::npos)
      throw shoal::MessageError("the device on '" + channel + "' takes " + reader->second + ", got " + schema->name);
    const auto finite = may_have_nan(schema->name) ? shoal::Finite::any : shoal::Finite::required;
    if (const auto error = shoal::validate(*schema, payload, finite))
      throw shoal::MessageError("'" + channel + "': " + *error);
  }
  // Whether a reader subscribes to it
  if (reader == channels().received.end() && !subscribed_.contains(channel) && !known_.contains(channel)) {
    const std::string text = "no device, metric or event reads '" + channel + "'";
    if (const std::string hint = channels().meant(channel, true); !hint.empty()) throw sim::WorldError(text + hint);
    world_.warnings().warn("publish", text + ", and the program has not subscribed to it");
  }
  known_.insert(channel);
  send(channel, payload);
}

const sim::Bytes* InProcessWorld::last(const std::string& channel) {
  const sim::Bytes* const payload = bus_.find(channel);
  if (payload != nullptr) return payload;
  require_name(channel);
  require_readable(channel);
  return nullptr;
}

std::shared_ptr<sim::Mailbox> InProcessWorld::subscribe(const std::string& channel, std::size_t capacity) {
  require_name(channel);
  if (capacity < 1) throw sim::WorldError("subscribe: capacity must be >= 1, got 0");
  require_readable(channel);
  subscribed_.insert(channel);
  std::shared_ptr<sim::Mailbox> mailbox = bus_.open_mailbox(channel, capacity);
  std::erase_if(mailboxes_, [](const auto& each) { return each.expired(); });
  mailboxes_.push_back(mailbox);
  return mailbox;
}

const WorldChannels& InProcessWorld::channels() {
  if (!channels_ || generation_ != world_.generation()) {
    channels_.emplace(world_);
    generation_ = world_.generation();
  }
  return *channels_;
}

void InProcessWorld::require_readable(const std::string& channel) {
  const WorldChannels& all = channels();
  // A channel that anything publishes, or may publish, can be read even before its first message.
  if (all.published.contains(channel) || all.received.contains(channel) || known_.contains(channel) ||
      subscribed_.contains(channel) || bus_.find(channel) != nullptr)
    return;
  if (const auto device = all.silent.find(channel); device != all.silent.end())
    throw sim::WorldError("device '" + device->second + "' does not publish on '" + channel +
                          "': it needs 'truth: true'");
  const std::string text = "nothing in the world publishes on '" + channel + "'";
  if (channel.starts_with("sim.")) throw sim::WorldError(text + ": the channels sim.* are those of a run");
  if (const std::string hint = all.meant(channel, false); !hint.empty()) throw sim::WorldError(text + hint);
  world_.warnings().warn("last or subscribe", text + ", nor has the program yet");
  known_.insert(channel);
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
  std::vector<std::string> names;
  for (const auto& vehicle : world_.vehicles()) names.push_back(vehicle->name());
  for (const auto& [object, entry] : world_.objects()) names.push_back(object);
  throw sim::WorldError("there is no vehicle or object '" + sim::shortened(sim::printable(name)) + "'" +
                        sim::did_you_mean(name, names));
}

void InProcessWorld::restore(std::span<const std::byte> snapshot) {
  world_.state().restore(snapshot);
  for (const auto& [channel, payload] : bus_.all()) known_.insert(channel);
  bus_.clear();
  channels_.reset();
  fault_.clear();
  // Messages that the program has not read belong to a discarded future.
  for (const auto& each : mailboxes_)
    if (const auto mailbox = each.lock()) mailbox->set_unread({});
}

std::unique_ptr<InProcessWorld> InProcessWorld::branch() const {
  auto made = std::make_unique<InProcessWorld>(loaded_);
  made->restore(snapshot());
  made->known_ = known_;
  for (const auto& [channel, payload] : bus_.all()) made->known_.insert(channel);
  return made;
}

Motion motion_of(const sim::Vehicle& vehicle) {
  const sim::Pose X_WV = vehicle.X_WV();
  const sim::Body& base = vehicle.base();
  const sim::Vector3d p_BV = base.X_WB().inverse() * X_WV.translation();
  const Eigen::Quaterniond q(X_WV.linear());
  // q and -q are the same attitude; one of them is chosen, so that observations do not jump.
  const double sign = q.w() < 0 ? -1 : 1;
  Motion motion{};
  Eigen::Map<sim::Vector3d>(motion.position_m) = X_WV.translation();
  Eigen::Map<Eigen::Vector4d>(motion.orientation) = sign * Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  Eigen::Map<sim::Vector3d>(motion.velocity_mps) = base.velocity_at_W(p_BV);
  Eigen::Map<sim::Vector3d>(motion.rates_radps) = X_WV.linear().transpose() * base.w_WB_W();
  return motion;
}

}  // namespace python
