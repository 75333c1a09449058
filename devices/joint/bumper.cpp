// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/bumper.hpp"

#include <algorithm>

#include "devices/joint/joint_of_device.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/bumper_t.hpp"

namespace devices {

void Bumper::Params::read(sim::ParamReader& in) {
  in.read_references("parts", parts, "part", "sensitive parts, as BODY/PART; none: all parts of the device's body");
  in.read("min_force_N", min_force_N, sim::at_least(0), "contacts with a smaller force are not reported");
  in.read_choice("report", report, {{"changes", When::changes}, {"always", When::always}},
                 "changes: at the first sample and when a touch begins or ends; always: at every sample");
  in.read("force_noise", force_noise, "error of the force at each place, N");
}

Bumper::Bumper(const Params& params, const sim::DeviceContext& context)
    : params_(params), physics_(context.host.physics), vehicle_(context.vehicle), force_noise_(context, params) {
  const sim::PhysicsWorld& physics = context.world.physics();
  for (const std::string& name : params.parts)
    if (const auto part = physics.find_part(vehicle_.group(), name)) parts_.push_back(*part);
  if (params.parts.empty())
    for (std::size_t i = 0; i < physics.parts().size(); ++i)
      if (physics.parts()[i].group == vehicle_.group() && physics.parts()[i].body == context.body.number())
        parts_.push_back(static_cast<int>(i));
  if (parts_.empty()) refuse(context, "no part of it can touch anything");
  // In order, for a binary search at each contact.
  std::sort(parts_.begin(), parts_.end());
  physics_.watch_contacts(vehicle_.group());
}

Bumper::~Bumper() {
  physics_.unwatch_contacts(vehicle_.group());
}

bool Bumper::is_own(int part) const {
  return std::binary_search(parts_.begin(), parts_.end(), part);
}

void Bumper::add_place(const sim::ContactReport& contact, int own, std::vector<Place>& places) const {
  const auto parts = physics_.parts();
  const sim::Pose X_VW = vehicle_.X_WV().inverse();
  const sim::Vector3d normal_V = X_VW.linear() * contact.normal_W;
  const sim::PartInfo& other = parts[static_cast<std::size_t>(contact.parts[1 - own])];
  // Part names start with the name of the vehicle.
  const std::string part = parts[static_cast<std::size_t>(contact.parts[own])].name.substr(vehicle_.name().size() + 1);
  places.push_back({part, physics_.group_name(other.group), X_VW * contact.position_W,
                    own == 0 ? normal_V : sim::Vector3d(-normal_V), contact.force_W_N.norm()});
}

void Bumper::look() {
  std::vector<Place> places;
  double force_N = 0;
  for (const sim::ContactReport& contact : physics_.contacts()) {
    const int own = is_own(contact.parts[0]) ? 0 : is_own(contact.parts[1]) ? 1 : -1;
    if (own < 0 || contact.force_W_N.norm() < params_.min_force_N) continue;
    add_place(contact, own, places);
    force_N += places.back().force_N;
  }
  looked_ = true;
  // Between two samples the strongest touch counts: a short bump would be missed at the rate of the device.
  if (places.empty() || force_N <= max_force_N_) return;
  max_force_N_ = force_N;
  pressed_ = std::move(places);
}

void Bumper::act(const sim::ActContext&) {
  if (!looked_) look();
  looked_ = false;
}

void Bumper::measure(const sim::SenseContext&) {
  if (!looked_) look();
  const bool touching = !pressed_.empty();
  changed_ = touching != touching_ || !sampled_;
  sampled_ = true;
  touching_ = touching;
  places_ = std::move(pressed_);
  pressed_.clear();
  max_force_N_ = -1;
}

void Bumper::disturb(double dt_s, sim::Random& random) {
  if (places_.empty()) return;
  std::vector<double> forces_N;
  for (const Place& place : places_) forces_N.push_back(place.force_N);
  force_noise_.apply(std::span<double>(forces_N), dt_s, random);
  for (std::size_t i = 0; i < places_.size(); ++i) places_[i].force_N = std::max(forces_N[i], 0.0);
}

void Bumper::change(const Params& params) {
  params_.min_force_N = params.min_force_N;
  params_.report = params.report;
}

// Publishes shoal.bumper_t: at the first sample and when a contact begins or ends, or at every sample.  A lost report
// of a change is not repeated.
bool fill(const Bumper& bumper, shoal::bumper_t& message) {
  if (!bumper.is_update()) return false;
  message.touching = bumper.touching();
  message.count = static_cast<std::int32_t>(bumper.places().size());
  for (const Bumper::Place& place : bumper.places()) {
    message.part.push_back(place.part);
    message.other.push_back(place.other);
    message.position_m.emplace_back(place.position_V.begin(), place.position_V.end());
    message.normal.emplace_back(place.normal_V.begin(), place.normal_V.end());
    message.force_N.push_back(place.force_N);
  }
  return true;
}

SHOAL_SENSOR("bumper", Bumper, shoal::bumper_t);

}  // namespace devices
