// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/state/state_archive.hpp"
#include "sim/world/world.hpp"

namespace experiment {

/// Two bodies that separate and touch again within this time count as still in contact, because bodies bounce.
inline constexpr double parted_after_s = 0.5;

/// Counter of the contacts of vehicles with vehicles and objects.  Counting does not change the run.
///
/// Not counted: planes and terrain, except by craft that start free of them (without wheels, in a world with water;
/// with hydrodynamic coefficients, or without joints and in the water at their start); the fixed objects that a vehicle
/// with wheels drives on (contacts from below); the support of a vehicle in its first 0.1 s.  A contact counts again
/// after a separation of 0.5 s.
class FirstContacts {
 public:
  struct Contact {
    std::string first, second;  ///< a vehicle, and a vehicle or object
    double first_s = 0;
    std::int64_t count = 0;
    double last_s = 0;
    void visit_state(sim::StateArchive& archive) { archive(first, second, first_s, count, last_s); }
  };

  /// Receives a line such as `105.7 s: auv4 hits rock` at the first contact of a pair; at most 20 lines, and one that
  /// announces that further ones are only counted.
  using Report = std::function<void(const std::string&)>;

  /// `world` must outlive this.  `report` may be empty.
  explicit FirstContacts(sim::World& world, Report report = {});
  /// Call after every step.
  void after_step();
  /// Returns the contacts in the order of the first ones.
  std::vector<Contact> all() const;
  void visit_state(sim::StateArchive& archive);

 private:
  using Pair = std::pair<std::int64_t, std::int64_t>;
  struct Start {
    double time_s = 0;
    bool in_water = false;  ///< of a vehicle without wheels, joints and coefficients
    void visit_state(sim::StateArchive& archive) { archive(time_s, in_water); }
  };
  struct Group {
    std::int64_t who = 0;  ///< unique; the number of a group may be reused
    std::string name;
    bool is_vehicle = false;
    bool drives = false;  ///< a vehicle on wheels
    bool ground = false;  ///< planes and terrain
    bool fixed = false;
    bool swims = false;  ///< a craft
  };

  void choose_groups();
  void look_at(const sim::ContactReport& contact);
  /// `up`: the contact pushes `vehicle` upwards.
  bool rests_on(const Group& vehicle, const Group& other, bool up);
  void touch(const Group& a, const Group& b);
  void report(const Pair& pair, const Contact& contact);

  sim::World& world_;
  std::uint64_t generation_ = ~std::uint64_t{0};
  std::vector<Group> groups_;             ///< by group number
  std::map<std::int64_t, Start> starts_;  ///< of vehicles
  std::set<Pair> resting_;                ///< pairs of a vehicle and its support at its start
  std::map<Pair, Contact> contacts_;
  // Output on the terminal, which is not rewound.
  Report report_;
  std::set<std::pair<Pair, double>> reported_;
};

/// Returns lines for the end of a run, ten at most; empty without contacts.
std::string contacts_text(const std::vector<FirstContacts::Contact>& contacts);

}  // namespace experiment
