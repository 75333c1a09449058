// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <utility>

#include "experiment/score/first_contacts.hpp"
#include "experiment/score/metric_registry.hpp"
#include "sim/script/action.hpp"

namespace experiment {

namespace {

/// Contacts that started between vehicles, or a vehicle and an object.
class CollisionMetric final : public Metric {
 public:
  static constexpr const char* meaning = "number of contacts";
  static std::vector<sim::FigureKind> figures() {
    return {{"count", "contacts", "contacts; counted again after the two were apart for more than 0.5 s", true},
            {"first_s", "s", "simulated time of the first one; none: there was no contact"}};
  }
  struct Params final : sim::MetricParams {
    std::string with;  ///< vehicle or object; empty: all except planes
    void read(sim::ParamReader& in) override {
      read_vehicle(in);
      read_known_name(in, "with", with, sim::movable_kind, "with this one alone; unset: with all, but planes");
      read_from_s(in);
    }
  };

  CollisionMetric(const MetricContext& context, const Params& params)
      : Metric(context), params_(params), world_(context.world) {}

  void after_step() override {
    if (generation_ != world_.generation()) choose_groups();
    const double now_s = sim::to_seconds(world_.now());
    const auto parts = world_.physics().parts();
    for (const sim::ContactReport& contact : world_.physics().contacts()) {
      const int a = parts[static_cast<std::size_t>(contact.parts[0])].group;
      const int b = parts[static_cast<std::size_t>(contact.parts[1])].group;
      if (a != b && (matches(a, b) || matches(b, a))) touch(std::minmax(whose_.at(a), whose_.at(b)), now_s);
    }
  }

  void visit_state(sim::StateArchive& archive, History) override {
    archive(last_touch_s_, count_, first_s_);
    // Immediately, not after the next step: a restored world does not report contacts yet.
    if (archive.restoring()) choose_groups();
  }

  std::string why_none(const std::string&) const override { return "nothing touched" + since_from_s(); }

  void add_figures(Figures& figures) const override {
    add(figures, "count", static_cast<double>(count_));
    add(figures, "first_s", first_s_);
  }

 private:
  using Pair = std::pair<std::int64_t, std::int64_t>;
  struct Group {
    bool subject = false, object = false;
  };

  void choose_groups() {
    generation_ = world_.generation();
    groups_.clear();
    whose_.clear();
    for (const auto& vehicle : world_.vehicles()) {
      const bool subject = params_.vehicle.empty() || params_.vehicle == vehicle->name();
      add_group(vehicle->group(), 2 * static_cast<std::int64_t>(vehicle->number()),
                {subject, params_.with.empty() || params_.with == vehicle->name()});
      if (subject) world_.physics().watch_contacts(vehicle->group());
    }
    for (const auto& [name, object] : world_.objects()) {
      // Standing on the ground is not a collision.
      const auto no_plane = [](const sim::PartConfig& part) { return part.shape != sim::PartShape::plane; };
      const bool planes = !object.config->any_part(no_plane);
      add_group(object.group(), 2 * object.number + 1, {false, params_.with.empty() ? !planes : params_.with == name});
    }
  }

  /// The number of a group may be reused; `who` is unique.
  void add_group(int group, std::int64_t who, Group role) {
    groups_[group] = role;
    whose_[group] = who;
  }

  bool matches(int a, int b) const {
    const auto subject = groups_.find(a);
    const auto object = groups_.find(b);
    return subject != groups_.end() && object != groups_.end() && subject->second.subject && object->second.object;
  }

  void touch(const Pair& pair, double now_s) {
    const auto [last, fresh] = last_touch_s_.emplace(pair, now_s);
    const bool begins = fresh || now_s - last->second > parted_after_s;
    last->second = now_s;
    if (!begins || now_s < params_.from_s) return;
    if (count_++ == 0) first_s_ = now_s;
  }

  const Params& params_;
  sim::World& world_;
  std::uint64_t generation_ = ~std::uint64_t{0};
  std::map<int, Group> groups_;
  std::map<int, std::int64_t> whose_;
  std::map<Pair, double> last_touch_s_;
  std::int64_t count_ = 0;
  double first_s_ = no_figure;
};

SHOAL_METRIC("collisions", CollisionMetric);

}  // namespace

}  // namespace experiment
