// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/metric_registry.hpp"

namespace experiment {

namespace {

/// Distance traveled by a vehicle.
class DistanceMetric final : public Metric {
 public:
  static constexpr const char* meaning = "distance traveled by a vehicle";
  static std::vector<sim::FigureKind> figures() {
    return {{"travelled_m", "m", "length of the true path, in three dimensions"}};
  }
  struct Params final : sim::MetricParams {
    void read(sim::ParamReader& in) override {
      in.require("vehicle");
      read_vehicle(in);
      read_from_s(in);
    }
  };

  DistanceMetric(const MetricContext& context, const Params& params)
      : Metric(context), params_(params), world_(context.world), truth_(context.truth_of(params.vehicle)) {}

  void after_step() override {
    if (sim::to_seconds(world_.now()) <= params_.from_s) before_m_ = truth_.now().travelled_m;
  }
  void visit_state(sim::StateArchive& archive, History) override { archive(before_m_); }
  std::string why_none(const std::string&) const override { return "nothing was measured"; }
  void add_figures(Figures& figures) const override {
    add(figures, "travelled_m", truth_.now().travelled_m - before_m_);
  }

 private:
  const Params& params_;
  const sim::World& world_;
  const TruthHistory& truth_;
  double before_m_ = 0;  ///< distance traveled before the metric counts
};

SHOAL_METRIC("distance", DistanceMetric);

}  // namespace

}  // namespace experiment
