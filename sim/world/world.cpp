// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <set>

#include "sim/acoustics/channel.hpp"
#include "sim/config/message_text.hpp"
#include "sim/director/script.hpp"
#include "sim/world/bottom_check.hpp"
#include "sim/world/notice.hpp"
#include "sim/world/run_hash.hpp"
#include "sim/world/start_check.hpp"
#include "sim/world/world_journal.hpp"
#include "sim/world/world_warnings.hpp"

namespace sim {

World::World(const WorldConfig& config, Bus& bus, PortOpener open_port, BusFinder find_bus)
    : config_(config),
      bus_(bus),
      find_bus_(std::move(find_bus)),
      open_port_(std::move(open_port)),
      step_us_(from_seconds(config.physics.step_s).count()),
      step_s_(config.physics.step_s),
      geodesy_(config.origin.position),
      host_{events_, config.epoch_us, Time{step_us_}, static_cast<std::uint64_t>(config.run.seed),
            [this](const BadMessage& bad) { complain(bad.channel, bad.text); }},
      physics_(std::make_unique<PhysicsWorld>(config.physics, config.materials, config.contacts, config.categories,
                                              static_cast<std::uint64_t>(config.run.seed))),
      medium_(config.medium, config.physics.gravity_mps2, static_cast<std::uint64_t>(config.run.seed)),
      journal_(std::make_unique<WorldJournal>(*this)),
      run_hash_(std::make_unique<RunHash>()) {
  StateArchive start = StateArchive::saver();
  start(medium_);
  medium_at_start_ = start.take_bytes();
  build();
  warn_of_starts(*this);
  for (const std::vector<std::string>& found :
       {physics_->ground_warnings(), hydrodynamics_->take_warnings(), bottom_warnings(*this)})
    for (const std::string& warning : found) warnings_of(*this).warn({}, "", warning);
}

/// All that is in the world file; physics and medium are as they begin.
void World::build() {
  hydrodynamics_.emplace(medium_, config_.physics.gravity_mps2, config_.physics.step_s);
  hydrodynamics_->set_complain([this](const std::string& who, const std::string& text) { notice(*this, who, text); });
  acoustics_ =
      std::make_unique<AcousticChannel>(config_.acoustics, AcousticSurroundings{medium_, *physics_, events_, seed()});
  known_materials_ = {"default"};
  for (const MaterialConfig& material : config_.materials) known_materials_.insert(material.name);
  known_contacts_ = config_.contacts;
  add_objects();
  std::vector<std::string> errors;  // of all vehicles, not of the first alone; the same of many of a kind once
  std::set<std::string> told;
  for (const VehicleInstance& instance : config_.vehicles) {
    try {
      build_vehicle(instance);
    } catch (const ConfigError& error) {
      for (const std::string& line : error.lines()) {
        std::string of_anybody = line;
        if (const auto name = of_anybody.find("'" + instance.name + "'"); name != std::string::npos)
          of_anybody.erase(name, instance.name.size() + 2);
        if (told.insert(of_anybody).second) errors.push_back(line);
      }
    }
  }
  if (!errors.empty()) throw ConfigError(errors);
  sort_devices();
  script_ = std::make_unique<Script>(*this);
}

World::~World() = default;

void World::use_threads(int threads) {
  threads_ = threads == 1 ? nullptr : std::make_unique<ThreadPool>(threads);
}

void World::add_objects() {
  for (const ObjectConfig& object : config_.objects) {
    if (!object.present) continue;
    const Pose X_WE = make_pose(object.position_m, object.rpy_rad);
    const std::vector<Pose> poses = object.count == 1
                                        ? std::vector<Pose>{X_WE}
                                        : place_instances(object.placement, object.count, X_WE, seed(), object.name);
    for (int i = 0; i < object.count; ++i)
      build_object(object, object.count == 1 ? object.name : object.name + std::to_string(i + 1),
                   poses[static_cast<std::size_t>(i)]);
  }
}

const WorldObject& World::build_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE) {
  WorldObject object{next_object_number_++, name, physics_->add_group(name), nullptr, config};
  BodyConfig body;
  body.parts = config.parts;
  body.name = "body";
  const Motion motion = config.kinematic ? Motion::kinematic : config.fixed ? Motion::fixed : Motion::free;
  try {
    object.body = &physics_->add_body(object.group, body, X_WE, motion);
    if (motion == Motion::free) hydrodynamics_->add_body(*object.body, body);
  } catch (...) {
    hydrodynamics_->remove_group(object.group);
    physics_->remove_group(object.group);
    throw;
  }
  physics_->close_group(object.group);
  ++generation_;
  return objects_.insert_or_assign(name, std::move(object)).first->second;
}

