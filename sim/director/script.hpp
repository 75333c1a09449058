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

/// How a vehicle did in zones with rules.
struct ZoneRecord {
  std::optional<double> finish_s;   ///< when it first was in a finish zone
  std::int64_t speeding_steps = 0;  ///< steps above the limit of a zone it was in
  double speeding_s = 0;
  void visit_state(StateArchive& archive) { archive(finish_s, speeding_steps, speeding_s); }
};

/// Zones, actors and events of a world: stage 4 of a step, at the time of the step's start.
class Script {
 public:
  /// The world of `stage` is built already; it must outlive this.
  explicit Script(Stage& stage);
  ~Script();

  void step();
  /// Parses one action, or a list of them, and carries it out now.  What is wrong or fails goes to `diagnostics`.
  void run_now(const ConfigNode& action, Diagnostics& diagnostics);

  const Zones& zones() const { return zones_; }
  const std::map<std::string, ZoneRecord>& zone_records() const { return records_; }
  /// Number of firings of the event of this name; nothing when it does not exist.
  std::optional<std::int64_t> firings(const std::string& event) const;
  /// The world file has none of it.
  bool empty() const;
  void visit_state(StateArchive& archive);

  // For actions.
  /// An object of the world file, whether it is there or not.
  struct ListedObject {
    const ObjectConfig* config = nullptr;
    Pose X_WE = Pose::Identity();
  };
  /// By its name, numbered where there are several.  Null when there is none.
  const ListedObject* find_listed(const std::string& name);
  /// One after the other; what fails is reported, and the next one follows.
  void carry_out(const std::vector<ActionEntry>& actions, const ActionRun& run);
  /// Lets an event fire, as far as its `times` and `probability` allow.
  void trigger(const std::string& event, int depth);
  void command_actor(const std::string& actor, ActorCommand command);
  /// A line of text from an event; a run logs 1000 of them.
  void log(const std::string& who, const std::string& text);

 private:
  struct EventState {
    explicit EventState(const EventConfig& config, std::uint64_t seed);
    /// Once in a step.
    void start_draws(std::int64_t step_number);
    const EventConfig& config;
    Random random;  ///< of its choices; restarts in each step
    Random jitter;  ///< of its times; one draw for each planned firing
    std::int64_t random_step = -1;
    std::int64_t fired = 0;
    std::int64_t planned = 0;        ///< how many of its times have come
    std::optional<Time> next;        ///< the next of its times
    std::vector<int> fired_by_this;  ///< events that wait for this one
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
  void make_catalogue();

  Stage& stage_;
  Zones zones_;
  std::vector<int> ruled_zones_;  ///< those with a speed limit or a finish
  std::map<std::string, ZoneRecord> records_;
  std::vector<Actor> actors_;
  std::vector<EventState> events_;
  std::vector<std::unique_ptr<ConditionWatch>> watches_;           ///< by event; null: it waits for nothing
  std::map<std::pair<Time, std::uint64_t>, std::size_t> delayed_;  ///< due, order of scheduling: event
  std::uint64_t next_delayed_ = 0;
  int firings_ = 0;                                ///< in this step
  std::map<std::string, ListedObject> catalogue_;  ///< what `add: NAME` adds
  bool catalogued_ = false;
  Random live_random_;
  std::int64_t live_random_step_ = -1;
  int log_lines_ = 0;
};

}  // namespace sim
