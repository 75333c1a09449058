// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/page_drive.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bridges/base/json_text.hpp"
#include "bridges/control/spawned_vehicles.hpp"
#include "experiment/drive/drive_mapping.hpp"
#include "experiment/drive/drive_profile.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/script/action_registry.hpp"

namespace viewer {
namespace {

using Json = nlohmann::json;

constexpr std::size_t max_values = 100;

experiment::DrivePose pose_of(const sim::World& world, const sim::Vehicle& vehicle) {
  const sim::Pose X_WV = vehicle.X_WV();
  const double surface_m = world.medium().has_water() ? world.medium().still_surface_m() : 0;
  return {std::atan2(X_WV.linear()(1, 0), X_WV.linear()(0, 0)), surface_m - X_WV.translation().z()};
}

std::string text_of(const Json& message, const char* key) {
  const auto found = message.find(key);
  if (found == message.end() || found->is_null()) return {};
  if (!found->is_string()) throw experiment::DriveError(std::string("'") + key + "' of drive must be a text");
  return found->get<std::string>();
}

}  // namespace

PageDrive::Request PageDrive::read(std::string_view text) {
  const Json message = Json::parse(text, nullptr, false);
  if (!message.is_object()) throw experiment::DriveError("drive must be a JSON object");
  Request request{text_of(message, "vehicle"), text_of(message, "kind"), {}};
  const auto values = message.find("values");
  // Without values: only find out how the vehicle can be driven.
  if (values == message.end() || values->is_null()) return request;
  if (!values->is_object() || values->size() > max_values)
    throw experiment::DriveError("'values' of drive must be an object with at most 100 numbers");
  for (const auto& [axis, value] : values->items()) {
    if (!value.is_number() || !(std::abs(value.get<double>()) <= 1))
      throw experiment::DriveError("'values." + sim::shortened(sim::printable(axis)) +
                                   "' of drive must be a number from -1 to 1");
    request.values.emplace(axis, value.get<double>());
  }
  return request;
}

void PageDrive::take(int client, const Request& request, const sim::World& world, Clock::time_point now) {
  const sim::Vehicle* vehicle = world.find_vehicle(request.vehicle);
  if (vehicle == nullptr)
    throw experiment::DriveError("there is no vehicle '" + sim::shortened(sim::printable(request.vehicle)) +
                                 "' to drive");
  auto seat = seats_.find(request.vehicle);
  if (seat != seats_.end() && seat->second.client != client && seat->second.driver.held())
    throw experiment::DriveError("vehicle '" + request.vehicle + "' is driven by another page");
  if (request.values.empty()) {
    if (seat != seats_.end()) seat->second.driver.release();
    return;
  }
  // A driver of another page or kind makes room after its safe commands.
  if (seat != seats_.end() && (seat->second.client != client || seat->second.kind != request.kind)) {
    seat->second.driver.release();
    if (seat->second.driver.busy()) return;
    seats_.erase(seat);
    seat = seats_.end();
  }
  if (seat == seats_.end()) {
    std::optional<experiment::DriveKind> kind;
    if (!request.kind.empty()) {
      kind = sim::value_of(experiment::drive_kind_words, request.kind);
      if (!kind)
        throw experiment::DriveError("'kind' of drive must be twist, tilt, helm, thrust or joints, got '" +
                                     sim::shortened(sim::printable(request.kind)) + "'");
    }
    const experiment::DrivenVehicle driven = experiment::driven_vehicle(bridges::vehicle_message(*vehicle));
    seat = seats_.emplace(request.vehicle, Seat{client, request.kind, {profile_, driven, kind}}).first;
  }
  // An axis that the vehicle does not have is a mistake, not nothing.
  const std::vector<std::string>& axes = seat->second.driver.mapping().axes();
  for (const auto& [axis, value] : request.values)
    if (std::find(axes.begin(), axes.end(), axis) == axes.end())
      throw experiment::DriveError("vehicle '" + request.vehicle + "' has no axis '" +
                                   sim::shortened(sim::printable(axis)) + "'");
  seat->second.driver.hold(request.values, now);
}

void PageDrive::left(int client) {
  for (auto& [name, seat] : seats_)
    if (seat.client == client) seat.driver.release();
}

void PageDrive::run(const sim::World& world, Clock::time_point now, bool paused, const Publish& publish) {
  for (auto each = seats_.begin(); each != seats_.end();) {
    experiment::Driver& driver = each->second.driver;
    const sim::Vehicle* vehicle = world.find_vehicle(each->first);
    if (paused) driver.release();
    if (vehicle != nullptr) {
      const std::int64_t utime = world.epoch_us() + world.now().count();
      for (const experiment::DriveCommand& command : driver.due(now, utime, pose_of(world, *vehicle)))
        publish(each->first, command.channel, command.payload);
    }
    // Seats without a driver are given up.
    each = vehicle == nullptr || !driver.busy() ? seats_.erase(each) : std::next(each);
  }
}

namespace {

using Json = nlohmann::json;

Json key_json(const sim::ParamInfo& key) {
  Json json{{"key", key.key}, {"type", key.type}, {"meaning", key.meaning}, {"required", key.required}};
  if (!key.rule.empty()) json["rule"] = key.rule;
  if (!key.choices.empty()) json["choices"] = key.choices;
  return json;
}

Json actions_json() {
  Json all = Json::array();
  for (const sim::ActionKind* kind : sim::ActionRegistry::instance().all()) {
    Json keys = Json::array();
    for (const sim::ParamInfo& key : kind->keys()) keys.push_back(key_json(key));
    all.push_back({{"word", kind->word},
                   {"meaning", kind->meaning},
                   {"main", kind->main_key},
                   {"main_alone", kind->main_alone},
                   {"keys", std::move(keys)}});
  }
  return all;
}

/// Returns the kinds of faults that a type of device takes, and its quantities.
Json faults_json(const sim::DeviceType& type) {
  Json kinds = Json::array();
  for (const auto& [word, kind] : sim::fault_kind_words) {
    sim::FaultConfig fault;
    fault.kind = kind;
    if (sim::fault_misfit(type, fault).empty()) kinds.push_back(std::string(word));
  }
  return {{"faults", std::move(kinds)}, {"quantities", type.quantities()}};
}

}  // namespace

std::string forms_text(const sim::World& world, const experiment::DriveProfile& profile) {
  Json types = Json::object(), drives = Json::object();
  // Vehicles of the same model are driven alike.
  std::map<const void*, Json> by_model;
  for (const auto& vehicle : world.vehicles()) {
    for (const sim::MountedDevice* device : vehicle->devices()) {
      const sim::DeviceType& type = *device->config().device_type;
      if (!types.contains(type.name)) types[type.name] = faults_json(type);
    }
    Json& kinds = by_model[&vehicle->config()];
    if (kinds.is_null()) {
      kinds = Json::array();
      const experiment::DrivenVehicle driven = experiment::driven_vehicle(bridges::vehicle_message(*vehicle));
      for (const experiment::DriveKind kind : experiment::drive_kinds(profile, driven))
        kinds.push_back({{"kind", std::string(sim::word_of(experiment::drive_kind_words, kind))},
                         {"axes", experiment::DriveMapping(profile, driven, kind).axes()}});
    }
    if (!kinds.empty()) drives[vehicle->name()] = kinds;
  }
  // Names.
  Json events = Json::array(), objects = Json::array(), actors = Json::array();
  for (const sim::EventConfig& event : world.config().events) events.push_back(event.name);
  for (const auto& [name, object] : world.objects()) objects.push_back(name);
  for (const auto& actor : world.config().actors) actors.push_back(actor.name);
  return bridges::json_text({{"op", "forms"},
                             {"actions", actions_json()},
                             {"types", std::move(types)},
                             {"events", std::move(events)},
                             {"objects", std::move(objects)},
                             {"actors", std::move(actors)},
                             {"drives", std::move(drives)}});
}

}  // namespace viewer
