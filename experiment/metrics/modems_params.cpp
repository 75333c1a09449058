// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/metrics/modems_params.hpp"

#include <vector>

#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/world_file/world_config.hpp"

namespace experiment {

namespace {

/// Returns whether a device is a modem by its commands: messages to send, or sentences of a host.
bool is_modem(const sim::DeviceConfig& device) {
  const sim::DeviceType* type = sim::DeviceRegistry::instance().find(device.type);
  if (type == nullptr) return true;  // reported elsewhere
  return type->command_messages == "shoal.modem_send_t" || type->command_messages == "shoal.nmea_sentence_t";
}

}  // namespace

void ModemsParams::read_modems(sim::ParamReader& in) {
  read_vehicle(in);
  in.read("device", device, "one modem of the vehicle; unset: all its modems");
  if (in.has("device") && vehicle.empty()) in.error("device", "'device' needs 'vehicle'");
}

void ModemsParams::check(const sim::MetricConfig& metric, const sim::WorldConfig& world,
                         sim::Diagnostics& diagnostics) const {
  if (device.empty()) return;
  for (const sim::VehicleInstance& instance : world.vehicles) {
    if (instance.name != vehicle || !instance.config) continue;
    std::vector<std::string> names;
    const sim::DeviceConfig* meant = nullptr;
    for (const sim::DeviceConfig& each : instance.config->devices) {
      if (each.name == device) meant = &each;
      if (is_modem(each)) names.push_back(each.name);
    }
    const std::string who = "metric '" + metric.name + "'";
    const std::string which = "device '" + sim::shortened(sim::printable(device)) + "'";
    const std::string rest = names.empty() ? "; it has no modem" : "; its modems: " + sim::list_text(names);
    if (meant == nullptr)
      diagnostics.error(metric.place, who, "vehicle '" + vehicle + "' has no " + which + rest);
    else if (!is_modem(*meant))
      diagnostics.error(
          metric.place, who,
          which + " of vehicle '" + vehicle + "' must be a modem, is of type '" + meant->type + "'" + rest);
  }
}

}  // namespace experiment
