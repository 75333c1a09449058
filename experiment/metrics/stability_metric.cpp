// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <limits>

#include "experiment/score/metric_registry.hpp"
#include "experiment/score/support.hpp"

namespace experiment {

namespace {

/// Least, mean and present margins of a standing vehicle.
class StabilityMetric final : public Metric {
 public:
  static constexpr const char* meaning = "how safely a vehicle stands on its contacts";
  static std::vector<sim::FigureKind> figures() {
    return {
        {"static_min_m", "m", "smallest distance of the center of mass, seen from above, to the edge of its support"},
        {"static_mean_m", "m", "mean of this distance"},
        {"zmp_min_m", "m", "smallest distance of the center of pressure (ZMP) to the edge; 0: it is about to tip"},
        {"capture_min_m", "m",
         "smallest distance of the capture point to the edge; negative: a pendulum of constant height would fall "
         "without a step"},
        {"nesm_min_m", "m", "smallest height that the center of mass must rise to tip over"},
        {"carried_share", "1", "share of the time with three or more contacts"},
        {"static_m", "m", "distance of the center of mass to the edge at present; null: fewer than three contacts"},
        {"zmp_m", "m", "the same for the center of pressure"},
        {"capture_m", "m", "the same for the capture point"}};
  }
  struct Params final : sim::MetricParams {
    void read(sim::ParamReader& in) override {
      in.require("vehicle");
      read_vehicle(in);
      read_from_s(in);
    }
  };

  StabilityMetric(const MetricContext& context, const Params& params)
      : Metric(context), params_(params), world_(context.world) {}

  void after_step() override {
    if (generation_ != world_.generation()) watch();
    const sim::Vehicle* vehicle = world_.find_vehicle(params_.vehicle);
    if (vehicle == nullptr || sim::to_seconds(world_.now()) < params_.from_s) return;
    ++steps_;
    const auto support = support_of(world_, *vehicle);
    // In the air, or on one or two contacts, there is no support, and no margin at present.
    now_ = {no_figure, no_figure, no_figure};
    if (!support) return;
    ++carried_;
    now_ = {support->static_margin_m, support->zmp_margin_m, support->capture_margin_m};
    least_[0] = std::min(least_[0], support->static_margin_m);
    least_[1] = std::min(least_[1], support->zmp_margin_m);
    least_[2] = std::min(least_[2], support->capture_margin_m);
    least_[3] = std::min(least_[3], support->nesm_m);
    sum_m_ += support->static_margin_m;
  }

  void visit_state(sim::StateArchive& archive, History) override {
    archive.not_only_finite(least_, now_);
    archive(steps_, carried_, sum_m_);
    // Immediately, not after the next step: a restored world does not report contacts yet.
    if (archive.restoring()) watch();
  }
  std::string why_none(const std::string&) const override {
    return "the vehicle did not stand on three or more contacts";
  }

  void add_figures(Figures& figures) const override {
    const auto min = [&](std::size_t i) { return carried_ > 0 ? least_[i] : no_figure; };
    add(figures, "static_min_m", min(0));
    add(figures, "static_mean_m", carried_ > 0 ? sum_m_ / static_cast<double>(carried_) : no_figure);
    add(figures, "zmp_min_m", min(1));
    add(figures, "capture_min_m", min(2));
    add(figures, "nesm_min_m", min(3));
    add(figures, "carried_share", steps_ > 0 ? static_cast<double>(carried_) / static_cast<double>(steps_) : no_figure);
    add(figures, "static_m", now_[0]);
    add(figures, "zmp_m", now_[1]);
    add(figures, "capture_m", now_[2]);
  }

 private:
  /// Contacts are reported from the next step on.
  void watch() {
    generation_ = world_.generation();
    if (const sim::Vehicle* vehicle = world_.find_vehicle(params_.vehicle))
      world_.physics().watch_contacts(vehicle->group());
  }

  const Params& params_;
  sim::World& world_;
  std::uint64_t generation_ = ~std::uint64_t{0};
  std::int64_t steps_ = 0, carried_ = 0;
  double sum_m_ = 0;
  std::array<double, 4> least_{infinity, infinity, infinity, infinity};
  std::array<double, 3> now_{no_figure, no_figure,
                             no_figure};  ///< static, of the zero-moment point, of the capture point
  static constexpr double infinity = std::numeric_limits<double>::infinity();
};

SHOAL_METRIC("stability", StabilityMetric);

}  // namespace

}  // namespace experiment
