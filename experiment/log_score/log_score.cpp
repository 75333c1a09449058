// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/log_score/log_score.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "bridges/base/json_text.hpp"
#include "experiment/replay/replayed_world.hpp"
#include "experiment/results/run_record.hpp"
#include "experiment/results/summary_file.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/score/scoring.hpp"
#include "experiment/score/trajectory/estimate_file.hpp"
#include "experiment/score/trajectory/mrclam_files.hpp"
#include "experiment/terminal/progress.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/swarm_position_t.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

namespace {

/// Channel of the estimates of a file.
constexpr const char* file_channel = "score.estimate";
/// Times from here on are UTC in s, since 1970; earlier ones count from the start of the run.
constexpr double first_utc_s = 1e8;
/// Interval of the truth in exported files.
constexpr double truth_interval_s = 0.1;

/// Entry of `metrics:` in the world of a log, as text.
struct MetricEntry {
  std::string name, type, vehicle, channel;
  bool in_3d = false;
};

std::vector<MetricEntry> metrics_in(const std::string& world, const std::string& file) {
  sim::Diagnostics problems;
  const sim::ConfigNode root = sim::parse_config_text(world, file, problems);
  const sim::ConfigNode* list = root.find("metrics");
  std::vector<MetricEntry> metrics;
  if (list == nullptr) return metrics;
  for (const sim::ConfigNode& item : list->items) {
    const auto text = [&](const char* key) {
      const sim::ConfigNode* node = item.find(key);
      return node == nullptr ? std::string() : node->scalar;
    };
    metrics.push_back({text("name"), text("type"), text("vehicle"), text("channel"), text("dimensions") == "3"});
  }
  return metrics;
}

/// Returns the metric whose place the estimates of a file take.
MetricEntry replaced_metric(const std::vector<MetricEntry>& metrics, const LogScoreOptions& options) {
  std::vector<std::string> names;
  std::set<std::string> channels;
  for (const MetricEntry& metric : metrics) {
    if (metric.type != "position_error") continue;
    names.push_back(metric.name);
    channels.insert(metric.vehicle + " " + metric.channel);
  }
  if (names.empty())
    throw std::invalid_argument(options.log + ": its world has no metric of the type position_error for an estimate");
  if (options.metric.empty() && channels.size() > 1)
    throw std::invalid_argument("--metric is needed: the world scores several estimates: " + sim::list_text(names));
  const std::string& name = options.metric.empty() ? names.front() : options.metric;
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw std::invalid_argument("--metric: the world has no position_error '" + sim::shortened(sim::printable(name)) +
                                "'; it has: " + sim::list_text(names) + sim::did_you_mean(name, names));
  return *std::find_if(metrics.begin(), metrics.end(), [&](const MetricEntry& metric) { return metric.name == name; });
}

/// Files with the trajectories of a run.
class Exports {
 public:
  Exports(const LogScoreOptions& options, const sim::World& world) : options_(options), world_(world) {
    if (!options.tum.empty()) {
      std::error_code error;
      std::filesystem::create_directories(options.tum, error);
      if (error) throw std::runtime_error(options.tum + ": cannot be written: " + error.message());
      for (const auto& vehicle : world.vehicles())
        truths_.emplace(vehicle->name(), TumFile(options.tum + "/" + vehicle->name() + "_truth.txt"));
    }
    if (options.mrclam.empty()) return;
    for (const auto& vehicle : world.vehicles()) {
      for (const sim::MountedDevice* device : vehicle->devices()) {
        if (device->config().type == "odometry") odometries_[device->report_channel()] = robot_count();
        if (device->config().type == "swarm_position") sightings_[device->report_channel()] = robot_count();
      }
      robots_.push_back(vehicle->name());
    }
    mrclam_ = std::make_unique<MrclamWriter>(options.mrclam, robots_);
  }

  void after_step() {
    // Truth at a fixed rate, whatever the step: files of long runs stay readable.
    const std::int64_t every =
        std::max<std::int64_t>(1, std::llround(truth_interval_s / sim::to_seconds(world_.step_time())));
    if (world_.step_number() % every != 0) return;
    const double time_s = sim::to_seconds(world_.now());
    for (const auto& vehicle : world_.vehicles()) {
      const sim::Pose X_WV = vehicle->X_WV();
      const sim::Vector3d& p = X_WV.translation();
      if (const auto truth = truths_.find(vehicle->name()); truth != truths_.end())
        truth->second.add(time_s, p, sim::Quaterniond(X_WV.linear()));
      if (const int robot = robot_of(vehicle->name()); mrclam_ && robot >= 0)
        mrclam_->add_truth(robot, time_s, p.x(), p.y(), sim::yaw_of(X_WV.linear()));
    }
  }

