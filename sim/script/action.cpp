// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/action.hpp"

#include <algorithm>
#include <numeric>

#include "sim/config/message_text.hpp"
#include "sim/config/read_points.hpp"
#include "sim/model/object_config.hpp"

namespace sim {

namespace {

const std::vector<std::pair<std::string, ActionKind>> action_words = {{"move", ActionKind::move},
                                                                      {"add", ActionKind::add},
                                                                      {"remove", ActionKind::remove},
                                                                      {"one_of", ActionKind::one_of},
                                                                      {"fault", ActionKind::fault},
                                                                      {"clear_fault", ActionKind::clear_fault},
                                                                      {"set", ActionKind::set},
                                                                      {"publish", ActionKind::publish},
                                                                      {"actor", ActionKind::actor},
                                                                      {"trigger", ActionKind::trigger},
                                                                      {"gravity_mps2", ActionKind::gravity},
                                                                      {"log", ActionKind::log},
                                                                      {"end", ActionKind::end}};

/// `move: {one_of: [a, b]}`
struct OneOfNames {
  std::vector<std::string> one_of;
  void read(ParamReader& in) {
    in.require("one_of");
    in.read_references("one_of", one_of, movable_kind, "one of them, at random");
    if (in.has("one_of") && one_of.empty() && in.child("one_of")->items.empty())
      in.error("one_of", "'one_of' must name at least one");
  }
};

void describe_text(ParamReader& in, const char* key, const char* meaning) {
  ParamInfo info;
  info.key = key;
  info.type = "action";
  info.meaning = meaning;
  in.describe(std::move(info));
}

void describe_actions(ParamReader& in) {
  describe_text(in, "move", "vehicle or object to put somewhere, or {one_of: [names]}");
  PlaceChoice().read(in);
  describe_text(in, "add", "an object of the world that is not there, or a new one with the keys of an object");
  describe_text(in, "remove", "vehicle or object to take away, or {one_of: [names]}");
  describe_text(in, "one_of", "[[actions], [actions]]: one of these lists, at random");
  describe_text(in, "weights", "one_of: how often each is chosen");
  describe_text(in, "fault", "VEHICLE/DEVICE, with the keys of a fault");
  // By hand, for an action that is no fault needs no `kind`.
  for (const char* key : {"kind", "quantity", "bias", "noise_factor", "dropout", "effectiveness"})
    describe_text(in, key, "fault: as in a fault of a device");
  describe_text(in, "clear_fault", "VEHICLE/DEVICE");
  describe_text(in, "set", "VEHICLE/DEVICE, with `values: {key: value}` for keys of the device");
  describe_text(in, "values", "set: dotted key: value");
  describe_text(in, "publish", "channel, with `type` and `value`");
  describe_text(in, "type", "publish: message type, such as shoal.twist_command_t");
  describe_text(
      in, "value",
      "publish: member: value; members that are missing are 0, or NaN in commands where that means as before; utime is "
      "the time");
  describe_text(in, "actor", "actor that gets a `command`");
  describe_text(in, "command", "actor: start, stop, forward or back");
  describe_text(in, "trigger", "event that fires now");
  describe_text(in, "gravity_mps2", "from now on, downwards");
  describe_text(in, "log", "text for the log");
  describe_text(in, "end", "the run ends after this step; text for the summary");
  describe_text(in, "passed", "end: whether the run passed");
}

}  // namespace

void PlaceChoice::read(ParamReader& in) {
  Vector3d position = Vector3d::Zero();
  Vector3d rpy = Vector3d::Zero();
  in.read("position_m", position, any_place(), "place in the world");
  in.read_deg("rpy_deg", rpy, "roll, pitch, yaw; unset: as it was");
  read_points(in, "places", places_m, 3, "one of these places, at random");
  in.read("area_m", area_m, at_least(0), "size of a box around the place, somewhere in which it is put");
  in.read("random_yaw", random_yaw, "the heading is drawn from the full circle");
  if (in.has("position_m")) position_m = position;
  if (in.has("rpy_deg")) rpy_rad = rpy;
  if (in.has("position_m") && in.has("places")) in.error("places", "needs either 'position_m' or 'places', not both");
  if (in.has("places") && places_m.empty()) in.error("places", "'places' must have at least one place");
}

Pose PlaceChoice::choose(const Pose& X_W_unless, Random& random) const {
  Pose X_W = X_W_unless;
  if (position_m) X_W.translation() = *position_m;
  if (!places_m.empty())
    X_W.translation() = places_m[random.integer_below(static_cast<std::uint32_t>(places_m.size()))];
  for (int i = 0; i < 3; ++i)
    if (area_m[i] > 0) X_W.translation()[i] += (random.uniform() - 0.5) * area_m[i];
  if (rpy_rad) X_W.linear() = rotation_from_rpy(*rpy_rad);
  if (random_yaw) X_W.linear() = rotation_from_rpy({0, 0, 2 * std::numbers::pi * random.uniform()}) * X_W.linear();
  return X_W;
}

void Action::read(ParamReader& in) {
  if (in.describing()) return describe_actions(in);
  place = in.node()->place;
  who = in.who();
  if (in.node()->kind != ConfigNode::Kind::map) return;  // was reported
  std::vector<std::string> words;
  for (const auto& [word, each] : action_words) words.push_back(word);
  const std::string first = in.node()->entries.empty() ? "" : in.node()->entries.front().key;
  const auto found =
      std::find_if(action_words.begin(), action_words.end(), [&](const auto& each) { return each.first == first; });
  if (found == action_words.end()) {
    const std::string meant = closest_name(first, words);
    in.error("unknown action '" + shortened(printable(first)) + "'; known actions: " + list_text(words) +
             (meant.empty() ? "" : "; did you mean '" + meant + "'?"));
    for (const ConfigNode::Entry& entry : in.node()->entries) in.child(entry.key.c_str());
    return;
  }
  kind = found->second;
  read_kind(in);
}

void Action::read_kind(ParamReader& in) {
  std::string name;
  switch (kind) {
    case ActionKind::move:
      read_targets(in, "move");
      where.read(in);
      if (!in.has("position_m") && !in.has("places") && !in.has("area_m") && !in.has("rpy_deg") && !where.random_yaw)
        in.error("'move' needs a place: position_m, places, area_m, rpy_deg or random_yaw");
      return;
    case ActionKind::add:
      return read_add(in);
    case ActionKind::remove:
      return read_targets(in, "remove");
    case ActionKind::one_of:
      return read_one_of(in);
    case ActionKind::fault:
      in.read("fault", name, "");
      fault.read(in);
      break;
    case ActionKind::clear_fault:
      in.read("clear_fault", name, "");
      break;
    case ActionKind::set:
      in.read("set", name, "");
      in.require("values");
      in.read_raw("values", values, "");
      break;
    case ActionKind::publish:
      return read_publish(in);
    case ActionKind::actor:
      in.read_reference("actor", name, "actor", "");
      in.require("command");
      in.read_choice("command", command, actor_command_words(), "");
      break;
    case ActionKind::trigger:
      in.read_reference("trigger", name, "event", "");
      break;
    case ActionKind::gravity:
      in.read("gravity_mps2", gravity_mps2, between(-1000, 1000), "");
      return;
    case ActionKind::log:
      in.read("log", text, "");
      return;
    case ActionKind::end:
      in.read("end", text, "");
      in.read("passed", passed, "");
      return;
  }
  targets = {name};
}

void Action::read_targets(ParamReader& in, const char* key) {
  if (const ConfigNode* value = in.child(key); value->kind == ConfigNode::Kind::map) {
    OneOfNames names;
    in.read(key, names, "");
    targets = names.one_of;
    return;
  }
  targets.resize(1);
  in.read_reference(key, targets[0], movable_kind, "");
  if (targets[0].empty() && in.child(key)->kind == ConfigNode::Kind::scalar)
    in.error(key, "'" + std::string(key) + "' must name a vehicle or an object");
}

void Action::read_add(ParamReader& in) {
  where.read(in);
  if (in.child("add")->kind != ConfigNode::Kind::map) {
    targets.resize(1);
    in.read_reference("add", targets[0], "object", "");
    return;
  }
  auto added = std::make_shared<ObjectConfig>();
  in.read("add", *added, "");
  if (added->count != 1) in.error("add", "'count' does not belong to an object that an action adds");
  targets = {added->name};
  object = std::move(added);
}

void Action::read_one_of(ParamReader& in) {
  in.read_lists("one_of", choices, "action");
  in.read("weights", weights, at_least(0), "");
  if (choices.empty() && in.child("one_of")->items.empty())
    in.error("one_of", "'one_of' must have at least one list of actions");
  if (!in.has("weights")) return;
  const std::size_t count = in.child("one_of")->items.size();
  if (in.child("weights")->items.size() != count)
    in.error("weights", "'weights' must have one number for each of the " + std::to_string(count) + " lists");
  else if (!weights.empty() && std::accumulate(weights.begin(), weights.end(), 0.0) <= 0)
    in.error("weights", "'weights' must not all be 0");
}

void Action::read_publish(ParamReader& in) {
  in.read("publish", channel, "");
  if (channel.empty() || channel.size() > Bus::max_channel_length)
    in.error("publish", "a channel must have 1 to 63 characters, got " + std::to_string(channel.size()));
  else if (channel.starts_with("sim.") || printable(channel) != channel)
    in.error("publish", "channel '" + printable(channel) +
                            "' cannot be published on: sim.* belongs to the simulator, and " + "names are printable");
  in.require("type");
  in.read("type", message_type, "");
  in.read_raw("value", values, "");
  if (values.kind == ConfigNode::Kind::null) {
    values.kind = ConfigNode::Kind::map;
    values.place = in.node()->place;
  }
}

std::vector<std::string> names_added_by(const ConfigNode& actions) {
  std::vector<std::string> names;
  const auto append = [&](const ConfigNode& node) {
    for (std::string& name : names_added_by(node)) names.push_back(std::move(name));
  };
  for (const ConfigNode& item : actions.items) append(item);
  for (const ConfigNode::Entry& entry : actions.entries) {
    const ConfigNode* name = entry.value.find("name");
    if (entry.key == "add" && name != nullptr && name->kind == ConfigNode::Kind::scalar) names.push_back(name->scalar);
    append(entry.value);
  }
  return names;
}

}  // namespace sim
