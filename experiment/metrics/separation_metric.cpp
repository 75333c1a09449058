// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/metric_registry.hpp"

namespace experiment {

namespace {

/// Smallest distance between vehicles.
class SeparationMetric final : public Metric {
 public:
  static constexpr const char* meaning = "smallest distance between the origins of two vehicles";
  static std::vector<sim::FigureKind> figures() {
    return {{"min_m", "m", "smallest distance, in three dimensions"}, {"at_s", "s", "simulated time of it"}};
  }
  struct Params final : sim::MetricParams {
    void read(sim::ParamReader& in) override {
      read_vehicle(in);
      read_from_s(in);
    }
  };

  SeparationMetric(const MetricContext& context, const Params& params)
      : Metric(context), params_(params), world_(context.world) {}

  void after_step() override {
    const double now_s = sim::to_seconds(world_.now());
    if (now_s < params_.from_s) return;
    const auto& vehicles = world_.vehicles();
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      const sim::Vector3d p_W = vehicles[i]->X_WV().translation();
      for (std::size_t k = i + 1; k < vehicles.size(); ++k) {
        const bool counts =
            params_.vehicle.empty() || vehicles[i]->name() == params_.vehicle || vehicles[k]->name() == params_.vehicle;
        if (!counts) continue;
        const double distance_m = (vehicles[k]->X_WV().translation() - p_W).norm();
        if (min_m_ <= distance_m) continue;
        min_m_ = distance_m;
        at_s_ = now_s;
      }
    }
  }

  void visit_state(sim::StateArchive& archive, History) override { archive(min_m_, at_s_); }
  std::string why_none(const std::string&) const override { return "there were no two vehicles"; }

  void add_figures(Figures& figures) const override {
    add(figures, "min_m", min_m_);
    add(figures, "at_s", at_s_);
  }

 private:
  const Params& params_;
  const sim::World& world_;
  double min_m_ = no_figure, at_s_ = no_figure;
};

SHOAL_METRIC("separation", SeparationMetric);

}  // namespace

}  // namespace experiment
