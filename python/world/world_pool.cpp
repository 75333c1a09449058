// SPDX-License-Identifier: BSD-3-Clause
#include "python/world/world_pool.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "python/world/error.hpp"
#include "python/world/in_process_world.hpp"
#include "sim/config/message_text.hpp"
#include "sim/ode/physics_fault.hpp"

namespace python {
namespace {

constexpr std::uint8_t goes_on = 0, has_ended = 1, has_failed = 2;

const shoal::MessageSchema& schema_of(const std::string& name) {
  const shoal::MessageSchema* found = shoal::embedded_types().find(name);
  if (found == nullptr) found = shoal::embedded_types().find("shoal." + name);
  if (found == nullptr) throw Error("there is no message type '" + name + "'");
  return *found;
}

}  // namespace

/// A world and what is prepared for it.
struct WorldPool::Member {
  std::unique_ptr<InProcessWorld> world;
  std::vector<MessageForm> forms;
  std::uint8_t status = goes_on;
};

WorldPool::WorldPool(WorldSource source, std::size_t count, std::int64_t first_seed, Layout layout, int threads)
    : source_(std::move(source)), layout_(std::move(layout)), threads_(threads) {
  if (count < 1 || count > 100'000) throw Error("a pool has 1 to 100000 worlds, got " + std::to_string(count));
  if (layout_.steps < 1) throw Error("a step of a pool must be >= 1 steps of a world");
  for (std::size_t i = 0; i < count; ++i) worlds_.push_back(std::make_unique<Member>());
  build(*worlds_.front(), first_seed);
  step_s_ = sim::to_seconds(worlds_.front()->world->world().step_time());
  for (const MessageForm& form : worlds_.front()->forms) action_values_ += form.count();
  measure_observations();
}

WorldPool::~WorldPool() = default;

InProcessWorld& WorldPool::world(std::size_t index) {
  if (index >= worlds_.size()) throw Error("there is no world " + std::to_string(index));
  if (!worlds_[index]->world) throw Error("the worlds are not built: reset() comes first");
  return *worlds_[index]->world;
}

void WorldPool::build(Member& member, std::int64_t seed) {
  WorldSource source = source_;
  source.seed = seed;
  member.world.reset();  // never two worlds at once in memory
  member.forms.clear();
  std::shared_ptr<const sim::LoadedWorld> loaded;
  {
    const std::lock_guard<std::mutex> lock(loading_);
    loaded = load(source, &warnings_);
  }
  member.world = std::make_unique<InProcessWorld>(std::move(loaded));
  for (const Action& action : layout_.actions) member.forms.emplace_back(schema_of(action.type), action.members);
  member.status = goes_on;
}

void WorldPool::check_layout(InProcessWorld& world) const {
  const WorldChannels& channels = world.channels();
  for (const Action& action : layout_.actions) {
    const std::string type = schema_of(action.type).name;
    const auto reader = channels.received.find(action.channel);
    if (reader == channels.received.end())
      throw Error("action '" + action.channel + "': no device, metric or event reads this channel" +
                  channels.meant(action.channel, true));
    if (!reader->second.empty() && (", " + reader->second + ",").find(", " + type + ",") == std::string::npos)
      throw Error("action '" + action.channel + "': the device takes " + reader->second + ", got " + type);
  }
  for (const Observation& observation : layout_.observations) {
    const std::string &channel = observation.channel, &vehicle = observation.vehicle;
    if (channel.empty() && world.world().find_vehicle(vehicle) == nullptr) {
      std::vector<std::string> names;
      for (const auto& each : world.world().vehicles()) names.push_back(each->name());
      throw Error("observation '@" + vehicle + "': there is no vehicle '" + vehicle + "'" +
                  sim::did_you_mean(vehicle, names));
    }
    if (!channel.empty() && !channels.published.contains(channel))
      throw Error("observation '" + channel + "': nothing in the world publishes on this channel" +
                  channels.meant(channel, false));
  }
}

bool WorldPool::wait_for_observations(InProcessWorld& world, const InProcessWorld::Stop& stop) const {
  constexpr double max_s = 10;
  constexpr std::int64_t steps_between_stops = 16;
  // An observation must exist after a reset, and a sensor may have its first sample later than the first step.
  const auto is_missing = [&](const Observation& observation) {
    return !observation.channel.empty() && world.bus().find(observation.channel) == nullptr;
  };
  const std::int64_t start = world.world().step_number();
  while (std::any_of(layout_.observations.begin(), layout_.observations.end(), is_missing)) {
    if (world.step(1) == 0 || sim::to_seconds(world.world().now()) > max_s) return false;
    if (stop && (world.world().step_number() - start) % steps_between_stops == 0 && stop()) return false;
  }
  return true;
}

/// Finds the length of each observation in the first world.
void WorldPool::measure_observations() {
  InProcessWorld& world = *worlds_.front()->world;
  check_layout(world);
  wait_for_observations(world, {});
  offsets_.assign(1, 0);
  for (const Observation& observation : layout_.observations) {
    std::size_t size = motion_values;
    if (!observation.channel.empty()) {
      const sim::Bytes* const payload = world.bus().find(observation.channel);
      if (payload == nullptr)
        throw Error("observation '" + observation.channel + "': nothing is published on this channel within 10 s");
      const auto* schema = shoal::embedded_types().find(static_cast<std::uint64_t>(shoal::fingerprint(*payload)));
      if (schema == nullptr) throw Error("the messages on '" + observation.channel + "' have no known type");
      size = MemberReader(*schema, observation.member).count(*payload);
    }
    observation_values_ += size;
    offsets_.push_back(observation_values_);
  }
}

void WorldPool::step(std::span<const double> actions, std::span<const std::int64_t> seeds,
                     std::span<double> observations, std::span<std::uint8_t> ended, const InProcessWorld::Stop& stop) {
  // Checked before any world is stepped, so that an error changes nothing.
  for (std::size_t i = 0; i < worlds_.size(); ++i)
    if (seeds[i] < 0) world(i);
  threads_.for_each(worlds_.size(), [&](std::size_t i) {
    Member& member = *worlds_[i];
    if (seeds[i] >= 0) {
      build(member, seeds[i]);
      take_steps(member, [&] { wait_for_observations(*member.world, stop); });
    } else if (member.status == goes_on) {
      step(member, actions.subspan(i * action_values_, action_values_), stop);
    }
    observe(member, observations.subspan(i * observation_values_, observation_values_));
    ended[i] = member.status;
  });
}

void WorldPool::step(Member& member, std::span<const double> actions, const InProcessWorld::Stop& stop) const {
  // Send the actions
  const sim::World& world = member.world->world();
  const std::int64_t utime = world.epoch_us() + world.now().count();
  for (std::size_t k = 0; k < member.forms.size(); ++k) {
    MessageForm& form = member.forms[k];
    member.world->send(layout_.actions[k].channel, form.fill(actions.first(form.count()), utime));
    actions = actions.subspan(form.count());
  }
  take_steps(member, [&] { member.world->step(layout_.steps, stop); });
}

void WorldPool::take_steps(Member& member, const std::function<void()>& steps) {
  try {
    steps();
    if (member.world->world().ended()) member.status = has_ended;
  } catch (const sim::PhysicsFault&) {
    member.status = has_failed;
  }
}

void WorldPool::observe(Member& member, std::span<double> out) const {
  for (std::size_t k = 0; k < layout_.observations.size(); ++k) {
    const Observation& observation = layout_.observations[k];
    const std::span<double> values = out.subspan(offsets_[k], offsets_[k + 1] - offsets_[k]);
    // NaN: nothing was published yet, or the vehicle does not exist.
    std::fill(values.begin(), values.end(), std::numeric_limits<double>::quiet_NaN());
    if (observation.channel.empty()) {
      const sim::Vehicle* const vehicle = member.world->world().find_vehicle(observation.vehicle);
      if (vehicle == nullptr) continue;
      const Motion motion = motion_of(*vehicle);
      static_assert(sizeof motion == motion_values * sizeof(double));
      std::memcpy(values.data(), &motion, sizeof motion);
      continue;
    }
    const sim::Bytes* const payload = member.world->bus().find(observation.channel);
    if (payload == nullptr) continue;
    const auto* schema = shoal::embedded_types().find(static_cast<std::uint64_t>(shoal::fingerprint(*payload)));
    if (schema != nullptr) MemberReader(*schema, observation.member).read(*payload, values);
  }
}

}  // namespace python
