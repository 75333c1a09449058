// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/touch_watch.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "sim/director/stage.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/vehicle/entities.hpp"

namespace sim {

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
