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

namespace tools {

/// Two that part and touch again within this time have not parted: bodies bounce.
inline constexpr double parted_after_s = 0.5;

/// Which vehicles hit which vehicles and objects, and how often.  Watching does not change the run.
///
/// Not counted: planes and terrain; the fixed things that a vehicle with wheels drives on (contacts from below); what a
/// vehicle stands on in its first 0.1 s.  A contact counts again when the two were apart for 0.5 s.
class FirstContacts {
 public:
  struct Contact {
    std::string first, second;  ///< a vehicle, and a vehicle or object
    double first_s = 0;
    std::int64_t count = 0;
    double last_s = 0;
    void visit_state(sim::StateArchive& archive) { archive(first, second, first_s, count, last_s); }
  };

  /// Gets a line such as `105.7 s: auv4 hits rock` at the first contact of a pair; at most 20 lines, and one that
  /// says that further ones are only counted.
  using Report = std::function<void(const std::string&)>;

  /// `world` must outlive this.  `say` may be empty.
  explicit FirstContacts(sim::World& world, Report report = {});
  /// Call after every step.
  void after_step();
  /// In the order of the first contacts.
  std::vector<Contact> all() const;
  void visit_state(sim::StateArchive& archive);

 private:
  using Pair = std::pair<std::int64_t, std::int64_t>;
  struct Group {
    std::int64_t who = 0;  ///< the number of a group is used again; this is not
    std::string name;
    bool is_vehicle = false;
    bool drives = false;  ///< a vehicle on wheels
    bool ground = false;  ///< planes and terrain
    bool fixed = false;
  };

  void choose_groups();
  void look_at(const sim::ContactReport& contact);
  /// `up`: the contact pushes `vehicle` upwards.
  bool rests_on(const Group& vehicle, const Group& other, bool up);
  void touch(const Group& a, const Group& b);
  void report(const Pair& pair, const Contact& contact);

  sim::World& world_;
  std::uint64_t generation_ = ~std::uint64_t{0};
  std::vector<Group> groups_;               ///< by group number
  std::map<std::int64_t, double> since_s_;  ///< when vehicles came that were not there at the start
  std::set<Pair> resting_;                  ///< a vehicle on what it stood on when it came
  std::map<Pair, Contact> contacts_;
  // Of the terminal, which does not go back.
  Report report_;
  std::set<std::pair<Pair, double>> said_;
};

/// Lines for the end of a run, ten at most; empty without contacts.
std::string contacts_text(const std::vector<FirstContacts::Contact>& contacts);

}  // namespace tools