  /// Takes a message that a device publishes.
  void message(std::string_view channel, std::span<const std::byte> payload) {
    if (!mrclam_) return;
    const auto time_s = [&](std::int64_t utime) { return 1e-6 * static_cast<double>(utime - world_.epoch_us()); };
    try {
      if (const auto found = odometries_.find(channel); found != odometries_.end()) {
        const auto odometry = shoal::decode<shoal::odometry_t>(payload, shoal::Finite::any);
        mrclam_->add_odometry(found->second, time_s(odometry.utime), odometry.forward_mps, odometry.turn_radps);
      }
      if (const auto found = sightings_.find(channel); found != sightings_.end()) {
        const auto seen = shoal::decode<shoal::swarm_position_t>(payload, shoal::Finite::any);
        for (std::size_t i = 0; i < seen.vehicle.size(); ++i)
          if (const int robot = robot_of(seen.vehicle[i]); robot >= 0)
            mrclam_->add_measurement(found->second, time_s(seen.utime), robot,
                                     std::hypot(seen.relative_m[i][0], seen.relative_m[i][1]),
                                     std::atan2(seen.relative_m[i][1], seen.relative_m[i][0]));
      }
    } catch (const shoal::MessageError&) {
      // Another program uses the channel.
    }
  }

  void finish(const Scoring& scoring) {
    for (auto& [vehicle, truth] : truths_) truth.close();
    for (const Scoring::Track& track : options_.tum.empty() ? std::vector<Scoring::Track>() : scoring.tracks()) {
      TumFile file(options_.tum + "/" + track.metric + ".txt");
      for (const ErrorSample& sample : *track.samples)
        file.add(sample.time_s, sample.estimate_m, sim::Quaterniond::Identity());
      file.close();
    }
    if (mrclam_) mrclam_->close();
  }

 private:
  int robot_count() const { return static_cast<int>(robots_.size()); }
  int robot_of(const std::string& vehicle) const {
    const auto found = std::find(robots_.begin(), robots_.end(), vehicle);
    return found == robots_.end() ? -1 : static_cast<int>(found - robots_.begin());
  }

  const LogScoreOptions& options_;
  const sim::World& world_;
  std::map<std::string, TumFile> truths_;  ///< by vehicle
  std::unique_ptr<MrclamWriter> mrclam_;
  std::vector<std::string> robots_;
  std::map<std::string, int, std::less<>> odometries_, sightings_;  ///< robot by channel
};

class LogScoring {
 public:
  explicit LogScoring(const LogScoreOptions& options)
      : options_(options),
        log_(read_replay_log(options.log)),
        replayed_(log_, {"", load_options(), options.threads},
                  [this](std::string_view channel, std::span<const std::byte> payload) {
                    if (exports_) exports_->message(channel, payload);
                  }),
        scoring_(replayed_.world()) {
    exports_.emplace(options, replayed_.world());
  }

  LogScore run() {
    sim::World& world = replayed_.world();
    // A log that begins with a snapshot has the sums of the metrics until then.
    if (log_.snapshot)
      if (const std::string problem = restore_scores(scoring_, log_.snapshot->scores); !problem.empty())
        notes_.push_back(problem);
    Progress progress(sim::to_seconds(world.step_time()) * static_cast<double>(log_.usable_step()), options_.quiet);
    replayed_.start();
    exports_->after_step();
    while (world.step_number() < log_.usable_step() && caught_signal() == 0) {
      // In the order of a run: devices, then estimates, then scores.
      replayed_.step();
      publish_estimates();
      scoring_.after_step();
      exports_->after_step();
      progress.update(world.now(), 0, replayed_.parts().control, false);
    }
    progress.clear();
    exports_->finish(scoring_);
    return result();
  }

 private:
  /// Reads the file of estimates, and lets the metrics of the estimate that it replaces read it.
  sim::LoadOptions load_options() {
    sim::LoadOptions load = options_.load;
    if (options_.estimate.empty()) return load;
    const std::string world_file = options_.log + ": sim.info";
    const std::vector<MetricEntry> metrics = metrics_in(log_.info.resolved_config, world_file);
    const MetricEntry replaced = replaced_metric(metrics, options_);
    estimates_ = parse_estimates(read_whole_file(options_.estimate), options_.estimate);
    vehicle_ = replaced.vehicle;
    for (const MetricEntry& metric : metrics) {
      if (metric.vehicle != replaced.vehicle || metric.channel != replaced.channel) continue;
      if (metric.type != "position_error" && metric.type != "consistency") continue;
      if (metric.type == "consistency" && !estimates_.rows.front().covariance_m2)
        notes_.push_back(options_.estimate + " has no covariance: " + metric.name + " has no figures");
      if (metric.in_3d && !estimates_.has_height)
        notes_.push_back(options_.estimate + " has no z: " + metric.name + " takes it as 0");
      load.sets.push_back("metrics." + metric.name + ".channel=" + file_channel);
    }
    return load;
  }

