// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/metrics/modems_params.hpp"
#include "experiment/score/link_counts.hpp"
#include "experiment/score/metric_registry.hpp"

namespace experiment {

namespace {

/// Bytes sent per meter of reduced rms error.
class BytesPerMeterMetric final : public Metric {
 public:
  static constexpr const char* meaning = "bytes sent for each meter of reduction of the position error";
  static std::vector<sim::FigureKind> figures() {
    return {{"bytes_per_metre", "bytes/m", "bytes_sent / reduction_m; none if the error was not reduced"},
            {"bytes_sent", "bytes", "payload of the packets that the modems sent", true},
            {"reduction_m", "m", "rms error of `against` minus rms error of `metric`"}};
  }
  struct Params final : ModemsParams {
    std::string metric, against;  ///< position errors with and without messages of others
    void read(sim::ParamReader& in) override {
      in.require("metric");
      read_known_name(in, "metric", metric, "position_error", "the error with messages");
      in.require("against");
      read_known_name(in, "against", against, "position_error", "the error without messages");
      read_modems(in);
      if (!in.describing() && !metric.empty() && metric == against)
        in.error("against", "'against' must be another metric than 'metric'");
    }
  };

  BytesPerMeterMetric(const MetricContext& context, const Params& params)
      : Metric(context), params_(params), world_(context.world) {}

  bool needs_others() const override { return true; }
  void add_figures(Figures& figures) const override {
    const auto bytes = static_cast<double>(any_link_counts(world_, params_.vehicle, params_.device).bytes_sent);
    const double less_m = figures.at(params_.against + ".rms_m") - figures.at(params_.metric + ".rms_m");
    add(figures, "bytes_sent", bytes);
    add(figures, "reduction_m", less_m);
    add(figures, "bytes_per_metre", less_m > 0 ? bytes / less_m : no_figure);
  }
  std::string why_none(const std::string& figure) const override {
    return figure == "bytes_per_metre"
               ? "the error of '" + params_.metric + "' is not known to be the smaller one"
               : "one of the errors of '" + params_.metric + "' and '" + params_.against + "' is not known";
  }
  // No state: the modems count, and the other metrics keep the errors.
  void visit_state(sim::StateArchive&, History) override {}

 private:
  const Params& params_;
  const sim::World& world_;
};

SHOAL_METRIC("bytes_per_metre", BytesPerMeterMetric);

}  // namespace

}  // namespace experiment
