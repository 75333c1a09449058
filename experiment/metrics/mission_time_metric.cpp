// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/metric_registry.hpp"
#include "sim/director/condition_watch.hpp"
#include "sim/script/event_config.hpp"
#include "sim/world/world_editor.hpp"

namespace experiment {

namespace {

/// First time at which a condition holds.
class MissionTimeMetric final : public Metric {
 public:
  static constexpr const char* meaning = "time at which a condition first became true";
  static std::vector<sim::FigureKind> figures() {
    return {{"time_s", "s", "simulated time; none: it never became true"}};
  }
  struct Params final : sim::MetricParams {
    sim::Condition when;  ///< kind none: the vehicle is within radius_m of position_m
    sim::Vector3d position_m = sim::Vector3d::Zero();
    double radius_m = 0;
    void read(sim::ParamReader& in) override;
  };

  MissionTimeMetric(const MetricContext& context, const Params& params)
      : Metric(context),
        params_(params),
        world_(context.world),
        watch_(sim::make_watch(params.when, context.world.editor(), context.world.zones())) {}

  void after_step() override {
    if (time_s_ == time_s_) return;  // already known
    if (watch_ ? watch_->count_new(world_.editor()) > 0 : is_there()) time_s_ = sim::to_seconds(world_.now());
  }
  void add_figures(Figures& figures) const override { add(figures, "time_s", time_s_); }
  std::string why_none(const std::string&) const override { return "it did not happen"; }
  void visit_state(sim::StateArchive& archive, History) override {
    archive(time_s_);
    // A restored world may have built the observed entities again.
    if (watch_ && archive.restoring()) watch_ = sim::make_watch(params_.when, world_.editor(), world_.zones());
    if (watch_) watch_->visit_state(archive);
  }

 private:
  bool is_there() const {
    const sim::Vehicle* vehicle = world_.find_vehicle(params_.vehicle);
    return (vehicle->X_WV().translation() - params_.position_m).norm() <= params_.radius_m;
  }

  const Params& params_;
  sim::World& world_;
  std::unique_ptr<sim::ConditionWatch> watch_;  ///< null: it waits for a vehicle to reach a position
  double time_s_ = no_figure;
};

void MissionTimeMetric::Params::read(sim::ParamReader& in) {
  when = sim::parse_condition(in, "when");
  read_vehicle(in);
  in.read("position_m", position_m, sim::any_place(), "target position of the vehicle, instead of `when`");
  in.read("radius_m", radius_m, sim::above(0), "within this distance of `position_m`");
  if (in.describing()) return;
  if (when.kind == sim::Condition::Kind::fires) in.error("when", "a metric cannot wait for an event to fire");
  const bool all_of_place = in.has("vehicle") && in.has("position_m") && in.has("radius_m");
  const bool any_of_place = in.has("vehicle") || in.has("position_m") || in.has("radius_m");
  if (in.has("when") ? any_of_place : !all_of_place)
    in.error("needs either 'when', or 'vehicle', 'position_m' and 'radius_m'");
}

SHOAL_METRIC("mission_time", MissionTimeMetric);

}  // namespace

}  // namespace experiment
