// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/first_contacts.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "devices/drive/wheel_geometry.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace experiment {

namespace {

/// Time for a vehicle to settle on its initial support.
constexpr double settled_after_s = 0.1;
/// A contact whose normal is steeper than 45 degrees is a support.
constexpr double carries = 0.7;

constexpr std::size_t max_lines = 20;

bool is_ground(const sim::ObjectConfig& object) {
  return !object.any_part([](const sim::PartConfig& part) { return sim::shape_info(part.shape).solid; });
}

bool has_wheels(const sim::VehicleConfig& vehicle) {
  return std::any_of(vehicle.joints.begin(), vehicle.joints.end(), [&](const sim::JointConfig& joint) {
    return sim::joint_info(joint.type).carries_a_wheel && devices::wheel_geometry(vehicle, joint.name).rolls();
  });
}

/// Returns whether a vehicle is in the water, at least in part.
bool is_in_water(const sim::World& world, const sim::Vehicle& vehicle) {
  if (world.medium().in_water(vehicle.base().p_WB())) return true;
  const auto parts = world.physics().parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].group != vehicle.group()) continue;
    const auto bounds = world.physics().bounds_W(static_cast<int>(i));
    if (bounds && world.medium().in_water({bounds->center().x(), bounds->center().y(), bounds->min().z()})) return true;
  }
  return false;
}

}  // namespace

FirstContacts::FirstContacts(sim::World& world, Report report) : world_(world), report_(std::move(report)) {
  choose_groups();
}

void FirstContacts::choose_groups() {
  generation_ = world_.generation();
  groups_.clear();
  const auto put = [this](int group, Group entry) {
    const auto at = static_cast<std::size_t>(group);
    if (groups_.size() <= at) groups_.resize(at + 1);
    groups_[at] = std::move(entry);
  };
  struct Kind {
    bool drives, swims, may_float;
  };
  std::map<const sim::VehicleConfig*, Kind> kinds;  // for lookup only
  for (const auto& vehicle : world_.vehicles()) {
    const auto [kind, fresh] = kinds.try_emplace(&vehicle->config());
    if (fresh) {
      kind->second.drives = has_wheels(vehicle->config());
      const bool is_craft = world_.medium().has_water() && !kind->second.drives;
      kind->second.swims = is_craft && vehicle->config().has_coefficients();
      kind->second.may_float = is_craft && !kind->second.swims && vehicle->config().joints.empty();
    }
    const std::int64_t who = 2 * static_cast<std::int64_t>(vehicle->number());
    const auto [start, came] = starts_.try_emplace(who, Start{sim::to_seconds(world_.now()), false});
    if (came) start->second.in_water = kind->second.may_float && is_in_water(world_, *vehicle);
    const bool swims = kind->second.swims || start->second.in_water;
    put(vehicle->group(), {who, vehicle->name(), true, kind->second.drives, false, false, swims});
    world_.physics().watch_contacts(vehicle->group());
  }
  for (const auto& [name, object] : world_.objects())
    put(object.group(),
        {2 * object.number + 1, name, false, false, is_ground(*object.config), object.config->fixed, false});
}

void FirstContacts::after_step() {
  if (generation_ != world_.generation()) choose_groups();
  for (const sim::ContactReport& contact : world_.physics().contacts()) look_at(contact);
}

void FirstContacts::look_at(const sim::ContactReport& contact) {
  const auto group_of = [&](int part) {
    return static_cast<std::size_t>(world_.physics().parts()[static_cast<std::size_t>(part)].group);
  };
  const std::size_t first = group_of(contact.parts[0]), second = group_of(contact.parts[1]);
  if (first == second || std::max(first, second) >= groups_.size()) return;
  const Group &a = groups_[first], &b = groups_[second];
  // Standing on the ground is normal, but not for a craft that swims.
  if ((a.ground && !b.swims) || (b.ground && !a.swims)) return;
  const bool up = contact.normal_W.z() > carries, down = contact.normal_W.z() < -carries;
  if (rests_on(a, b, up) || rests_on(b, a, down)) return;
  touch(a, b);
}

bool FirstContacts::rests_on(const Group& vehicle, const Group& other, bool up) {
  if (!vehicle.is_vehicle) return false;
  if (up && vehicle.drives && other.fixed) return true;
  const Pair pair{vehicle.who, other.who};
  const auto start = starts_.find(vehicle.who);
  const double since_s = start == starts_.end() ? 0 : start->second.time_s;
  if (up && sim::to_seconds(world_.now()) <= since_s + settled_after_s) resting_.insert(pair);
  return !resting_.empty() && resting_.contains(pair);
}

void FirstContacts::touch(const Group& a, const Group& b) {
  const double now_s = sim::to_seconds(world_.now());
  const Pair pair = std::minmax(a.who, b.who);
  const auto [at, fresh] = contacts_.try_emplace(pair);
  Contact& contact = at->second;
  if (fresh) {
    const bool in_order = a.is_vehicle && (!b.is_vehicle || a.who < b.who);
    contact = {in_order ? a.name : b.name, in_order ? b.name : a.name, now_s, 0, now_s};
  }
  // A contact flickers from step to step; apart for some time it counts as a new one.
  if (fresh || now_s - contact.last_s > parted_after_s) ++contact.count;
  contact.last_s = now_s;
  if (fresh) report(pair, contact);
}

/// Reports a contact once, even when the run is rewound and repeats it.
void FirstContacts::report(const Pair& pair, const Contact& contact) {
  if (!report_ || reported_.size() > max_lines || !reported_.emplace(pair, contact.first_s).second) return;
  if (reported_.size() > max_lines)
    report_("further first contacts are only counted; see the summary");
  else
    report_(fmt::format("{:.1f} s: {} hits {}", contact.first_s, contact.first, contact.second));
}

std::vector<FirstContacts::Contact> FirstContacts::all() const {
  std::vector<Contact> all;
  for (const auto& [pair, contact] : contacts_) all.push_back(contact);
  std::stable_sort(all.begin(), all.end(), [](const Contact& a, const Contact& b) { return a.first_s < b.first_s; });
  return all;
}

void FirstContacts::visit_state(sim::StateArchive& archive) {
  archive(starts_, resting_, contacts_);
  // Immediately, not after the next step: a restored world does not report contacts yet.
  if (archive.restoring()) choose_groups();
}

std::string contacts_text(const std::vector<FirstContacts::Contact>& contacts) {
  constexpr std::size_t max = 10;
  std::string text;
  for (std::size_t i = 0; i < std::min(max, contacts.size()); ++i)
    text += fmt::format("  {} hit {}: {} {}, first at {:.2f} s\n", contacts[i].first, contacts[i].second,
                        contacts[i].count, contacts[i].count == 1 ? "contact" : "contacts", contacts[i].first_s);
  if (contacts.size() > max) text += fmt::format("  and {} more pairs hit each other\n", contacts.size() - max);
  return text;
}

}  // namespace experiment
