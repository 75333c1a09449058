// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "experiment/score/metric_registry.hpp"
#include "sim/base/math.hpp"

namespace experiment {

namespace {

/// Below this speed the course of a leader is only noise, and the last one counts.
constexpr double course_min_mps = 0.05;

/// Horizontal distance of a vehicle from its place in a formation.
class FormationErrorMetric final : public Metric {
 public:
  static constexpr const char* meaning = "horizontal distance of a vehicle from its place beside a leader";
  static std::vector<sim::FigureKind> figures() {
    return {{"rms_m", "m", "root mean square of the distance from the place"},
            {"max_m", "m", "largest distance from the place"},
            {"final_m", "m", "distance from the place at the end"}};
  }
  struct Params final : sim::MetricParams {
    std::string leader;
    std::vector<double> offset_m;
    void read(sim::ParamReader& in) override {
      in.require("vehicle");
      in.require("leader");
      in.require("offset_m");
      read_vehicle(in);
      read_known_name(in, "leader", leader, "vehicle", "vehicle that leads the formation");
      in.read("offset_m", offset_m, sim::any_place(), "place, ahead and to the left by the true course of the leader");
      if (!in.describing() && in.has("offset_m") && offset_m.size() != 2)
        in.error("offset_m", "'offset_m' must be 2 numbers, got " + std::to_string(offset_m.size()));
      read_from_s(in);
    }
  };

  FormationErrorMetric(const MetricContext& context, const Params& params)
      : Metric(context), params_(params), world_(context.world) {}

  void after_step() override {
    const sim::Vehicle* vehicle = world_.find_vehicle(params_.vehicle);
    const sim::Vehicle* leader = world_.find_vehicle(params_.leader);
    if (vehicle == nullptr || leader == nullptr) return;
    const sim::Vector3d v_W = leader->bodies().front().second->v_WB_W();
    // At rest the course is undefined, so the last one is kept.
    if (std::hypot(v_W.x(), v_W.y()) > course_min_mps)
      course_rad_ = std::atan2(v_W.y(), v_W.x());
    else if (std::isnan(course_rad_))
      course_rad_ = sim::yaw_of(leader->X_WV().linear());
    if (sim::to_seconds(world_.now()) < params_.from_s) return;
    const double c = std::cos(course_rad_), s = std::sin(course_rad_);
    const double ahead_m = params_.offset_m[0], left_m = params_.offset_m[1];
    const sim::Vector3d place_W =
        leader->X_WV().translation() + sim::Vector3d(c * ahead_m - s * left_m, s * ahead_m + c * left_m, 0);
    final_m_ = (vehicle->X_WV().translation() - place_W).head<2>().norm();
    max_m_ = std::max(max_m_, final_m_);
    sum_m2_ += final_m_ * final_m_;
    ++count_;
  }

  void visit_state(sim::StateArchive& archive, History) override {
    archive(count_, sum_m2_, max_m_, final_m_, course_rad_);
  }
  std::string why_none(const std::string&) const override { return "nothing was measured"; }

  void add_figures(Figures& figures) const override {
    const bool any = count_ > 0;
    add(figures, "rms_m", any ? std::sqrt(sum_m2_ / static_cast<double>(count_)) : no_figure);
    add(figures, "max_m", any ? max_m_ : no_figure);
    add(figures, "final_m", any ? final_m_ : no_figure);
  }

 private:
  const Params& params_;
  const sim::World& world_;
  std::int64_t count_ = 0;
  double sum_m2_ = 0, max_m_ = 0, final_m_ = 0;
  double course_rad_ = no_figure;
};

SHOAL_METRIC("formation_error", FormationErrorMetric);

}  // namespace

}  // namespace experiment