Vehicle& World::build_vehicle(const VehicleInstance& instance) {
  const int group = physics_->add_group(instance.name, instance.config->self_collision);
  vehicles_.push_back(
      std::make_unique<Vehicle>(instance.name, next_vehicle_number_++, group, instance.config, bus_of(instance.bus)));
  Vehicle& vehicle = *vehicles_.back();
  vehicles_by_name_.emplace(instance.name, &vehicle);
  vehicle.start_clock(seed(), now());
  try {
    build_parts_of(vehicle, instance);
  } catch (...) {  // a mesh that is no solid, a port that is taken: nothing of it stays
    take_apart(vehicle);
    throw;
  }
  ++generation_;
  return vehicle;
}

void World::build_parts_of(Vehicle& vehicle, const VehicleInstance& instance) {
  const VehicleConfig& config = *instance.config;
  for (const BodyConfig& body : config.bodies) {
    Body& built =
        physics_->add_body(vehicle.group(), body, instance.X_WV, body.kinematic ? Motion::kinematic : Motion::free);
    vehicle.add_body(body.name, built);
    if (!body.kinematic) hydrodynamics_->add_body(built, body);
  }
  // What could be wrong with joints and devices of a kind showed in the first ones.
  constexpr int max_of_kind_as_a_whole = 100;
  if (config_.bodies_only_of_many && config_.events.empty() && ++built_of_kind_[&config] > max_of_kind_as_a_whole)
    return physics_->close_group(vehicle.group());
  for (const JointConfig& joint : config.joints) {
    Body* second = joint.bodies[1] == "world" ? nullptr : &vehicle.body(joint.bodies[1]);
    vehicle.add_joint(
        joint.name, physics_->add_joint(vehicle.group(), joint, vehicle.body(joint.bodies[0]), second, instance.X_WV));
  }
  physics_->close_group(vehicle.group());
  std::vector<std::string> errors;
  for (const DeviceConfig& device : config.devices) {
    try {
      add_device(vehicle, device);
    } catch (const ConfigError& error) {
      errors.insert(errors.end(), error.lines().begin(), error.lines().end());
    }
  }
  if (!errors.empty()) throw ConfigError(errors);
}

void World::add_device(Vehicle& vehicle, const DeviceConfig& config) {
  if (free_numbers_.empty()) {
    free_numbers_.push_back(static_cast<int>(devices_.size()));
    devices_.emplace_back();
  }
  const int number = free_numbers_.back();
  auto device = std::make_unique<MountedDevice>(*this, vehicle, config, host_, number);
  if (device->mailbox()) device->mailbox()->raise_on_arrival(mail_flags_.of(number));
  free_numbers_.pop_back();
  vehicle.add_device(*device);
  for (const ChannelKind kind : all_channel_kinds)
    channels_.emplace(device_channel(config_.channels, vehicle.name(), config, kind), &vehicle.bus());
  devices_[static_cast<std::size_t>(number)] = std::move(device);
}

void World::sort_devices() {
  listening_.clear();
  acting_.clear();
  sensing_.clear();
  clocked_.clear();
  for (const auto& vehicle : vehicles_)
    if (!vehicle->clock().perfect()) clocked_.push_back(vehicle.get());
  for (const auto& device : devices_) {
    if (!device) continue;
    if (device->mailbox()) listening_.push_back({mail_flags_.of(device->number()).get(), device.get()});
    if (device->acting()->actuator != nullptr) acting_.push_back(device->acting());
    if (device->senses())
      sensing_.push_back({device->next_sample_step(), device.get(), device->casts_rays(), device->sweeps()});
  }
}

void World::step() {
  if (!script_) throw SnapshotError("the world was lost when a snapshot was restored");
  in_step_ = true;
  for (const Listening& listening : listening_)
    if (listening.mail->load(std::memory_order_relaxed) && listening.mail->exchange(false, std::memory_order_acquire))
      listening.device->take_mail(now(), step_number_);
  hydrodynamics_->begin_step();
  for (Acting* acting : acting_) acting->act(now(), step_s_);
  hydrodynamics_->step(physics_->gravity_mps2());
  script_->step();
  physics_->step(step_number_);
  ++step_number_;
  medium_.advance_to(now());
  advance_clocks();
  run_due_events();
  sense();
  add_to_run_hash();
  in_step_ = false;
}

/// Between physics and what is due: what is stamped in this step is stamped by the clocks as they stand at its end.
void World::advance_clocks() {
  for (Vehicle* vehicle : clocked_) {
    std::optional<double> temperature_C;
    if (vehicle->clock().wants_temperature(now())) {
      const Vector3d p_W = vehicle->X_WV().translation();
      if (medium_.in_water(p_W)) temperature_C = medium_.temperature_C(p_W);
    }
    vehicle->clock().advance_to(now(), temperature_C);
  }
}

