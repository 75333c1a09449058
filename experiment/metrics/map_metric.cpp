// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiment/metrics/scored_period.hpp"
#include "experiment/score/map/map_score.hpp"
#include "experiment/score/map/published_map.hpp"
#include "experiment/score/map/true_map.hpp"
#include "experiment/score/metric_registry.hpp"
#include "shoal/message_codec.hpp"
#include "sim/base/log.hpp"

namespace experiment {

namespace {

/// Compares occupancy grids on a channel with the true map at the time of each.
class MapMetric final : public Metric {
 public:
  static constexpr const char* meaning =
      "occupancy grids on a channel compared with the true map of their time, over the cells that they know";
  static std::vector<sim::FigureKind> figures() {
    return {{"iou", "1", "intersection over union of the occupied cells, mean of the maps"},
            {"final_iou", "1", "the same for the last map"},
            {"still_iou", "1", "the same for the last map, over the cells that have not changed during the run"},
            {"false_occupied_percent", "%", "free cells that the map calls occupied, mean of the maps"},
            {"false_free_percent", "%", "occupied cells that the map calls free, mean of the maps"},
            {"unknown_percent", "%", "free and occupied cells that the last map does not know"},
            {"stale_percent", "%",
             "stale cells, which the map has in an earlier state, of those that have changed so far; mean of the maps"},
            {"stale_age_s", "s", "mean time since such a cell changed"},
            {"maps", "maps", "maps that were compared with the truth", true}};
  }
  struct Params final : ScoredPeriod {
    double height_m = 0.3;
    int tolerance_cells = 1;
    double truth_period_s = 60;
    void read(sim::ParamReader& in) override {
      in.require("channel");
      read_channel(in);
      read_vehicle(in);
      read_period(in);
      in.read("height_m", height_m, sim::between(-1e6, 1e6),
              "height at which the true map is taken, such as that of the lidar");
      in.read("tolerance_cells", tolerance_cells, sim::between(0, 10),
              "an occupied cell is right when the other map has one at most this many columns and rows away");
      in.read("truth_period_s", truth_period_s, sim::between(0.01, 1e6),
              "interval at which the true map is made to detect changes of cells, in addition to each map");
    }
  };

  MapMetric(const MetricContext& context, const Params& params)
      : Metric(context),
        params_(params),
        world_(context.world),
        mailbox_((params.vehicle.empty() ? world_.bus_of_channel(params.channel)
                                         : world_.find_vehicle(params.vehicle)->bus())
                     .open_mailbox(params.channel)) {}

  void after_step() override {
    const double now_s = sim::to_seconds(world_.now());
    // Changes between two maps are only seen if the true map is taken more often than maps come.
    if (history_.started() && now_s >= next_truth_s_ && now_s <= params_.until_s) look(now_s);
    while (const auto message = mailbox_->take()) {
      try {
        take(decode_map(message->payload), now_s);
      } catch (const std::runtime_error& error) {
        if (bad_messages_++ == 0)
          sim::log_warn("metric '{}': {}: {} (ignored, as are all further bad ones)", config().name, message->channel,
                        error.what());
      }
    }
  }

  void add_figures(Figures& figures) const override {
    const auto share = [](double part, double whole) { return whole > 0 ? 100 * part / whole : no_figure; };
    const auto mean = [](double sum, double count) { return count > 0 ? sum / count : no_figure; };
    add(figures, "iou", mean(iou_sum_, iou_count_));
    add(figures, "final_iou", last_.iou());
    add(figures, "still_iou", last_still_iou_);
    add(figures, "false_occupied_percent", mean(false_occupied_sum_, false_occupied_count_));
    add(figures, "false_free_percent", mean(false_free_sum_, false_free_count_));
    add(figures, "unknown_percent", share(last_.unknown, last_.observable));
    add(figures, "stale_percent", mean(stale_sum_, stale_count_));
    // A map without stale cells has none that are old, which is 0 and not unknown.
    add(figures, "stale_age_s", stale_cells_ > 0 ? stale_age_sum_s_ / stale_cells_ : maps_ > 0 ? 0 : no_figure);
    add(figures, "maps", maps_);
  }
  std::string why_none(const std::string& figure) const override {
    if (maps_ > 0)
      return figure == "stale_percent" ? "no cell that the map knows has changed" : "there are no such cells";
    if (bad_messages_ > 0) return fmt::format("none of {} messages could be used", bad_messages_);
    return "no map was received on '" + params_.channel + "'" + since_from_s() + params_.to_until_s();
  }
  std::int64_t bad_messages() const override { return bad_messages_; }

