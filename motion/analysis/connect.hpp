// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "motion/analysis/perturbed_world.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/motion/motion.hpp"
#include "sim/world_file/world_config.hpp"

namespace motion {

/// How a connection of two poses is searched.
struct ConnectOptions {
  int candidates = 300;  ///< limit of the search; earlier candidates are not counted
  int worlds = 4;        ///< perturbed ones, in addition to the unperturbed world
  double velocity = 1;   ///< mean one of the joint that moves furthest on the straight connection, rad/s or m/s
  double settle_s = 1;   ///< time after each motion in which the vehicle may still fall
  double arrive_rad = 2 * std::numbers::pi / 180;  ///< greatest difference of a joint from its end, rad; of a slider m
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one for each processor
};

/// How a motion ended in a world.
struct Arrival {
  bool fell = false;     ///< it tilted by more than 45 degrees, its first body touched something, or it diverged
  bool arrived = false;  ///< all joints are near their ends, and it stands still
  double at_s = 0;       ///< time after the start of the motion at the fall, or at the end
  double error = 0;      ///< greatest difference of a joint from its end, rad or m
  double value = 0;      ///< greater is better: 1 arrived, -1 to 0 by the error, -2 to -1 fallen, the later the better
};

/// World in which a vehicle is at the end of a motion, and from there plays others.
class ConnectWorld {
 public:
  /// Plays `start` to its end and waits.  `world` is one of world_for_walks().  Worlds are made by one thread.
  ConnectWorld(const sim::WorldConfig& world, const std::string& vehicle, const sim::JointMotion& start,
               double settle_s);
  ~ConnectWorld();

  /// Returns whether the vehicle stands still after the start.
  bool stands() const { return stands_; }
  /// Returns whether its first body touches something then.
  bool touches() const { return touches_; }
  /// Return the commanded position of each servo, rad or m: there, and at the start of the run.
  const sim::JointValues& commanded() const { return commanded_; }
  const sim::JointValues& stance() const { return stance_; }
  /// Plays a motion from there; its first values should be those commanded.  `may_touch`: its first body may touch
  /// something.
  Arrival play(const sim::JointMotion& motion, bool may_touch, const ConnectOptions& options);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  bool stands_ = false, touches_ = false;
  sim::JointValues commanded_, stance_;
};

/// How a connection was found.
enum class ConnectionKind { straight, slower, by_stance, searched, none };

/// Motion that connects two poses.
struct Connection {
  ConnectionKind kind = ConnectionKind::none;
  sim::JointMotion motion;            ///< the best one, even when none arrives
  double value = -2;                  ///< of its worst world
  std::vector<Arrival> straight;      ///< of the straight connection, by world: the world as it is first
  std::vector<Arrival> arrivals;      ///< of the best motion
  int played = 0;                     ///< motions in worlds
  std::vector<std::size_t> left_out;  ///< perturbed worlds, from 1, in which the vehicle does not stand at the start
};

/// Search for a motion from one pose to another, without a fall in the world as it is and in perturbed ones.
///
/// Tries, in this order: straight from pose to pose; the same slower; by the stance at the start of the run; and a
/// search by CMA-ES for a pose on the route and the times before and after it.  The first motion that arrives in all
/// worlds is the result.  It does not depend on the number of threads.
class Connector {
 public:
  /// `start`: motion at whose end the connection starts; it may be a pose, held.  Throws ConfigError when the vehicle
  /// falls in it.
  Connector(const sim::WorldConfig& world, const std::string& vehicle, const sim::JointMotion& start,
            const ConnectOptions& options);

  /// Searches a connection to joint values.
  Connection connect(const sim::JointValues& end);

 private:
  struct Route;
  const sim::VehicleConfig& vehicle_config() const;
  std::vector<Arrival> played_in_all(const sim::JointMotion& motion);
  sim::JointMotion motion_of(const Route& route) const;
  double attempt(const Route& route, ConnectionKind kind, Connection& connection);
  void search(const Route& first, Connection& connection);

  ConnectOptions options_;
  sim::WorldConfig world_;
  std::string vehicle_;
  std::vector<std::unique_ptr<ConnectWorld>> worlds_;
  std::vector<std::size_t> left_out_;
  std::vector<std::string> start_joints_;
  sim::ThreadPool pool_;
  // State of the present search.
  sim::JointValues from_, to_;  ///< with the same joints
  bool may_touch_ = false;
  int played_ = 0;
};

/// Returns a motion that holds joint values.
sim::JointMotion held_pose(const std::string& name, const std::string& vehicle, const sim::JointValues& values);

}  // namespace motion
