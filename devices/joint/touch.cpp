// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/touch.hpp"

#include <algorithm>
#include <stdexcept>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/touch_t.hpp"
#include "sim/config/message_text.hpp"

namespace devices {

void Touch::Params::read(sim::ParamReader& in) {
  contact.force_noise.set_key("force_noise");  // none: it names the stream of the contacts
  in.read_references("parts", contact.parts, "part",
                     "sensitive parts, as BODY/PART; none: all parts of the device's body");
  in.read("min_force_N", contact.min_force_N, sim::at_least(0), "contacts with a smaller force are not felt");
  in.read("full_force_N", full_force_N, sim::above(0), "sum of the forces of its contacts at pressure 1");
}

Touch::Touch(const Params& params, const sim::DeviceContext& context)
    : full_force_N_(params.full_force_N), contact_(params.contact, context) {}

void Touch::change(const Params& params) {
  full_force_N_ = params.full_force_N;
  contact_.change(params.contact);
}

void Touch::measure(const sim::SenseContext& context) {
  contact_.measure(context);
  double force_N = 0;
  for (const Bumper::Place& place : contact_.places()) force_N += place.force_N;
  const double before = pressure_;
  pressure_ = std::clamp(force_N / full_force_N_, pressed_, 1.0);
  is_update_ = pressure_ != before;
  used_ = used_ || is_update_;
}

void Touch::visit_state(sim::StateArchive& archive) {
  archive(contact_, pressed_, pressure_, is_update_, used_);
  archive.require(pressed_, 0, 1, "the pressure of a touch");
}

// Publishes shoal.touch_t when the pressure changes.
bool fill(const Touch& touch, shoal::touch_t& message) {
  if (!touch.is_update()) return false;
  message.touched = touch.pressure() > 0;
  message.pressure = touch.pressure();
  return true;
}

void TouchController::receive(sim::Time, std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::touch_t>(payload, shoal::Finite::required);
  if (!(message.pressure >= 0 && message.pressure <= 1))
    throw std::runtime_error("'pressure' must be >= 0 and <= 1, got " + sim::number_text(message.pressure));
  // Whoever only says that it is touched presses fully.
  touch_.press(message.touched && message.pressure == 0 ? 1 : message.pressure);
}

SHOAL_TRANSCEIVER("touch", Touch, shoal::touch_t, TouchController);

}  // namespace devices
