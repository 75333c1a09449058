// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "python/world/in_process_world.hpp"
#include "python/world/message_values.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/config/warnings.hpp"

namespace python {

/// Worlds of one file that differ in their seeds, stepped together on threads.  Results do not depend on the number of
/// threads.
class WorldPool {
 public:
  /// Values that a program sends: members of the messages on a channel.
  struct Action {
    std::string channel;
    std::string type;
    std::vector<std::string> members;
  };
  /// Values that it receives: a member of the messages on a channel, or the motion of a vehicle.
  struct Observation {
    std::string channel;  ///< empty: the true motion of `vehicle`
    std::string member;
    std::string vehicle;
  };
  struct Layout {
    std::vector<Action> actions;
    std::vector<Observation> observations;
    std::int64_t steps = 1;  ///< steps of a world for each step of the pool
  };
  /// Position, quaternion w x y z, velocity in world axes, angular velocity in vehicle axes.
  static constexpr std::size_t motion_values = 13;

  /// Builds one world, with the seed `first_seed`, to measure the lengths of observations: those of the first messages.
  /// The first step() must build all.  `threads`: 0: one for each processor.  Throws Error, sim::ConfigError.
  WorldPool(WorldSource source, std::size_t count, std::int64_t first_seed, Layout layout, int threads);
  ~WorldPool();

  std::size_t count() const { return worlds_.size(); }
  double step_s() const { return step_s_; }
  std::size_t action_values() const { return action_values_; }
  std::size_t observation_values() const { return observation_values_; }
  /// Returns where the values of each observation begin; the last element is their total number.
  const std::vector<std::size_t>& offsets() const { return offsets_; }
  /// Throws Error when it is not built.
  InProcessWorld& world(std::size_t index);

  /// Takes a step of each world: sends its row of `actions` (count x action_values) and takes the steps of the layout.
  /// A world with a seed >= 0 in `seeds` (count) is built again with it instead, and stepped, without actions, until
  /// each observed channel has its first message, up to 10 s.  Writes `observations` (count x observation_values), NaN
  /// where there is no message; `ended`: 1 for a world whose events ended the run, 2 for one
  /// whose physics failed; they are not stepped further.  When `stop`, which may be called by any thread, returns true,
  /// the worlds are at different times, and have to be built again.  Throws Error, sim::ConfigError.
  void step(std::span<const double> actions, std::span<const std::int64_t> seeds, std::span<double> observations,
            std::span<std::uint8_t> ended, const InProcessWorld::Stop& stop = {});

 private:
  struct Member;

  void build(Member& member, std::int64_t seed);
  void step(Member& member, std::span<const double> actions, const InProcessWorld::Stop& stop) const;
  /// Takes steps until each observed channel has a message.  Returns whether all have one.
  bool wait_for_observations(InProcessWorld& world, const InProcessWorld::Stop& stop) const;
  void observe(Member& member, std::span<double> out) const;
  void check_layout(InProcessWorld& world) const;
  void measure_observations();
  /// Takes steps by a function, and notes whether they ended the world.
  static void take_steps(Member& member, const std::function<void()>& steps);

  const WorldSource source_;
  const Layout layout_;
  std::mutex loading_;      // guards:
  sim::Warnings warnings_;  // each is logged once, not for every world
  sim::ThreadPool threads_;
  double step_s_ = 0;
  std::size_t action_values_ = 0, observation_values_ = 0;
  std::vector<std::size_t> offsets_;
  std::vector<std::unique_ptr<Member>> worlds_;
};

}  // namespace python