/// Stages 6 and 7.  Sensors that cast rays take nearly all the time and touch nothing but themselves: they go first,
/// in parallel.  What they found is published among the others' in device order, as if one after the other had sampled.
void World::sense() {
  due_.clear();
  casting_.clear();
  for (Sensing& sensing : sensing_) {
    const bool due = step_number_ >= sensing.due_step;
    if (due) due_.push_back(&sensing);
    if (sensing.casts_rays && (due || sensing.sweeps)) casting_.push_back({sensing.device, due});
  }
  if (!casting_.empty()) cast_rays();
  for (Sensing* sensing : due_) {
    if (!sensing->casts_rays) sensing->device->sample(*this, now(), step_number_);
    sensing->due_step = sensing->device->next_sample_step();
    sensing->device->publish_reports();
  }
  counts_.samples += static_cast<std::int64_t>(due_.size());
}

void World::cast_rays() {
  const auto sample = [this](const Casting& casting) {
    if (casting.device->sweeps()) casting.device->sweep(*this, now());
    if (casting.due) casting.device->sample(*this, now(), step_number_);
  };
  // Waking threads costs as much as some hundred rays.
  constexpr std::int64_t worth_sharing = 1500;
  std::int64_t rays = 0;
  for (const Casting& casting : casting_) rays += casting.device->rays();
  // Where nothing is cast, as between the images of cameras, nothing has to be looked up either.
  if (rays > 0) scene().prepare();
  if (threads_ && rays >= worth_sharing && scene().concurrent())
    threads_->for_each(casting_.size(), [&](std::size_t i) { sample(casting_[i]); });
  else
    for (const Casting& casting : casting_) sample(casting);
}

void World::run_due_events() {
  for (Event event; events_.take_due(now(), event);) {
    if (event.device == Event::of_acoustics)
      acoustics_->handle(event, now());
    else if (const auto& device = devices_[static_cast<std::size_t>(event.device)])
      device->handle(event);
  }
}

const Vehicle* World::find_vehicle(const std::string& name) const {
  const auto found = vehicles_by_name_.find(name);
  return found == vehicles_by_name_.end() ? nullptr : found->second;
}

MountedDevice* World::find_device(const std::string& full_name) const {
  const std::size_t slash = full_name.find('/');
  if (slash == std::string::npos) return nullptr;
  const Vehicle* vehicle = find_vehicle(full_name.substr(0, slash));
  return vehicle ? vehicle->find_device(full_name.substr(slash + 1)) : nullptr;
}

const WorldObject* World::find_object(const std::string& name) const {
  const auto found = objects_.find(name);
  return found == objects_.end() ? nullptr : &found->second;
}

Bus& World::bus_of(const std::string& name) {
  return name.empty() || !find_bus_ ? bus() : run_hash_->counted(find_bus_(name));
}

Bus& World::bus() {
  return run_hash_->counted(bus_);
}

void World::schedule_arrival(int device, Time due, Bytes payload) {
  events_.schedule({due, 0, device, MountedDevice::arrival_event, now(), std::move(payload)});
}

void World::publish(const std::string& channel, std::span<const std::byte> payload) {
  bus_of_channel(channel).publish(channel, payload, now());
}

Bus& World::bus_of_channel(const std::string& channel) {
  const auto known = channels_.find(channel);
  return known == channels_.end() ? bus() : *known->second;
}

void World::end(const EndOfRun& end) {
  if (!ended_) ended_ = end;
}

void World::complain(const std::string& who, const std::string& text) {
  ++counts_.bad_messages;
  // One line for each kind of mistake: a flood of bad messages must not become a flood of lines.
  constexpr std::size_t most_lines = 100;
  const std::string line = who + ": " + shortened(printable(text), 300);
  if (complaints_.size() >= most_lines || std::find(complaints_.begin(), complaints_.end(), line) != complaints_.end())
    return;
  complaints_.push_back(line);
  spdlog::warn("{} (ignored, at {:.3f} s)", line, to_seconds(now()));
}

const Zones& World::zones() const {
  return script_->zones();
}

std::optional<std::int64_t> World::event_firings(const std::string& name) const {
  return script_->firings(name);
}

const std::map<std::string, ZoneRecord>& World::zone_records() const {
  return script_->zone_records();
}

void World::run_action(const ConfigNode& action) {
  Diagnostics diagnostics(config().files);
  script_->run_now(action, diagnostics);
  diagnostics.throw_if_any();
}

}  // namespace sim
