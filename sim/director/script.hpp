// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/config_node.hpp"
#include "sim/director/actor.hpp"
#include "sim/director/condition_watch.hpp"
#include "sim/geometry/zone.hpp"
#include "sim/random/random.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

class Stage;
struct ActionRun;

/// Record of a vehicle in zones with a speed limit or a finish.
struct ZoneRecord {
  std::optional<double> finish_s;   ///< time of first entry into a finish zone
  std::int64_t speeding_steps = 0;  ///< steps above the speed limit of a zone
  double speeding_s = 0;
  void visit_state(StateArchive& archive) { archive(finish_s, speeding_steps, speeding_s); }
};

/// Zones, actors and events of a world: stage 4 of a step, at the start time of the step.
class Script {
 public:
  /// The world of `stage` must be built, and must outlive this.
  explicit Script(Stage& stage);
  ~Script();

  void step();
  /// Parses one action, or a list of them, and executes it immediately.  Errors and failures are reported to
  /// `diagnostics`.
  void run_now(const ConfigNode& action, Diagnostics& diagnostics);

  const Zones& zones() const { return zones_; }
  const std::map<std::string, ZoneRecord>& zone_records() const { return records_; }
  /// Returns the number of firings of an event by name; none when it does not exist.
  std::optional<std::int64_t> firings(const std::string& event) const;
  /// Returns whether the world file has no zones, actors and events.
  bool empty() const;
  void visit_state(StateArchive& archive);

  // Used by actions.
  /// Object of the world file, whether it is present or not.
  struct ListedObject {
    const ObjectConfig* config = nullptr;
    Pose X_WE = Pose::Identity();
  };
  /// Returns an object by its name, numbered where there are several; null when there is none.
  const ListedObject* find_listed(const std::string& name);
  /// Executes actions in order; a failure is reported, and the next action is executed.
  void carry_out(const std::vector<ActionEntry>& actions, const ActionRun& run);
  /// Fires an event, subject to its `times` and `probability`.
  void trigger(const std::string& event, int depth);
  void command_actor(const std::string& actor, ActorCommand command);
  /// Logs a line of text of an event; at most 1000 lines in a run.
  void log(const std::string& who, const std::string& text);

 private:
  struct EventState {
    explicit EventState(const EventConfig& config, std::uint64_t seed);
    /// Restarts the random streams; called once in a step.
    void start_draws(std::int64_t step_number);
    const EventConfig& config;
    Random random;  ///< for its choices; restarts in each step
    Random jitter;  ///< for its times; one draw for each planned firing
    std::int64_t random_step = -1;
    std::int64_t fired = 0;
    std::int64_t planned = 0;        ///< number of planned times that have passed
    std::optional<Time> next;        ///< next planned time
    std::vector<int> fired_by_this;  ///< events with the condition that this one fires
    bool reported_cut = false;
    void visit_state(StateArchive& archive);
  };
  void update_records(Time now);
  void plan_next(EventState& event);
  int due_times(EventState& event, Time now);
  void attempt(std::size_t event, int depth);
  void fire(std::size_t event, int depth);
  void cut(EventState& event, const std::string& why);
  std::vector<ActionEntry> parse_now(const ConfigNode& action, Diagnostics& diagnostics) const;
  void make_catalog();

  Stage& stage_;
  Zones zones_;
  std::vector<int> ruled_zones_;  ///< those with a speed limit or a finish
  std::map<std::string, ZoneRecord> records_;
  std::vector<Actor> actors_;
  std::vector<EventState> events_;
  std::vector<std::unique_ptr<ConditionWatch>> watches_;           ///< by event; null: no condition to watch
  std::map<std::pair<Time, std::uint64_t>, std::size_t> delayed_;  ///< (due time, order of scheduling) to event
  std::uint64_t next_delayed_ = 0;
  int firings_ = 0;                              ///< in this step
  std::map<std::string, ListedObject> catalog_;  ///< objects that `add: NAME` can add
  bool is_cataloged_ = false;
  Random live_random_;
  std::int64_t live_random_step_ = -1;
  int log_lines_ = 0;
};

}  // namespace sim
