// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/metrics/modems_params.hpp"
#include "experiment/score/link_counts.hpp"
#include "experiment/score/metric_registry.hpp"
#include "sim/acoustics/propagation/signal.hpp"

namespace experiment {

namespace {

std::string meaning_of(sim::SignalLoss loss) {
  switch (loss) {
    case sim::SignalLoss::none:
      return "understood";
    case sim::SignalLoss::noise:
      return "too weak against noise; by radio: in a zone without radio";
    case sim::SignalLoss::interference:
      return "too weak against other sounds";
    case sim::SignalLoss::half_duplex:
      return "the receiver was sending";
    case sim::SignalLoss::busy:
      return "the receiver was receiving another signal";
    case sim::SignalLoss::captured:
      return "a stronger signal took the receiver over";
    case sim::SignalLoss::doppler:
      return "sender and receiver approach or separate too fast";
    case sim::SignalLoss::blocked:
      return "an obstacle blocks the path; by radio: or an antenna is under water";
    case sim::SignalLoss::out_of_water:
      return "sender or receiver left the water";
    case sim::SignalLoss::receiver_off:
      return "the receiver has no power, or is silent by a fault";
    case sim::SignalLoss::link:
      return "`links` of the world, or the radio's `loss_probability`";
    case sim::SignalLoss::range:
      return "too far away";
    case sim::SignalLoss::sender_off:
      return "the sender lost power or was removed during the transmission";
    case sim::SignalLoss::shadow:
      return "no ray without a bounce arrived, and echoes were too weak";
  }
  return "";
}

/// Packets of modems and their delivery.
class DeliveryMetric final : public Metric {
 public:
  static constexpr const char* meaning = "packets of modems and their delivery";
  static std::vector<sim::FigureKind> figures() {
    std::vector<sim::FigureKind> figures{
        {"sent", "packets", "packets that its modems sent", true},
        {"received", "packets", "packets addressed to its modems that arrived", true},
        {"lost", "packets", "packets addressed to its modems that were lost", true},
        {"ratio", "1", "received / (received + lost), from 0 to 1; none when nothing was addressed to its modems"},
        {"bytes_sent", "bytes", "payload of the packets that its modems sent", true},
        {"unsent", "packets", "packets not sent: no power, or out of the water", true},
        {"dropped", "packets", "packets dropped from full queues of its modems", true}};
    for (int loss = 1; loss < sim::signal_losses; ++loss)  // 0: none
      figures.push_back({"lost_" + std::string(sim::signal_loss_word(static_cast<sim::SignalLoss>(loss))), "packets",
                         "lost: " + meaning_of(static_cast<sim::SignalLoss>(loss)), true});
    return figures;
  }
  struct Params final : ModemsParams {
    void read(sim::ParamReader& in) override { read_modems(in); }
  };

  DeliveryMetric(const MetricContext& context, const Params& params)
      : Metric(context), params_(params), world_(context.world) {}

  void add_figures(Figures& figures) const override {
    const LinkCounts counts = any_link_counts(world_, params_.vehicle, params_.device);
    std::int64_t all_lost = 0;
    for (const auto& [cause, count] : counts.lost) all_lost += count;
    // A packet to all counts once for each receiver, so the ratio is of receptions, not of packets.
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
  // No state: the modems and the acoustic channel count, and are restored with the world.
  void visit_state(sim::StateArchive&, History) override {}

 private:
  const Params& params_;
  const sim::World& world_;
};

SHOAL_METRIC("delivery", DeliveryMetric);

}  // namespace

}  // namespace experiment
