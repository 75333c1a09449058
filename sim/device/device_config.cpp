// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/device_config.hpp"

#include <algorithm>

#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"

namespace sim {

void DeviceConfig::read_common(ParamReader& in) {
  in.require("name");
  in.read_name("name", name, "name of the device, unique in its vehicle; part of its channels");
  in.require("type");
  in.read("type", type, "device type, see `shoal list devices`");
  in.read_reference("body", body, "body", "body it is mounted on; unset: the vehicle's first body");
  if (body == "world") in.error("body", "'body' must be a body of the vehicle, got 'world'");
  in.read("position_m", position_m, any_number(), "place of the sensor frame in the body frame");
  in.read_deg("rpy_deg", rpy_rad, "roll, pitch, yaw of the sensor frame in the body frame");
  // Lower limit of the rate: one sample in twelve days.
  in.read_or_word("rate_hz", rate_hz, between(1e-6, 1e6), {"every_step"}, "samples per simulated second");
  in.read("phase_s", phase_s, between(0, 1e6), "time of the first sample; unset: spread over the period by name");
  in.read("latency_s", latency_s, between(0, 1e6), "from sample to report, or from command to effect");
  in.read("jitter_s", jitter_s, between(0, 1e6), "added to the latency, uniform between 0 and this");
  in.read("dropout", dropout, between(0, 1), "probability that a report or a command is lost");
  in.read("truth", truth, "publish the reading without its errors on CHANNEL.truth");
  in.read("power_W", power_W, at_least(0), "power drawn from the vehicle's battery all the time");
  in.read("channel", channel, "channel of the reports; unset: by the world's template");
}

void DeviceConfig::read_actuator(ParamReader& in, const DeviceType& of) {
  in.read_or_word("watchdog_s", watchdog_s, above_to(0, 1e6), {"never"}, "a last command older than this is stale");
  safe = of.safe_states.front();
  in.read_choice("safe", safe, safe_state_words, of.safe_states,
                 "safe state when commands are stale, at an emergency stop, or without power");
}

void DeviceConfig::read(ParamReader& in) {
  if (in.node() != nullptr) {
    place = in.node()->place;
    source = std::make_shared<const ConfigNode>(*in.node());
  }
  // Find the device type.
  if (const ConfigNode* node = in.child("type"); node != nullptr) {
    device_type = DeviceRegistry::instance().find(node->scalar);
    if (device_type == nullptr) {
      std::vector<std::string> known;
      for (const DeviceType* each : DeviceRegistry::instance().all()) known.push_back(each->name);
      in.error("type", "unknown device type '" + node->scalar + "'; known types: " + list_text(known, known.size()) +
                           did_you_mean(node->scalar, known));
      in.read("name", name, "");
      // Do not report the other keys of an unknown type as unknown, which would obscure the error.
      for (const ConfigNode::Entry& entry : in.node()->entries) in.child(entry.key.c_str());
      return;
    }
    rate_hz = device_type->default_rate_hz;
  }
  // Read the common keys and those of the type.
  read_common(in);
  if (device_type == nullptr) return;
  if (device_type->is_actuator()) read_actuator(in, *device_type);
  const std::shared_ptr<DeviceParams> own = device_type->make_params();
  own->read(in);
  params = own;
}

}  // namespace sim
