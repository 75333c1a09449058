// SPDX-License-Identifier: BSD-3-Clause
#include "devices/power/estop.hpp"

#include <algorithm>

#include "devices/joint/bumper.hpp"
#include "devices/joint/joint_of_device.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/estop_t.hpp"
#include "shoal/message_codec.hpp"
#include "sim/vehicle/mounted_device.hpp"

namespace devices {

void EmergencyStop::Params::read(sim::ParamReader& in) {
  in.read("engaged_at_start", engaged_at_start, "the vehicle starts stopped");
  in.read("stops_on_touch", stops_on_touch, "name of a bumper of the vehicle that engages it; unset: none");
}

EmergencyStop::EmergencyStop(const Params& params, const sim::DeviceContext& context)
    : params_(params), vehicle_(context.vehicle) {
  if (params.engaged_at_start) set_engaged(true);
  if (params.stops_on_touch.empty()) return;
  // The bumper may follow it in the file: at this point only its configuration exists.
  const auto& devices = vehicle_.config().devices;
  const bool known = std::any_of(devices.begin(), devices.end(), [&](const sim::DeviceConfig& device) {
    return device.name == params.stops_on_touch && device.type == "bumper";
  });
  if (!known) refuse(context, "'stops_on_touch' names no bumper '" + params.stops_on_touch + "'");
}

void EmergencyStop::act(const sim::ActContext&) {
  if (params_.stops_on_touch.empty()) return;
  if (bumper_ == nullptr) bumper_ = dynamic_cast<const Bumper*>(vehicle_.find_device(params_.stops_on_touch)->sensor());
  const bool touching = bumper_->touching();
  if (touching && !touched_) set_engaged(true);
  touched_ = touching;
}

void EmergencyStop::measure(const sim::SenseContext&) {
  engaged_ = vehicle_.systems().estopped;
}

void EmergencyStop::set_engaged(bool engaged) {
  vehicle_.systems().estopped = engaged;
}

void fill(const EmergencyStop& estop, shoal::estop_t& message) {
  message.engaged = estop.engaged();
}

void EmergencyStopController::receive(sim::Time, std::span<const std::byte> payload) {
  estop_.set_engaged(shoal::decode<shoal::estop_t>(payload, shoal::Finite::required).engaged != 0);
}

SHOAL_TRANSCEIVER("estop", EmergencyStop, shoal::estop_t, EmergencyStopController);

}  // namespace devices
