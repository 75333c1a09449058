// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/connect.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "devices/motion/motion_player.hpp"
#include "devices/motion/servo_bank.hpp"
#include "experiment/optimize/cma_es.hpp"
#include "motion/analysis/motion_check.hpp"
#include "motion/analysis/motion_tracking.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/standalone_world.hpp"
#include "sim/world/world_state.hpp"

namespace motion {

namespace {

constexpr double max_play_s = 120;
constexpr double min_connection_s = 0.5;
constexpr double slower_factor = 3;
/// A vehicle stands still when it moves less than this in `still_s`.
constexpr double still_s = 0.2, still_m = 0.005, still_rad = 2 * std::numbers::pi / 180;
/// Range of the search: room of the pose on the route beyond the ends, and shares of the straight connection's time.
constexpr double via_room = 0.4, least_time_share = 0.25, greatest_time_share = 4;
constexpr double search_sigma = 0.2;

double value_named(const sim::JointValues& values, const std::string& joint) {
  return std::find_if(values.begin(), values.end(), [&](const auto& one) { return one.first == joint; })->second;
}

double longest_distance(const sim::JointValues& from, const sim::JointValues& to) {
  double longest = 0;
  for (std::size_t i = 0; i < from.size(); ++i) longest = std::max(longest, std::abs(to[i].second - from[i].second));
  return longest;
}

}  // namespace

/// Pose on the route, and the times before and after it.
struct Connector::Route {
  sim::JointValues via;  ///< empty: none, and the first time is that of the connection
  double first_s = 0, second_s = 0;
};

struct ConnectWorld::Impl {
  sim::WorldConfig config;  ///< must outlive the world
  sim::StandaloneWorld world;
  std::string vehicle_name;
  std::vector<const devices::JointServo*> servos;
  std::vector<std::string> names, aliases;
  devices::MotionPlayer* player = nullptr;
  sim::JointMotion start;
  sim::Bytes snapshot;
  bool fell = false;

  Impl(const sim::WorldConfig& in, std::string name, const sim::JointMotion& motion)
      : config(in), world(config), vehicle_name(std::move(name)), start(motion) {
    for (const sim::MountedDevice* device : vehicle().devices()) {
      if (const auto* servo = dynamic_cast<const devices::JointServo*>(device->actuator())) {
        servos.push_back(servo);
        names.push_back(device->config().name);
        aliases.push_back(servo->alias());
      }
      // The player is commanded here, in place of messages.
      if (const auto* one = dynamic_cast<const devices::MotionPlayer*>(device->sensor()))
        player = const_cast<devices::MotionPlayer*>(one);
    }
    start.name = "start";
    start.loop = false;
    world.physics().watch_contacts(vehicle().group());
  }

  const sim::Vehicle& vehicle() const { return *world.find_vehicle(vehicle_name); }
  double now_s() const { return sim::to_seconds(world.now()); }
  bool touches() const { return first_body_touches(world, vehicle()); }

  void step(bool may_touch) {
    try {
      world.step();
    } catch (const sim::PhysicsFault&) {
      fell = true;
      return;
    }
    fell = tilt_rad(vehicle()) > fallen_rad || (!may_touch && touches());
  }

  /// Plays a motion and waits.  Returns whether it stands still then.
  bool play(const sim::JointMotion& motion, bool skip_approach, bool may_touch, double settle_s) {
    player->change({.group = "", .motions = {{"", start}, {"", motion}}, .play = {}});
    devices::MotionPlayer::Play play;
    play.motion = motion.name;
    play.repeat = 1;
    play.skip_approach = skip_approach;
    player->play(play);
    fell = false;
    const double end_s = now_s() + max_play_s;
    while (!fell && player->phase() != devices::MotionPlayer::Phase::idle && now_s() < end_s) step(may_touch);
    const double settled_s = now_s() + std::max(settle_s, still_s);
    sim::Pose before = vehicle().X_WV();
    while (!fell && now_s() < settled_s - 1e-9) {
      if (now_s() < settled_s - still_s) before = vehicle().X_WV();
      step(may_touch);
    }
    const sim::Pose moved = before.inverse() * vehicle().X_WV();
    return !fell && moved.translation().norm() < still_m && Eigen::AngleAxisd(moved.linear()).angle() < still_rad;
  }

