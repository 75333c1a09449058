#include "sim/world/world.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "sim/config/message_text.hpp"

namespace sim {

World::World(const WorldConfig& config, Bus& bus, PortOpener open_port)
    : config_(config),
      open_port_(std::move(open_port)),
      step_us_(from_seconds(config.physics.step_s).count()),
      step_s_(config.physics.step_s),
      geodesy_(config.origin.position),
      host_{bus,
            events_,
            config.epoch_us,
            Time{step_us_},
            static_cast<std::uint64_t>(config.run.seed),
            [this](const BadMessage& bad) { complain(bad); }},
      physics_(std::make_unique<PhysicsWorld>(config.physics, config.materials, config.contacts, config.categories,
                                              static_cast<std::uint64_t>(config.run.seed))) {
  add_objects();
  for (const VehicleInstance& instance : config.vehicles) add_vehicle(instance);
  for (const auto& device : devices_) {
    if (device->has_mailbox()) listening_.push_back(device.get());
    if (device->acts()) acting_.push_back(device.get());
    if (device->senses()) sensing_.push_back(device.get());
  }
}

World::~World() = default;

void World::add_objects() {
  for (const ObjectConfig& object : config_.objects) {
    const Pose X_WE = make_pose(object.position_m, object.rpy_rad);
    const std::vector<Pose> poses = object.count == 1
                                        ? std::vector<Pose>{X_WE}
                                        : place_instances(object.placement, object.count, X_WE, seed(), object.name);
    for (int i = 0; i < object.count; ++i) {
      const std::string name = object.count == 1 ? object.name : object.name + std::to_string(i + 1);
      const int group = physics_->add_group(name);
      BodyConfig body;
      body.parts = object.parts;
      body.name = "body";
      physics_->add_body(group, body, poses[static_cast<std::size_t>(i)], object.fixed ? Motion::fixed : Motion::free);
      physics_->close_group(group);
    }
  }
}

void World::add_vehicle(const VehicleInstance& instance) {
  const VehicleConfig& config = *instance.config;
  const int group = physics_->add_group(instance.name, config.self_collision);
  const BodyConfig& base = config.bodies.front();
  auto vehicle = std::make_unique<Vehicle>(instance.name, static_cast<int>(vehicles_.size()), group,
                                           make_pose(base.position_m, base.rpy_rad).inverse());
  for (const BodyConfig& body : config.bodies)
    vehicle->add_body(body.name, physics_->add_body(group, body, instance.X_WV));
  for (const JointConfig& joint : config.joints) {
    Body* second = joint.bodies[1] == "world" ? nullptr : &vehicle->body(joint.bodies[1]);
    vehicle->add_joint(joint.name,
                       physics_->add_joint(group, joint, vehicle->body(joint.bodies[0]), second, instance.X_WV));
  }
  physics_->close_group(group);
  for (const DeviceConfig& device : config.devices) {
    Body& body = vehicle->body(device.body.empty() ? base.name : device.body);
    const DeviceContext context{*this, *vehicle, device, body};
    devices_.push_back(std::make_unique<MountedDevice>(context, config_, host_, next_device_number()));
  }
  vehicle_numbers_.emplace(instance.name, vehicle->number());
  vehicles_.push_back(std::move(vehicle));
}

void World::step() {
  for (MountedDevice* device : listening_) device->take_mail(now(), step_number_);
  for (MountedDevice* device : acting_) device->act(now(), step_s_);
  physics_->step(step_number_);
  ++step_number_;
  for (Event event; events_.take_due(now(), event);) devices_[static_cast<std::size_t>(event.device)]->handle(event);
  for (MountedDevice* device : sensing_) {
    if (!device->sample_is_due(step_number_)) continue;
    device->sample(*this, now(), step_number_);
    ++counts_.samples;
  }
}

const Vehicle* World::find_vehicle(const std::string& name) const {
  const auto found = vehicle_numbers_.find(name);
  return found == vehicle_numbers_.end() ? nullptr : vehicles_[static_cast<std::size_t>(found->second)].get();
}

void World::schedule_arrival(int device, Time due, Bytes payload) {
  events_.schedule({due, 0, device, MountedDevice::arrival_event, now(), std::move(payload)});
}

void World::complain(const BadMessage& bad) {
  ++counts_.bad_messages;
  // One line for each kind of mistake: a flood of bad messages must not become a flood of lines.
  constexpr std::size_t most_lines = 100;
  const std::string line = bad.channel + ": " + shortened(printable(bad.text), 300);
  if (complaints_.size() >= most_lines || std::find(complaints_.begin(), complaints_.end(), line) != complaints_.end())
    return;
  complaints_.push_back(line);
  spdlog::warn("{} (ignored, at {:.3f} s)", line, to_seconds(now()));
}

std::uint64_t World::state_hash() const {
  StateHash hash;
  hash.add(step_number_);
  physics_->hash_state(hash);
  for (const auto& device : devices_) device->hash_state(hash);
  events_.hash_state(hash);
  return hash.value();
}

}  // namespace sim
