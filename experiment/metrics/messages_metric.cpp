// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/metric_registry.hpp"

namespace experiment {

namespace {

/// Number of messages on a channel.
class MessagesMetric final : public Metric {
 public:
  static constexpr const char* meaning = "messages on a channel";
  static std::vector<sim::FigureKind> figures() {
    return {{"count", "messages", "messages received on the channel", true},
            {"bytes", "bytes", "their payload, with the fingerprint", true},
            {"first_s", "s", "simulated time of the first one; none: no message was received"}};
  }
  struct Params final : sim::MetricParams {
    void read(sim::ParamReader& in) override {
      in.require("channel");
      read_channel(in);
      read_vehicle(in);
      read_from_s(in);
    }
  };

  MessagesMetric(const MetricContext& context, const Params& params)
      : Metric(context),
        params_(params),
        world_(context.world),
        mailbox_(bus_of(params, context.world).open_mailbox(params.channel)) {}

  void after_step() override {
    while (const auto message = mailbox_->take()) {
      const double now_s = sim::to_seconds(world_.now());
      if (now_s < params_.from_s) continue;
      if (count_++ == 0) first_s_ = now_s;
      bytes_ += message->payload.size();
    }
  }
  void add_figures(Figures& figures) const override {
    add(figures, "count", static_cast<double>(count_));
    add(figures, "bytes", static_cast<double>(bytes_));
    add(figures, "first_s", first_s_);
  }
  std::string why_none(const std::string&) const override {
    return "no message was received on '" + params_.channel + "'" + since_from_s();
  }
  void visit_state(sim::StateArchive& archive, History) override {
    archive(count_, bytes_, first_s_);
    if (archive.restoring()) empty(*mailbox_);
  }

 private:
  static sim::Bus& bus_of(const Params& params, sim::World& world) {
    return params.vehicle.empty() ? world.bus_of_channel(params.channel) : world.find_vehicle(params.vehicle)->bus();
  }

  const Params& params_;
  const sim::World& world_;
  std::unique_ptr<sim::Mailbox> mailbox_;
  std::int64_t count_ = 0;
  std::size_t bytes_ = 0;
  double first_s_ = no_figure;
};

SHOAL_METRIC("messages", MessagesMetric);

}  // namespace

}  // namespace experiment