  std::optional<double> position_of(const std::string& joint) const {
    for (std::size_t i = 0; i < servos.size(); ++i)
      if (names[i] == joint || aliases[i] == joint) return servos[i]->joint_position();
    return std::nullopt;
  }
};

ConnectWorld::ConnectWorld(const sim::WorldConfig& config, const std::string& vehicle, const sim::JointMotion& start,
                           double settle_s)
    : impl_(std::make_unique<Impl>(config, vehicle, start)) {
  for (std::size_t i = 0; i < impl_->servos.size(); ++i)
    stance_.emplace_back(impl_->names[i], impl_->servos[i]->set_point().position);
  // The first body may lie on the ground at the start; whether it falls is a matter of its tilt.
  stands_ = impl_->play(impl_->start, false, true, settle_s);
  touches_ = !impl_->fell && impl_->touches();
  for (std::size_t i = 0; i < impl_->servos.size(); ++i)
    commanded_.emplace_back(impl_->names[i], impl_->servos[i]->set_point().position);
  impl_->snapshot = impl_->world.state().snapshot();
}

ConnectWorld::~ConnectWorld() = default;

Arrival ConnectWorld::play(const sim::JointMotion& motion, bool may_touch, const ConnectOptions& options) {
  impl_->world.state().restore(impl_->snapshot);
  const double start_s = impl_->now_s();
  const bool still = impl_->play(motion, true, may_touch, options.settle_s);
  Arrival arrival;
  arrival.fell = impl_->fell;
  arrival.at_s = impl_->now_s() - start_s;
  for (const sim::MotionTrack& track : motion.tracks())
    if (const auto position = impl_->position_of(track.joint))
      arrival.error = std::max(arrival.error, std::abs(*position - track.keys.back().value));
  arrival.arrived = still && arrival.error <= options.arrive_rad;
  // The search needs a value for failures, too: later falls and smaller errors are better.
  if (arrival.arrived)
    arrival.value = 1;
  else if (arrival.fell)
    arrival.value = -2 + std::min(1.0, arrival.at_s / (motion.end_s() + options.settle_s));
  else
    arrival.value = -std::min(1.0, arrival.error / std::numbers::pi + 0.1);
  return arrival;
}

Connector::Connector(const sim::WorldConfig& world, const std::string& vehicle, const sim::JointMotion& start,
                     const ConnectOptions& options)
    : options_(options), world_(world_for_walks(world)), vehicle_(vehicle), pool_(options.threads) {
  std::vector<Perturbation> perturbations(1);
  for (const Perturbation& one : drawn_perturbations(options.worlds, options.seed, "connect/worlds"))
    perturbations.push_back(one);
  for (std::size_t w = 0; w < perturbations.size(); ++w) {
    auto one =
        std::make_unique<ConnectWorld>(perturbed(world_, vehicle, perturbations[w]), vehicle, start, options.settle_s);
    if (one->stands())
      worlds_.push_back(std::move(one));
    else if (w == 0)
      // The world as it is must work; a perturbed one in which the vehicle does not stand says nothing about motions.
      throw sim::ConfigError({"vehicle '" + vehicle + "' does not stand still at the end of '" + start.name + "'"});
    else
      left_out_.push_back(w);
  }
  for (const sim::MotionTrack& track : start.tracks()) start_joints_.push_back(track.joint);
}

const sim::VehicleConfig& Connector::vehicle_config() const {
  const auto found = std::find_if(world_.vehicles.begin(), world_.vehicles.end(),
                                  [&](const sim::VehicleInstance& one) { return one.name == vehicle_; });
  return *found->config;
}

std::vector<Arrival> Connector::played_in_all(const sim::JointMotion& motion) {
  std::vector<Arrival> arrivals(worlds_.size());
  pool_.for_each(worlds_.size(), [&](std::size_t w) { arrivals[w] = worlds_[w]->play(motion, may_touch_, options_); });
  played_ += static_cast<int>(worlds_.size());
  return arrivals;
}

sim::JointMotion Connector::motion_of(const Route& route) const {
  sim::JointMotion motion;
  motion.name = "connection";
  motion.vehicle = vehicle_config().vehicle;
  motion.ease = sim::Easing::smooth;
  motion.keys.resize(route.via.empty() ? 2 : 3);
  motion.keys.front().joints = from_;
  motion.keys.back().joints = to_;
  motion.keys[1].at_s = route.first_s;
  if (!route.via.empty()) {
    motion.keys[1].joints = route.via;
    motion.keys[2].at_s = route.first_s + route.second_s;
  }
  motion = mended(motion, vehicle_config());
  motion.angles = sim::AngleUnit::deg;
  return motion;
}

/// Plays a motion in all worlds.  Returns the value of the worst; the best motion is kept.
double Connector::attempt(const Route& route, ConnectionKind kind, Connection& connection) {
  const sim::JointMotion motion = motion_of(route);
  const std::vector<Arrival> arrivals = played_in_all(motion);
  double value = 1;
  for (const Arrival& arrival : arrivals) value = std::min(value, arrival.value);
  if (kind == ConnectionKind::straight) connection.straight = arrivals;
  if (connection.motion.keys.empty() || value > connection.value) {
    connection.motion = motion;
    connection.value = value;
    connection.arrivals = arrivals;
    if (value >= 1) connection.kind = kind;
  }
  return value;
}

void Connector::search(const Route& first, Connection& connection) {
  // The coordinates: two times, and each joint of the pose on the route.
  const double straight_s = std::max(min_connection_s, longest_distance(from_, to_) / options_.velocity);
  struct Range {
    double low, high;
  };
  std::vector<Range> ranges(2, Range{least_time_share * straight_s, greatest_time_share * straight_s});
  for (std::size_t j = 0; j < from_.size(); ++j) {
    const auto [low, high] = std::minmax({from_[j].second, to_[j].second, first.via[j].second});
    ranges.push_back({low - via_room, high + via_room});
  }
  const auto share = [](double value, Range range) {
    return std::clamp((value - range.low) / (range.high - range.low), 0.0, 1.0);
  };
  experiment::Point start{share(first.first_s, ranges[0]), share(first.second_s, ranges[1])};
  for (std::size_t j = 0; j < first.via.size(); ++j) start.push_back(share(first.via[j].second, ranges[j + 2]));
  experiment::CmaEs cma_es(start, {.population = 0, .sigma = search_sigma, .seed = options_.seed});
  // Generations until one arrives everywhere.
  for (int tried = 0; tried + cma_es.population() <= options_.candidates;) {
    std::vector<double> values;
    for (const experiment::Point& point : cma_es.propose()) {
      const auto at = [&](std::size_t i) { return ranges[i].low + point[i] * (ranges[i].high - ranges[i].low); };
      Route route{first.via, at(0), at(1)};
      for (std::size_t j = 0; j < route.via.size(); ++j) route.via[j].second = at(j + 2);
      ++tried;
      values.push_back(attempt(route, ConnectionKind::searched, connection));
      if (connection.kind != ConnectionKind::none) return;
    }
    cma_es.learn(values);
  }
}

Connection Connector::connect(const sim::JointValues& end) {
  // Both ends with the same joints: what one does not name keeps its position.
  from_.clear();
  to_.clear();
  played_ = 0;
  sim::JointValues via;
  const std::vector<devices::ServoOfVehicle> servos = devices::servos_of(vehicle_config());
  for (const auto& named : end)
    if (std::none_of(servos.begin(), servos.end(), [&](const auto& servo) { return servo.is_called(named.first); }))
      throw sim::ConfigError({"vehicle '" + vehicle_ + "' has no joint_servo '" + named.first + "'"});
  for (const devices::ServoOfVehicle& servo : servos) {
    const auto named = [&](const auto& one) { return servo.is_called(one.first); };
    const auto value = std::find_if(end.begin(), end.end(), named);
    const bool in_start = std::any_of(start_joints_.begin(), start_joints_.end(),
                                      [&](const std::string& joint) { return servo.is_called(joint); });
    if (value == end.end() && !in_start) continue;
    const double commanded = value_named(worlds_.front()->commanded(), servo.device);
    from_.emplace_back(servo.device, commanded);
    to_.emplace_back(servo.device, value == end.end() ? commanded : value->second);
    via.emplace_back(servo.device, value_named(worlds_.front()->stance(), servo.device));
  }
  // A vehicle that lies at one of the ends may lie on the route.
  const ConnectWorld at_end(world_, vehicle_, held_pose("end", "", to_), options_.settle_s);
  may_touch_ = worlds_.front()->touches() || at_end.touches();
  Connection connection;
  connection.left_out = left_out_;
  const auto time_s = [&](const sim::JointValues& a, const sim::JointValues& b) {
    return std::max(min_connection_s, longest_distance(a, b) / options_.velocity);
  };
  const Route straight{{}, time_s(from_, to_), 0}, slow{{}, slower_factor * straight.first_s, 0};
  const Route by_stance{via, time_s(from_, via), time_s(via, to_)};
  attempt(straight, ConnectionKind::straight, connection);
  if (connection.kind == ConnectionKind::none) attempt(slow, ConnectionKind::slower, connection);
  if (connection.kind == ConnectionKind::none) attempt(by_stance, ConnectionKind::by_stance, connection);
  if (connection.kind == ConnectionKind::none) search(by_stance, connection);
  connection.played = played_;
  return connection;
}

sim::JointMotion held_pose(const std::string& name, const std::string& vehicle, const sim::JointValues& values) {
  sim::JointMotion motion;
  motion.name = name;
  motion.vehicle = vehicle;
  motion.keys.resize(2);
  motion.keys[1].at_s = 0.5;
  for (sim::MotionKey& key : motion.keys) key.joints = values;
  return motion;
}

}  // namespace motion
