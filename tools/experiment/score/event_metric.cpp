// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/condition_watch.hpp"
#include "tools/experiment/score/metric.hpp"

namespace tools {

namespace {

/// When something became true for the first time.
class MissionTimeMetric final : public Metric {
 public:
  MissionTimeMetric(const sim::MetricConfig& config, sim::World& world)
      : Metric(config), world_(world), watch_(sim::make_watch(config.when, world, world.zones())) {}

  void after_step() override {
    if (time_s_ == time_s_) return;  // it has a time
    if (watch_ ? watch_->count_new(world_) > 0 : is_there()) time_s_ = sim::to_seconds(world_.now());
  }
  void add_figures(Figures& figures) const override { add(figures, "time_s", time_s_); }
  std::string why_none(const std::string&) const override { return "it did not happen"; }
  void visit_state(sim::StateArchive& archive, History) override {
    archive(time_s_);
    // A restored world may have built anew what the watch looks at.
    if (watch_ && archive.restoring()) watch_ = sim::make_watch(config().when, world_, world_.zones());
    if (watch_) watch_->visit_state(archive);
  }

 private:
  bool is_there() const {
    const sim::Vehicle* vehicle = world_.find_vehicle(config().vehicle);
    return (vehicle->X_WV().translation() - config().position_m).norm() <= config().radius_m;
  }

  sim::World& world_;
  std::unique_ptr<sim::ConditionWatch> watch_;  ///< null: it waits for a vehicle to be at a place
  double time_s_ = no_figure;
};

/// How many messages came on a channel.
class MessagesMetric final : public Metric {
 public:
  MessagesMetric(const sim::MetricConfig& config, sim::World& world)
      : Metric(config), world_(world), mailbox_(bus_of(config, world).open_mailbox(config.channel)) {}

  void after_step() override {
    while (const auto message = mailbox_->take()) {
      const double now_s = sim::to_seconds(world_.now());
      if (now_s < config().from_s) continue;
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
    return "no message came on '" + config().channel + "'" + since_from_s();
  }
  void visit_state(sim::StateArchive& archive, History) override {
    archive(count_, bytes_, first_s_);
    if (archive.restoring()) empty(*mailbox_);
  }

 private:
  static sim::Bus& bus_of(const sim::MetricConfig& config, sim::World& world) {
    return config.vehicle.empty() ? world.bus_of_channel(config.channel) : world.find_vehicle(config.vehicle)->bus();
  }

  const sim::World& world_;
  std::unique_ptr<sim::Mailbox> mailbox_;
  std::int64_t count_ = 0;
  std::size_t bytes_ = 0;
  double first_s_ = no_figure;
};

}  // namespace

std::unique_ptr<Metric> make_event_metric(const sim::MetricConfig& config, sim::World& world) {
  if (config.type == sim::MetricType::mission_time) return std::make_unique<MissionTimeMetric>(config, world);
  return std::make_unique<MessagesMetric>(config, world);
}

}  // namespace tools
