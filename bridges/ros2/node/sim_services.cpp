// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/node/sim_services.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "bridges/ros2/converters/common_parts.hpp"
#include "sim/base/math.hpp"

namespace bridges::ros2 {
namespace {

using Json = nlohmann::json;

enum SimulationState : std::uint8_t { stopped = 0, playing = 1, paused = 2, quitting = 3 };

void put_text(CdrWriter& out) {
  out.put(std::string_view());
}

void put_list(CdrWriter& out) {
  out.put_count(0);
}

void put_lists(CdrWriter& out) {
  out.put_count(0);
  out.put_count(0);
}

/// Appends simulation_interfaces/EntityState.
void put_entity(CdrWriter& out, std::int64_t utime, std::span<const double> position_m, std::span<const double> wxyz,
                std::span<const double> velocity_mps, std::span<const double> turn_radps) {
  put_header(out, utime, world_frame);
  out.put_array(position_m);
  put_quaternion(out, wxyz.first<4>());
  out.put_array(velocity_mps);
  out.put_array(turn_radps);
  put_numbers(out, {0, 0, 0, 0, 0, 0});  // acceleration
}

void put_no_entity(CdrWriter& out) {
  constexpr std::array<double, 4> zero{};
  const auto three = std::span(zero).first(3);
  put_entity(out, 0, three, zero, three, three);
}

void put_stopped(CdrWriter& out) {
  out.put(std::uint8_t{stopped});
}

void put_no_features(CdrWriter& out) {
  put_lists(out);
  put_text(out);
}

/// Where a run is, of the reply `step 100, 1 s, branch 0, paused`.
struct Place {
  std::int64_t step = 0;
  bool is_paused = false;
};

Place place_in(const std::string& text) {
  Place place;
  constexpr std::string_view before = "step ";
  if (text.starts_with(before)) std::from_chars(text.data() + before.size(), text.data() + text.size(), place.step);
  place.is_paused = text.find(", paused") != std::string::npos;
  return place;
}

/// Pose in the world, as keys of a vehicle; none if it is not one.
std::optional<Json> pose_keys(const std::array<double, 7>& pose, const std::string& frame) {
  const sim::Quaterniond q(pose[6], pose[3], pose[4], pose[5]);
  const bool is_finite = std::all_of(pose.begin(), pose.end(), [](double value) { return std::isfinite(value); });
  if (!is_finite || q.norm() < 0.5 || !(frame.empty() || frame == world_frame)) return std::nullopt;
  Json rpy_deg;
  for (const double angle_rad : sim::rpy_from_rotation(q.normalized().toRotationMatrix()))
    rpy_deg.push_back(sim::radians_to_degrees(angle_rad));
  return Json{{"position_m", {pose[0], pose[1], pose[2]}}, {"rpy_deg", rpy_deg}};
}

std::string frame_in(CdrReader& in) {
  in.array<std::uint32_t, 2>();
  return in.text();
}

}  // namespace

std::span<const SimServices::Service> SimServices::services() {
  using S = SimServices;
#define SHOAL_SIM_SERVICE(name, type) "shoal/" name, "simulation_interfaces/srv/" type
  static constexpr std::array all{
      Service{SHOAL_SIM_SERVICE("get_simulation_state", "GetSimulationState"), false, &S::get_simulation_state,
              put_stopped},
      Service{SHOAL_SIM_SERVICE("set_simulation_state", "SetSimulationState"), true, &S::set_simulation_state, nullptr},
      Service{SHOAL_SIM_SERVICE("step_simulation", "StepSimulation"), true, &S::step_simulation, nullptr},
      Service{SHOAL_SIM_SERVICE("reset_simulation", "ResetSimulation"), true, &S::reset_simulation, nullptr},
      Service{SHOAL_SIM_SERVICE("get_entities", "GetEntities"), false, &S::get_entities, put_list},
      Service{SHOAL_SIM_SERVICE("get_entity_state", "GetEntityState"), false, &S::get_entity_state, put_no_entity},
      Service{SHOAL_SIM_SERVICE("get_entities_states", "GetEntitiesStates"), false, &S::get_entities_states, put_lists},
      Service{SHOAL_SIM_SERVICE("set_entity_state", "SetEntityState"), true, &S::set_entity_state, nullptr},
      Service{SHOAL_SIM_SERVICE("spawn_entity", "SpawnEntity"), true, &S::spawn_entity, put_text},
      Service{SHOAL_SIM_SERVICE("delete_entity", "DeleteEntity"), true, &S::delete_entity, nullptr},
      Service{SHOAL_SIM_SERVICE("get_simulator_features", "GetSimulatorFeatures"), false, &S::get_simulator_features,
              put_no_features}};
#undef SHOAL_SIM_SERVICE
  return all;
}

void SimServices::call(std::size_t service, std::span<const std::byte> request, Clock::time_point now) {
  now_ = now;
  CdrReader in(request);
  Call call{service, in.get<std::uint64_t>(), in.get<std::int64_t>()};
  const std::uint32_t id = next_call_++;
  calls_.emplace(id, call);
  const Service& called = services()[service];
  if (calls_.size() > max_calls) return respond(id, failed, "too many calls wait for the simulator");
  if (called.changes && !controls_)
    return respond(id, failed, "shoal-ros2 only controls the run with its option --control");
  try {
    (this->*called.call)(in, id);
  } catch (const shoal::MessageError&) {
    calls_.erase(id);
    throw;
  }
}

void SimServices::take_reply(const shoal::sim_control_reply_t& reply, Clock::time_point now) {
  now_ = now;
  const auto found = pending_.find(reply.id);
  if (found == pending_.end()) return;
  const Pending pending = std::move(found->second);
  pending_.erase(found);
  if (reply.ok == 0) return respond(pending.call, failed, reply.text);
  pending.then(reply);
}

void SimServices::expire(Clock::time_point now) {
  for (auto each = pending_.begin(); each != pending_.end();) {
    if (each->second.until > now) {
      ++each;
      continue;
    }
    const std::uint32_t call = each->second.call;
    each = pending_.erase(each);
    respond(call, failed, "the simulator does not answer");
  }
}

void SimServices::ask(std::uint32_t call, const std::string& command, double value, const std::string& text,
                      Then then) {
  pending_.insert_or_assign(links_.ask(command, value, text), Pending{call, std::move(then), now_ + patience});
}

void SimServices::respond(std::uint32_t call, std::uint8_t code, const std::string& error,
                          const std::function<void(CdrWriter&)>& rest) {
  const auto found = calls_.find(call);
  if (found == calls_.end()) return;
  const Call& of = found->second;
  const Service& service = services()[of.service];
  std::vector<std::byte> cdr;
  CdrWriter out(cdr);
  out.put(of.client);
  out.put(of.number);
  // Of two services the rest comes before the result, or there is none.
  const auto put_rest = [&] { rest ? rest(out) : service.rest(out); };
  const bool is_features = service.call == &SimServices::get_simulator_features;
  const bool rest_is_first = is_features || service.call == &SimServices::get_simulation_state;
  if (rest_is_first) put_rest();
  if (!is_features) {
    out.put(code);
    out.put(std::string_view(error));
  }
  if (!rest_is_first && service.rest != nullptr) put_rest();
  links_.respond(of.service, cdr);
  calls_.erase(found);
}

SimServices::Then SimServices::finish(std::uint32_t call) {
  return [this, call](const shoal::sim_control_reply_t&) { respond(call, ok, ""); };
}

void SimServices::get_simulation_state(CdrReader&, std::uint32_t call) {
  ask(call, "where", 0, "", [this, call](const shoal::sim_control_reply_t& reply) {
    const std::uint8_t state = place_in(reply.text).is_paused ? paused : playing;
    respond(call, ok, "", [state](CdrWriter& out) { out.put(state); });
  });
}

void SimServices::set_simulation_state(CdrReader& request, std::uint32_t call) {
  const auto target = request.get<std::uint8_t>();
  if (target > quitting) return respond(call, incorrect_transition, "the state must be 0 to 3");
  ask(call, "where", 0, "", [this, call, target](const shoal::sim_control_reply_t& reply) {
    const Place place = place_in(reply.text);
    const bool is_at_start = place.step == 0 && place.is_paused;
    if (target == (place.is_paused ? paused : playing) || (target == stopped && is_at_start))
      return respond(call, already_there, "the simulation is in this state already");
    if (target == stopped && place.step == 0) return ask(call, "pause", 0, "", finish(call));
    static constexpr std::array commands{"rewind", "resume", "pause", "quit"};
    constexpr double whole_run_s = 1e9;
    ask(call, commands[target], target == stopped ? whole_run_s : 0, "", finish(call));
  });
}

void SimServices::step_simulation(CdrReader& request, std::uint32_t call) {
  const auto steps = request.get<std::uint64_t>();
  constexpr std::uint64_t max_steps = 1'000'000;
  if (steps == 0 || steps > max_steps) return respond(call, failed, "steps must be 1 to 1000000");
  ask(call, "where", 0, "", [this, call, steps](const shoal::sim_control_reply_t& reply) {
    const Place place = place_in(reply.text);
    if (!place.is_paused) return respond(call, incorrect_state, "the simulation must be paused");
    ask(call, "step", static_cast<double>(steps), "",
        [this, call, last = place.step + static_cast<std::int64_t>(steps)](const shoal::sim_control_reply_t&) {
          await_step(call, last);
        });
  });
}

/// The simulator answers a request to step before it has stepped.
void SimServices::await_step(std::uint32_t call, std::int64_t step) {
  ask(call, "where", 0, "", [this, call, step](const shoal::sim_control_reply_t& reply) {
    if (place_in(reply.text).step >= step) return respond(call, ok, "");
    await_step(call, step);
  });
}

void SimServices::reset_simulation(CdrReader& request, std::uint32_t call) {
  constexpr std::uint8_t everything = 255;
  const auto scope = request.get<std::uint8_t>();
  if (scope != 0 && scope != everything)
    return respond(call, unsupported, "time, states and spawned entities are only reset together: scope 0 or 255");
  ask(call, "where", 0, "", [this, call](const shoal::sim_control_reply_t& reply) {
    const Place place = place_in(reply.text);
    if (place.step == 0) return respond(call, ok, "");
    constexpr double whole_run_s = 1e9;
    ask(call, "rewind", whole_run_s, place.is_paused ? "" : "run", finish(call));
  });
}

/// Reads simulation_interfaces/EntityFilters.  A regular expression of a stranger can take any time.
bool SimServices::refuse_filters(CdrReader& request, std::uint32_t call) {
  // What follows a list that is not empty is not read: the call is refused in any case.
  bool has_filter = !request.text().empty() || request.count(1) > 0 || request.count(1) > 0;
  if (!has_filter) has_filter = request.array<std::uint8_t, 2>()[1] != 0;  // mode of tags, type of bounds
  if (has_filter) respond(call, unsupported, "filters are not supported");
  return has_filter;
}

std::size_t SimServices::find(const std::string& entity) const {
  return static_cast<std::size_t>(std::find(state_.vehicle.begin(), state_.vehicle.end(), entity) -
                                  state_.vehicle.begin());
}

void SimServices::put_state(CdrWriter& out, std::size_t vehicle) const {
  put_entity(out, state_.utime, state_.position_m[vehicle], state_.orientation[vehicle], state_.velocity_mps[vehicle],
             state_.angular_velocity_radps[vehicle]);
}

void SimServices::get_entities(CdrReader& request, std::uint32_t call) {
  if (refuse_filters(request, call)) return;
  respond(call, ok, "", [this](CdrWriter& out) {
    out.put_count(state_.vehicle.size());
    for (const std::string& name : state_.vehicle) out.put(std::string_view(name));
  });
}

void SimServices::get_entity_state(CdrReader& request, std::uint32_t call) {
  const std::string entity = request.text();
  const std::size_t vehicle = find(entity);
  if (vehicle == state_.vehicle.size()) return respond(call, not_found, "there is no vehicle '" + entity + "'");
  respond(call, ok, "", [this, vehicle](CdrWriter& out) { put_state(out, vehicle); });
}

void SimServices::get_entities_states(CdrReader& request, std::uint32_t call) {
  if (refuse_filters(request, call)) return;
  respond(call, ok, "", [this](CdrWriter& out) {
    out.put_count(state_.vehicle.size());
    for (const std::string& name : state_.vehicle) out.put(std::string_view(name));
    out.put_count(state_.vehicle.size());
    for (std::size_t i = 0; i < state_.vehicle.size(); ++i) put_state(out, i);
  });
}

void SimServices::set_entity_state(CdrReader& request, std::uint32_t call) {
  const std::string entity = request.text();
  const std::string frame = frame_in(request);
  const auto pose = request.array<double, 7>();
  request.array<double, 12>();  // twist and acceleration
  const auto sets = request.array<std::uint8_t, 3>();
  if (find(entity) == state_.vehicle.size()) return respond(call, not_found, "there is no vehicle '" + entity + "'");
  if (sets[0] == 0 || sets[1] != 0 || sets[2] != 0)
    return respond(call, unsupported, "only the pose can be set; the vehicle is at rest then");
  std::optional<Json> keys = pose_keys(pose, frame);
  if (!keys) return respond(call, 101, "the pose must be finite, and in the frame 'world'");
  (*keys)["name"] = entity;
  ask(call, "do", 0, Json{{"move", *keys}}.dump(-1, ' ', false, Json::error_handler_t::replace), finish(call));
}

void SimServices::spawn_entity(CdrReader& request, std::uint32_t call) {
  std::string name = request.text();
  const bool may_rename = request.get<bool>();
  const std::string uri = request.text(), model = request.text(), name_space = request.text();
  const std::string frame = frame_in(request);
  auto pose = request.array<double, 7>();
  if (uri.empty() == model.empty() || (uri.empty() && !model.starts_with('{')))
    return respond(call, no_format, "give the name of a vehicle file as uri, or {...}, a model in YAML");
  if (!name_space.empty() && name_space != name && name_space != "/" + name)
    return respond(call, bad_namespace, "the namespace of a vehicle is its name");
  std::optional<Json> keys = pose_keys(pose, frame);
  if (!keys) return respond(call, bad_pose, "the pose must be finite, and in the frame 'world'");
  const std::string wanted = name;
  for (int number = 2; may_rename && find(name) != state_.vehicle.size(); ++number)
    name = wanted + "_" + std::to_string(number);
  (*keys)["name"] = name;
  if (!uri.empty()) (*keys)["file"] = uri;
  std::string text = keys->dump(-1, ' ', false, Json::error_handler_t::replace);
  if (!model.empty()) text.insert(text.size() - 1, ", \"model\": " + model);
  ask(call, "spawn", 0, text, [this, call, name](const shoal::sim_control_reply_t&) {
    respond(call, ok, "", [&name](CdrWriter& out) { out.put(std::string_view(name)); });
  });
}

void SimServices::delete_entity(CdrReader& request, std::uint32_t call) {
  const std::string entity = request.text();
  if (find(entity) == state_.vehicle.size()) return respond(call, not_found, "there is no vehicle '" + entity + "'");
  ask(call, "remove", 0, entity, finish(call));
}

void SimServices::get_simulator_features(CdrReader&, std::uint32_t call) {
  // SPAWNING, DELETING, SPAWNING_RESOURCE_STRING, ENTITY_STATE_GETTING and _SETTING, SIMULATION_RESET,
  // SIMULATION_STATE_GETTING, _SETTING and _PAUSE, STEP_SIMULATION_SINGLE and _MULTIPLE
  static constexpr std::array<std::uint16_t, 11> all{0, 1, 9, 10, 11, 20, 24, 25, 26, 31, 32};
  static constexpr std::array<std::uint16_t, 2> to_read{10, 24};
  respond(call, ok, "", [this](CdrWriter& out) {
    out.put_sequence(controls_ ? std::span<const std::uint16_t>(all) : std::span<const std::uint16_t>(to_read));
    out.put_count(1);
    out.put(std::string_view("yaml"));
    out.put(std::string_view("Shoal; poses are in the frame 'world', entities are vehicles"));
  });
}

}  // namespace bridges::ros2
