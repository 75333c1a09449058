// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "devices/motion/motion_player.hpp"
#include "experiment/score/scoring.hpp"
#include "experiment/score/support.hpp"
#include "sim/motion/motion.hpp"
#include "sim/world/standalone_world.hpp"
#include "sim/world_file/load_world.hpp"

namespace motion {

/// Where a motion is played.
struct StageOptions {
  std::string world;                            ///< file
  std::shared_ptr<const sim::ConfigNode> tree;  ///< the world in a part of this file; null: it is the whole file
  std::string vehicle;                          ///< empty: the only one with a motion_player
  sim::LoadOptions load;
  double snapshot_s = 0.25;                                 ///< simulated time between two snapshots
  double kept_s = std::numeric_limits<double>::infinity();  ///< how far it can go back, s
  devices::MotionPlayer::Play play;                         ///< part that is played; the motion is that of the stage
  bool scores = false;                                      ///< whether the metrics of the world are computed
};

/// World in which a motion is played, and can be played again from any instant.
///
/// The world, the motion and its changes stay as they were up to that instant: the state after it is the same, bit for
/// bit, as in one run from the start.  A change at an instant is simulated only from there on; what followed before is
/// kept as a branch.
class MotionStage {
 public:
  /// Course of the vehicle that a change has replaced.
  struct Branch {
    double changed_at_s = 0;
    double end_s = 0;
    std::uint64_t state_hash = 0;  ///< at its end
  };

  /// Loads the world and puts the motion first into its player.  Throws ConfigError.
  MotionStage(const StageOptions& options, const sim::JointMotion& motion);
  /// The same for a motion that depends on the vehicle before the first step.
  MotionStage(const StageOptions& options, const std::function<sim::JointMotion(MotionStage&)>& make_motion);
  ~MotionStage();

  /// Simulates to a time of the run, s; to an earlier one from the last snapshot before it.
  void go_to(double at_s);
  /// Simulates until the motion has been played to its end, and `settle_s` more; at most `max_s` in all.  Carries out
  /// the changes of the motion on the way.  Returns whether the motion has ended.  Throws ConfigError when a change is
  /// not an action of the world.
  bool play_out(double settle_s, double max_s);
  /// Simulates one step, and carries out the changes of the motion that are due after it.  Throws as play_out().
  void play_step();

  /// Drops what was simulated beyond the present instant, and the changes there: the next step starts a branch.
  void cut();
  /// Replaces the motion from now on.
  void change_motion(const sim::JointMotion& motion);
  /// Executes an action of the world now, as in `events:`.  Throws sim::ConfigError or sim::WorldError when it cannot
  /// be carried out, or removes the vehicle; the world is then as before.
  void run_action(const sim::ConfigNode& action);

  double now_s() const;
  /// Returns the earliest time of the run to which it can go back, s.
  double earliest_s() const;
  /// Time of the run at which a time of the motion is reached in its first round, s.
  double time_of(double motion_s) const;
  std::uint64_t state_hash() const;
  /// Returns how the vehicle stands in the last step.  None: fewer than three contacts carry it, or they are known from
  /// the next step on, as in the first call and after a snapshot was restored.
  std::optional<experiment::Support> support();
  /// Metrics of the world, which go back with it; null without StageOptions::scores.
  const experiment::Scoring* scoring() const { return scoring_.get(); }
  const std::vector<Branch>& branches() const { return branches_; }
  sim::World& world() { return *world_; }
  /// Returns the world at its start, as a complete world file.
  const sim::ConfigNode& resolved_world() const { return loaded_.resolved; }
  /// Returns a world in which snapshots of this one can be restored.  It may be used by another thread, one thread at a
  /// time; the stage must outlive it.
  std::unique_ptr<sim::StandaloneWorld> copy() const { return std::make_unique<sim::StandaloneWorld>(loaded_.config); }
  /// Restores a snapshot of the world of this stage in a copy, with what after_restore sets.
  void restore(sim::World& copy, const sim::Bytes& snapshot) const;
  /// Carries out in a copy the changes that the world of this stage had after the present step of the copy.
  void apply_changes(sim::World& world) const;
  const sim::Vehicle& vehicle() const;
  const devices::MotionPlayer& player() const;
  devices::MotionPlayer& player() { return const_cast<devices::MotionPlayer&>(std::as_const(*this).player()); }
  /// Called after each step of go_to() and play_out().
  std::function<void(MotionStage&)> after_step;
  /// Sets what no snapshot holds in the player of a world in which one was restored, this or a copy.  Threads with
  /// copies call it at the same time.
  std::function<void(devices::MotionPlayer&)> after_restore;

 private:
  struct Change {
    std::int64_t step;
    sim::ConfigNode action;  ///< null: none
    sim::JointMotion motion;
  };
  struct Saved {
    sim::Bytes world, scores;
  };

  Saved save();
  void restore(const Saved& saved);
  devices::MotionPlayer& player_in(sim::World& world) const;
  void step();
  void apply(sim::World& world, const Change& change) const;
  void set_motion(sim::World& world, const sim::JointMotion& motion) const;
  void start_branch(Change change);
  void drop_old_snapshots();

  StageOptions options_;
  sim::LoadedWorld loaded_;
  std::unique_ptr<sim::StandaloneWorld> world_;
  std::unique_ptr<experiment::Scoring> scoring_;
  std::string vehicle_, player_;
  std::optional<std::uint64_t> watched_generation_;  ///< of the world, in which the contacts of the vehicle are watched
  std::optional<double> started_s_;                  ///< time of the run at the start of the motion
  std::vector<sim::MotionChange> due_;               ///< changes of the motion that are still to come
  std::map<std::int64_t, Saved> snapshots_;          ///< by step
  std::vector<Change> changes_;                      ///< of the present branch, by step
  std::vector<Branch> branches_;
  std::int64_t furthest_step_ = 0;  ///< of the present branch
  std::uint64_t furthest_hash_ = 0;
};

/// Returns a time of the run at which a motion that does not loop has ended, unless an action of the world holds it, s.
double end_limit_s(const sim::JointMotion& motion);

/// Returns the keys of a motion, as they are written in a file.
sim::ConfigNode node_of(const sim::JointMotion& motion);

}  // namespace motion
