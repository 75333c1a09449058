#include "tools/experiment/scoring.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "shoal/message_codec.hpp"
#include "shoal/pose_t.hpp"

namespace tools {

namespace {

/// Estimates may be this old when they come.
constexpr double truth_memory_s = 10;

}  // namespace

Scoring::Scoring(const sim::World& world) : world_(world) {
  const auto steps = static_cast<std::size_t>(truth_memory_s / sim::to_seconds(world.step_time())) + 1;
  for (const sim::MetricConfig& config : world.config().metrics) {
    const sim::Vehicle* vehicle = world.find_vehicle(config.vehicle);
    metrics_.push_back({&config,
                        vehicle,
                        vehicle->bus().open_mailbox(config.channel),
                        std::vector<sim::Vector3d>(steps, vehicle->X_WV().translation()),
                        {}});
  }
}

void Scoring::after_step() {
  for (Metric& metric : metrics_) {
    const auto slot = static_cast<std::size_t>(world_.step_number()) % metric.recent_truth.size();
    metric.recent_truth[slot] = metric.vehicle->X_WV().translation();
    while (const auto message = metric.mailbox->take()) take(metric, *message);
  }
}

void Scoring::take(Metric& metric, const sim::Message& message) {
  try {
    const auto pose = shoal::decode<shoal::pose_t>(message.payload, shoal::Finite::required);
    const std::int64_t step_us = world_.step_time().count();
    const auto memory = static_cast<std::int64_t>(metric.recent_truth.size());
    // Compared before it is subtracted: any 64 bits may come.
    const bool in_run =
        pose.utime >= world_.epoch_us() && pose.utime < world_.epoch_us() + world_.now().count() + (step_us + 1) / 2;
    const std::int64_t t_us = in_run ? pose.utime - world_.epoch_us() : 0;
    const std::int64_t step = (t_us + step_us / 2) / step_us;
    if (!in_run || step <= world_.step_number() - memory)
      throw std::runtime_error(fmt::format("'utime' is not within the last {} s of simulated time", truth_memory_s));
    if (static_cast<double>(t_us) * 1e-6 < metric.config->from_s) return;
    metric.samples.push_back({static_cast<double>(t_us) * 1e-6,
                              metric.recent_truth[static_cast<std::size_t>(step % memory)],
                              {pose.pos[0], pose.pos[1], pose.pos[2]}});
  } catch (const std::runtime_error& error) {
    if (++bad_messages_ <= 100) spdlog::warn("{}: {} (ignored)", message.channel, error.what());
  }
}

std::map<std::string, double> Scoring::figures() const {
  std::map<std::string, double> figures;
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  for (const Metric& metric : metrics_) {
    double squares = 0;
    double largest = 0;
    for (const Sample& sample : metric.samples) {
      squares += sample.error_m() * sample.error_m();
      largest = std::max(largest, sample.error_m());
    }
    const auto count = static_cast<double>(metric.samples.size());
    const std::string& name = metric.config->name;
    figures[name + ".rms_m"] = count > 0 ? std::sqrt(squares / count) : nothing;
    figures[name + ".final_m"] = count > 0 ? metric.samples.back().error_m() : nothing;
    figures[name + ".max_m"] = count > 0 ? largest : nothing;
    figures[name + ".samples"] = count;
  }
  return figures;
}

std::vector<Scoring::Verdict> Scoring::verdicts() const {
  const std::map<std::string, double> all = figures();
  std::vector<Verdict> verdicts;
  for (const sim::PassRule& rule : world_.config().pass) {
    const double value = all.at(rule.metric);
    const double limit = rule.below ? *rule.below : rule.factor * all.at(rule.below_metric);
    const std::string right = rule.below ? fmt::format("{}", *rule.below)
                                         : fmt::format("{} * {} ({:.3f})", rule.factor, rule.below_metric, limit);
    // NaN (no estimate came) fails.
    verdicts.push_back({fmt::format("{} ({:.3f}) < {}", rule.metric, value, right), value < limit});
  }
  return verdicts;
}

std::vector<Scoring::Track> Scoring::tracks() const {
  std::vector<Track> tracks;
  for (const Metric& metric : metrics_) tracks.push_back({metric.config->name, metric.config->vehicle, metric.samples});
  return tracks;
}

}  // namespace tools
