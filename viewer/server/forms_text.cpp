// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/forms_text.hpp"

#include <map>
#include <set>

#include "bridges/base/json_text.hpp"
#include "bridges/control/spawned_vehicles.hpp"
#include "experiment/drive/drive_mapping.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/script/action_registry.hpp"
#include "viewer/server/page_drive.hpp"

namespace viewer {

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
