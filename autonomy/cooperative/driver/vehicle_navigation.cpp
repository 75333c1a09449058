// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/vehicle_navigation.hpp"

#include <stdexcept>
#include <string>

namespace navigation {

VehicleNavigation::VehicleNavigation(std::shared_ptr<const NavTeam> team, int own, const Algorithm& algorithm,
                                     const NavOptions& options)
    : reports_(team, own, options.start, options.sound, seconds(options.period_us)),
      algorithm_(&algorithm),
      options_(options) {
  if (!algorithm.make)
    throw std::invalid_argument(algorithm.name + " has the measurements of all vehicles: it runs with --log only");
  // A trial, so that an algorithm which cannot work is refused before the run.
  Setup trial;
  trial.team = team->members();
  trial.own = own;
  algorithm.make()->start(completed(trial, options));
}

Setup completed(Setup setup, const NavOptions& options) {
  setup.gate = options.gate;
  setup.payload_bytes = payload_room(options.frame_bytes);
  return setup;
}

Setup VehicleNavigation::setup() const {
  return completed(*reports_.setup(), options_);
}

void VehicleNavigation::on_range(const shoal::acoustic_received_t& packet, const Bytes& frame) {
  const auto decoded = decode_frame(frame, packet.sent_utime);
  if (!navigator_ || !decoded) return;
  if (const auto seen = reports_.bearing_by(packet, *decoded)) navigator_->add(*seen);
  const auto event = reports_.range_event(packet, *decoded);
  if (event && navigator_->add(*event)) ++ranges_;
}

std::optional<Bytes> VehicleNavigation::make_payload() {
  if (!navigator_) return std::nullopt;
  const Time time = reports_.transmission();
  const std::size_t room = payload_room(options_.frame_bytes);
  Bytes payload = navigator_->make_payload(time, room);
  if (payload.size() > room)
    throw std::invalid_argument(algorithm_->name + " said " + std::to_string(payload.size()) +
                                " bytes, its frames have room for " + std::to_string(room));
  return encode_frame(reports_.frame(time, std::move(payload)), options_.frame_bytes);
}

std::optional<Estimate> VehicleNavigation::estimate() {
  if (!navigator_) return std::nullopt;
  return navigator_->now(reports_.time());
}

}  // namespace navigation