  std::int64_t utime_of(const EstimateFile::Row& row) const {
    const auto us = static_cast<std::int64_t>(std::llround(row.time_s * 1e6));
    return row.time_s < first_utc_s ? replayed_.world().epoch_us() + us : us;
  }

  /// Publishes the estimates up to the present time of the vehicle's clock.
  void publish_estimates() {
    const sim::World& world = replayed_.world();
    const sim::Vehicle* vehicle = vehicle_.empty() ? nullptr : world.find_vehicle(vehicle_);
    if (vehicle == nullptr) return;
    const std::int64_t now_us = world.epoch_us() + vehicle->clock().reading(world.now()).count();
    for (; next_ < estimates_.rows.size() && utime_of(estimates_.rows[next_]) <= now_us; ++next_) {
      const EstimateFile::Row& row = estimates_.rows[next_];
      vehicle->bus().publish(file_channel, message_of(row), world.now());
    }
  }

  sim::Bytes message_of(const EstimateFile::Row& row) const {
    const auto fill = [&](auto& message, double* position_m) {
      message.utime = utime_of(row);
      for (int i = 0; i < 3; ++i) position_m[i] = row.position_m[i];
    };
    if (!row.covariance_m2) {
      shoal::pose_t pose{};
      fill(pose, pose.pos);
      return shoal::encode(pose);
    }
    shoal::estimate_t estimate{};
    fill(estimate, estimate.position_m);
    for (int i = 0; i < 9; ++i) estimate.covariance_m2[i] = (*row.covariance_m2)(i / 3, i % 3);
    // NaN: the file says nothing about the clock.
    estimate.clock_error_s = std::nan("");
    return shoal::encode(estimate);
  }

  LogScore result() {
    LogScore score;
    score.world = log_.info.world;
    score.seed = log_.info.seed;
    score.sim_time_s = sim::to_seconds(replayed_.world().now());
    score.figures = scoring_.figures();
    score.verdicts = scoring_.verdicts();
    score.interrupted = caught_signal() != 0;
    if (log_.usable_step() < log_.last_step)
      notes_.push_back(fmt::format("the log lacks inputs after {:.6g} s", score.sim_time_s));
    if (next_ < estimates_.rows.size())
      notes_.push_back(fmt::format("{} of {} estimates in {} are after the end of the log",
                                   estimates_.rows.size() - next_, estimates_.rows.size(), options_.estimate));
    for (const std::string& note : replayed_.notes()) notes_.push_back(note);
    score.notes = notes_;
    return score;
  }

  const LogScoreOptions& options_;
  const ReplayLog log_;
  EstimateFile estimates_;
  std::string vehicle_;  ///< of the estimates in the file
  std::vector<std::string> notes_;
  std::optional<Exports> exports_;
  ReplayedWorld replayed_;
  Scoring scoring_;
  std::size_t next_ = 0;  ///< estimate
};

}  // namespace

LogScore score_log(const LogScoreOptions& options) {
  return LogScoring(options).run();
}

std::string LogScore::to_text() const {
  std::string text = fmt::format("world {}  seed {}\n  {:.2f} s scored\n", world, seed, sim_time_s);
  std::size_t width = 28;
  for (const auto& [name, value] : figures) width = std::max(width, name.size());
  for (const auto& [name, value] : figures)
    text += fmt::format("  {:<{}} {}\n", name, width, std::isnan(value) ? "none" : fmt::format("{:.4g}", value));
  for (const RuleVerdict& verdict : verdicts)
    text += fmt::format("  {}: {}\n", verdict.passed ? "passed" : "FAILED", verdict.text());
  for (const std::string& note : notes) text += "note: " + note + "\n";
  return text;
}

std::string LogScore::to_json() const {
  nlohmann::ordered_json json;
  json["world"] = world;
  json["seed"] = seed;
  json["sim_time_s"] = sim_time_s;
  json["metrics"] = nlohmann::ordered_json::object();
  for (const auto& [name, value] : figures) json["metrics"][name] = value;  // NaN becomes null
  json["rules"] = nlohmann::ordered_json::array();
  for (const RuleVerdict& verdict : verdicts) json["rules"].push_back(json_of(verdict));
  json["notes"] = notes;
  return bridges::json_text(json, 2) + "\n";
}

}  // namespace experiment
