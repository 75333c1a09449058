// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiment/score/metric_registry.hpp"

namespace experiment {

namespace {

constexpr double fallen_rad = std::numbers::pi / 4;

/// Tilt of the first body of a vehicle.
class TiltMetric final : public Metric {
 public:
  static constexpr const char* meaning = "tilt of the first body of a vehicle";
  static std::vector<sim::FigureKind> figures() {
    return {{"max_deg", "deg", "largest angle between its z axis and the vertical"},
            {"pitch_std_deg", "deg", "standard deviation of the pitch"},
            {"pitch_mean_deg", "deg", "mean pitch, positive with the nose down"},
            {"fell_s", "s", "simulated time when it tilted more than 45 degrees; none: it did not fall"}};
  }
  struct Params final : sim::MetricParams {
    void read(sim::ParamReader& in) override {
      in.require("vehicle");
      read_vehicle(in);
      read_from_s(in);
    }
  };

  TiltMetric(const MetricContext& context, const Params& params)
      : Metric(context), params_(params), world_(context.world) {}

  void after_step() override {
    const double now_s = sim::to_seconds(world_.now());
    const sim::Vehicle* vehicle = world_.find_vehicle(params_.vehicle);
    if (vehicle == nullptr || now_s < params_.from_s) return;
    const sim::Vector3d up_B = vehicle->bodies().front().second->X_WB().linear().row(2).transpose();
    const double forward_rad = std::atan2(-up_B.x(), std::hypot(up_B.y(), up_B.z()));
    const double tilt_rad = std::acos(std::clamp(up_B.z(), -1.0, 1.0));
    // Incremental mean and variance (Welford 1962), which avoid the cancellation of a sum of squares.
    const double off_rad = forward_rad - mean_rad_;
    mean_rad_ += off_rad / static_cast<double>(++count_);
    square_rad2_ += off_rad * (forward_rad - mean_rad_);
    max_rad_ = std::max(max_rad_, tilt_rad);
    if (tilt_rad > fallen_rad && std::isnan(fell_s_)) fell_s_ = now_s;
  }

  void visit_state(sim::StateArchive& archive, History) override {
    archive(count_, mean_rad_, square_rad2_, max_rad_, fell_s_);
  }
  std::string why_none(const std::string& figure) const override {
    return figure == "fell_s" && count_ > 0 ? "it did not fall" : "the vehicle did not exist";
  }

  void add_figures(Figures& figures) const override {
    constexpr double degrees = 180 / std::numbers::pi;
    const bool any = count_ > 0;
    add(figures, "pitch_mean_deg", any ? mean_rad_ * degrees : no_figure);
    add(figures, "pitch_std_deg", any ? std::sqrt(square_rad2_ / static_cast<double>(count_)) * degrees : no_figure);
    add(figures, "max_deg", any ? max_rad_ * degrees : no_figure);
    add(figures, "fell_s", fell_s_);
  }

 private:
  const Params& params_;
  const sim::World& world_;
  std::int64_t count_ = 0;
  double mean_rad_ = 0, square_rad2_ = 0, max_rad_ = 0;
  double fell_s_ = no_figure;
};

SHOAL_METRIC("tilt", TiltMetric);

}  // namespace

}  // namespace experiment
