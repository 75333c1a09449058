// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/condition_watch.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "sim/director/stage.hpp"
#include "sim/geometry/zone.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/vehicle/entities.hpp"

namespace sim {
namespace {

/// Watch of a condition that is true or false for each vehicle.
class VehicleWatch : public ConditionWatch {
 public:
  explicit VehicleWatch(std::string vehicle) : vehicle_(std::move(vehicle)) {}

  int count_new(Stage& stage) final {
    int count = 0;
    const auto look_at = [&](const Vehicle& vehicle) {
      const auto number = static_cast<std::size_t>(vehicle.number());
      // Vehicles that are spawned later have larger numbers; their state begins as unknown.
      if (number >= states_.size()) states_.resize(number + 1, unknown);
      const State now = holds(vehicle) ? yes : no;
      if (fires(states_[number], now)) ++count;
      states_[number] = now;
    };
    if (vehicle_ == "any") {
      for (const auto& vehicle : stage.entities().vehicles()) look_at(*vehicle);
    } else if (const Vehicle* vehicle = stage.entities().find_vehicle(vehicle_)) {
      look_at(*vehicle);
    }
    return count;
  }

  void visit_state(StateArchive& archive) final { archive(states_); }

 protected:
  enum State : signed char { unknown, no, yes };
  virtual bool holds(const Vehicle& vehicle) const = 0;
  virtual bool fires(State before, State now) const { return before != yes && now == yes; }

 private:
  std::string vehicle_;
  std::vector<State> states_;  ///< by vehicle number
};

class ZoneWatch final : public VehicleWatch {
 public:
  ZoneWatch(const Condition& condition, const Zones& zones)
      : VehicleWatch(condition.subject),
        kind_(condition.kind),
        zone_(zones.all()[static_cast<std::size_t>(zones.index_of(condition.object))]) {}

 private:
  bool holds(const Vehicle& vehicle) const override { return zone_.contains(vehicle.X_WV().translation()); }
  bool fires(State before, State now) const override {
    if (kind_ == Condition::Kind::leaves) return before == yes && now == no;
    if (kind_ == Condition::Kind::enters) return before == no && now == yes;
    return before != yes && now == yes;
  }

  Condition::Kind kind_;
  const Zone& zone_;
};

class SpeedWatch final : public VehicleWatch {
 public:
  explicit SpeedWatch(const Condition& condition) : VehicleWatch(condition.subject), speed_mps_(condition.speed_mps) {}

 private:
  bool holds(const Vehicle& vehicle) const override { return vehicle.base().v_WB_W().norm() > speed_mps_; }
  double speed_mps_;
};

class MessageWatch final : public ConditionWatch {
 public:
  MessageWatch(const Condition& condition, Stage& stage)
      : mailbox_(
            stage.bus_of_channel(condition.subject).open_mailbox(condition.subject, Bus::default_mailbox_capacity)) {}
  int count_new(Stage&) override {
    int count = 0;
    while (mailbox_->take()) ++count;
    return count;
  }
  void visit_state(StateArchive& archive) override {
    std::vector<Message> unread = mailbox_->unread();
    archive.unhashed(unread);
    if (archive.restoring()) mailbox_->set_unread(std::move(unread));
  }

 private:
  std::unique_ptr<Mailbox> mailbox_;
};

}  // namespace

std::unique_ptr<ConditionWatch> make_watch(const Condition& condition, Stage& stage, const Zones& zones) {
  switch (condition.kind) {
    case Condition::Kind::enters:
    case Condition::Kind::leaves:
    case Condition::Kind::inside:
      return std::make_unique<ZoneWatch>(condition, zones);
    case Condition::Kind::faster:
      return std::make_unique<SpeedWatch>(condition);
    case Condition::Kind::message:
      return std::make_unique<MessageWatch>(condition, stage);
    case Condition::Kind::touches:
      return make_touch_watch(condition, stage);
    // Fired by events and not by watching the world.
    case Condition::Kind::none:
    case Condition::Kind::fires:
      break;
  }
  return nullptr;
}

namespace {

class TouchWatch final : public ConditionWatch {
 public:
  explicit TouchWatch(const Condition& condition) : condition_(condition) {}

  int count_new(Stage& stage) override {
    if (generation_ != stage.entities().generation()) choose_groups(stage);
    const auto parts = stage.physics().parts();
    // A pair counts once, however many contacts it has and in whichever order ODE reports it.
    std::set<std::pair<std::int64_t, std::int64_t>> touching;
    for (const ContactReport& contact : stage.physics().contacts()) {
      const int a = parts[static_cast<std::size_t>(contact.parts[0])].group;
      const int b = parts[static_cast<std::size_t>(contact.parts[1])].group;
      if (matches(a, b) || matches(b, a)) touching.insert(std::minmax(whose_.at(a), whose_.at(b)));
    }
    const auto is_new = [&](const auto& pair) { return !touching_.contains(pair); };
    const auto count = std::count_if(touching.begin(), touching.end(), is_new);
    touching_ = std::move(touching);
    return static_cast<int>(count);
  }

  void visit_state(StateArchive& archive) override { archive(touching_); }

 private:
  void choose_groups(Stage& stage) {
    generation_ = stage.entities().generation();
    first_.clear();
    second_.clear();
    whose_.clear();
    for (const auto& vehicle : stage.entities().vehicles()) {
      whose_[vehicle->group()] = 2 * static_cast<std::int64_t>(vehicle->number());
      consider(vehicle->name(), vehicle->group(), true);
    }
    for (const auto& [name, object] : stage.entities().objects()) {
      whose_[object.group()] = 2 * object.number + 1;
      const auto no_plane = [](const PartConfig& part) { return part.shape != PartShape::plane; };
      consider(name, object.group(), object.config->any_part(no_plane));
    }
    // A new group may have the number of a removed one, whose watch ended with it; watching twice is harmless.
    const bool any_first = condition_.subject == "any";
    for (const int group : any_first ? second_ : first_) stage.physics().watch_contacts(group);
  }

  void consider(const std::string& name, int group, bool any) {
    if (condition_.subject == "any" ? any : condition_.subject == name) first_.insert(group);
    if (condition_.object == "any" ? any : condition_.object == name) second_.insert(group);
  }

  bool matches(int a, int b) const { return a != b && first_.contains(a) && second_.contains(b); }

  const Condition& condition_;
  std::uint64_t generation_ = ~std::uint64_t{0};
  std::set<int> first_, second_;
  // The number of a group is reused when an entity replaces a removed one: that is another contact.
  std::map<int, std::int64_t> whose_;
  std::set<std::pair<std::int64_t, std::int64_t>> touching_;
};

}  // namespace

std::unique_ptr<ConditionWatch> make_touch_watch(const Condition& condition, Stage&) {
  return std::make_unique<TouchWatch>(condition);
}

}  // namespace sim