  void visit_state(sim::StateArchive& archive, History) override {
    archive(history_, next_truth_s_, places_, last_, iou_sum_, iou_count_, false_occupied_sum_, false_occupied_count_,
            false_free_sum_, false_free_count_, stale_sum_, stale_count_, stale_age_sum_s_, stale_cells_, maps_,
            bad_messages_);
    archive.not_only_finite(last_still_iou_);
    if (archive.restoring()) empty(*mailbox_);
  }

 private:
  /// Looks at the truth, when something has moved since the last time.
  void look(double now_s) {
    while (next_truth_s_ <= now_s) next_truth_s_ += params_.truth_period_s;
    std::uint64_t places = places_of_objects();
    if (places == places_) return;
    places_ = places;
    history_.look(true_map(world_, history_.frame(), params_.height_m), now_s);
  }

  /// Returns a hash over the poses of all objects.
  std::uint64_t places_of_objects() const {
    sim::StateHash hash;
    for (const auto& [name, object] : world_.objects()) {
      hash.add(static_cast<std::uint64_t>(object.number));
      for (const auto& [body_name, body] : object.bodies()) {
        const sim::Pose X_WB = body->X_WB();
        hash.add_bytes(X_WB.matrix().data(), sizeof(double) * 16);
      }
    }
    return hash.value();
  }

  void take(const PublishedMap& published, double now_s) {
    const sim::Time stamped{published.utime - world_.epoch_us()};
    constexpr double oldest_s = 3600;
    if (now_s > params_.until_s) return;
    if (stamped > world_.now() + sim::from_seconds(1) || stamped < world_.now() - sim::from_seconds(oldest_s))
      throw std::runtime_error(fmt::format("'utime' is not within the last {} s of simulated time", oldest_s));
    if (!history_.started()) {
      history_.start(published.map.frame);
      next_truth_s_ = now_s;
    } else if (!(history_.frame() == published.map.frame)) {
      throw std::runtime_error("a map must have the place, size and cells of the first one");
    }
    next_truth_s_ = std::min(next_truth_s_, now_s);
    look(now_s);
    // An error in a map of a later day may date from a change days before.
    if (now_s < params_.from_s) return;
    add_score(score_map(published.map, history_, params_.tolerance_cells, now_s));
  }

  void add_score(const MapScores& scores) {
    ++maps_;
    last_ = scores.all;
    last_still_iou_ = scores.still.iou();
    const auto mean_of = [](double value, double& sum, double& count) {
      if (std::isnan(value)) return;
      sum += value;
      ++count;
    };
    const auto percent = [](double part, double whole) { return whole > 0 ? 100 * part / whole : no_figure; };
    mean_of(last_.iou(), iou_sum_, iou_count_);
    mean_of(percent(last_.false_occupied, last_.known_free), false_occupied_sum_, false_occupied_count_);
    mean_of(percent(last_.false_free, last_.known_occupied), false_free_sum_, false_free_count_);
    mean_of(percent(last_.stale, last_.known_changed), stale_sum_, stale_count_);
    stale_age_sum_s_ += last_.stale_age_s;
    stale_cells_ += last_.stale;
  }

  const Params& params_;
  sim::World& world_;
  std::unique_ptr<sim::Mailbox> mailbox_;
  CellHistory history_;
  double next_truth_s_ = 0;
  std::uint64_t places_ = 0;
  CellCounts last_;
  double last_still_iou_ = no_figure;
  double iou_sum_ = 0, iou_count_ = 0, false_occupied_sum_ = 0, false_occupied_count_ = 0, false_free_sum_ = 0,
         false_free_count_ = 0, stale_sum_ = 0, stale_count_ = 0, stale_age_sum_s_ = 0, stale_cells_ = 0, maps_ = 0;
  std::int64_t bad_messages_ = 0;
};

SHOAL_METRIC("map", MapMetric);

}  // namespace

}  // namespace experiment
