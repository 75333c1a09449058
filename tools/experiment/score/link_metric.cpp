// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/score/link_counts.hpp"
#include "tools/experiment/score/metric.hpp"

namespace tools {

namespace {

/// Packets of modems, and what became of them.
class DeliveryMetric final : public Metric {
 public:
  DeliveryMetric(const sim::MetricConfig& config, const sim::World& world) : Metric(config), world_(world) {}

  void add_figures(Figures& figures) const override {
    const LinkCounts counts = any_link_counts(world_, config().vehicle, config().device);
    std::int64_t all_lost = 0;
    for (const auto& [cause, count] : counts.lost) all_lost += count;
    const auto meant = static_cast<double>(counts.received + all_lost);
    add(figures, "sent", static_cast<double>(counts.sent));
    add(figures, "bytes_sent", static_cast<double>(counts.bytes_sent));
    add(figures, "received", static_cast<double>(counts.received));
    add(figures, "lost", static_cast<double>(all_lost));
    add(figures, "ratio", meant > 0 ? static_cast<double>(counts.received) / meant : no_figure);
    add(figures, "unsent", static_cast<double>(counts.unsent));
    add(figures, "dropped", static_cast<double>(counts.dropped));
    for (const auto& [cause, count] : counts.lost) add(figures, "lost_" + cause, static_cast<double>(count));
  }
  std::string why_none(const std::string&) const override { return "nothing was sent to these modems"; }
  // No state of its own: the modems and the acoustic channel count, and go back with the world.
  void visit_state(sim::StateArchive&, History) override {}

 private:
  const sim::World& world_;
};

/// What a metre of rms error less cost in bytes.
class BytesPerMetreMetric final : public Metric {
 public:
  BytesPerMetreMetric(const sim::MetricConfig& config, const sim::World& world) : Metric(config), world_(world) {}

  bool needs_others() const override { return true; }
  void add_figures(Figures& figures) const override {
    const auto bytes = static_cast<double>(any_link_counts(world_, config().vehicle, config().device).bytes_sent);
    const double less_m = figures.at(config().against + ".rms_m") - figures.at(config().metric + ".rms_m");
    add(figures, "bytes_sent", bytes);
    add(figures, "reduction_m", less_m);
    add(figures, "bytes_per_metre", less_m > 0 ? bytes / less_m : no_figure);
  }
  std::string why_none(const std::string& figure) const override {
    return figure == "bytes_per_metre"
               ? "the error of '" + config().metric + "' is not known to be the smaller one"
               : "one of the errors of '" + config().metric + "' and '" + config().against + "' is not known";
  }
  // No state of its own: the modems count, and the other metrics keep the errors.
  void visit_state(sim::StateArchive&, History) override {}

 private:
  const sim::World& world_;
};

}  // namespace

std::unique_ptr<Metric> make_link_metric(const sim::MetricConfig& config, const sim::World& world) {
  if (config.type == sim::MetricType::delivery) return std::make_unique<DeliveryMetric>(config, world);
  return std::make_unique<BytesPerMetreMetric>(config, world);
}

}  // namespace tools
