// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/device/fault.hpp"
#include "sim/random/random.hpp"
#include "sim/script/actor_config.hpp"

namespace sim {

struct ObjectConfig;

/// Turns a map of values into the payload of a message type; what is wrong goes to the diagnostics.  sim/ knows no
/// message types: the program that loads a world brings this.
using EncodeMessage = std::function<Bytes(const std::string& type, const ConfigNode& value, Diagnostics&)>;

/// Where something is put: at a pose, at one of several places, or somewhere in an area.
struct PlaceChoice {
  std::optional<Vector3d> position_m;
  std::optional<Vector3d> rpy_rad;
  std::vector<Vector3d> places_m;      ///< one of them, at random
  Vector3d area_m = Vector3d::Zero();  ///< size of the box around the position that places are drawn from
  bool random_yaw = false;

  void read(ParamReader& in);
  /// `X_W_unless`: what is not said stays as it is there.
  Pose choose(const Pose& X_W_unless, Random& random) const;
};

enum class ActionKind {
  move,
  add,
  remove,
  one_of,
  fault,
  clear_fault,
  set,
  publish,
  actor,
  trigger,
  gravity,
  log,
  end
};

/// One thing an event does.  In YAML a map whose first key says what.
struct Action {
  ActionKind kind = ActionKind::log;
  SourcePlace place;
  std::string who;                             ///< for messages, such as `event 'night': action 2`
  std::vector<std::string> targets;            ///< move, remove: one of them, at random; else the one name
  PlaceChoice where;                           ///< move, add
  std::shared_ptr<const ObjectConfig> object;  ///< add: when it is written in the action
  std::vector<std::vector<Action>> choices;    ///< one_of
  std::vector<double> weights;                 ///< one_of; empty: all alike
  FaultConfig fault;
  ConfigNode values;    ///< set: key: value.  publish: of the message
  std::string channel;  ///< publish
  std::string message_type;
  Bytes payload;             ///< publish: encoded by check_actions()
  bool stamp_utime = false;  ///< publish: its first member is a time stamp that was not given
  ActorCommand command = ActorCommand::start;
  double gravity_mps2 = 0;
  std::string text;  ///< log, end
  bool passed = true;

  /// Names are those declared as `vehicle`, `object`, `vehicle or object`, `actor`, `event`.
  void read(ParamReader& in);

 private:
  void read_targets(ParamReader& in, const char* key);
  void read_add(ParamReader& in);
  void read_one_of(ParamReader& in);
  void read_publish(ParamReader& in);
  void read_kind(ParamReader& in);
};

/// `vehicle or object`: what can be moved and removed.
inline constexpr const char* movable_kind = "vehicle or object";

/// The names of the objects that `add` actions somewhere below bring.
std::vector<std::string> names_added_by(const ConfigNode& actions);

}  // namespace sim
