// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/scoring.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "experiment/score/metric_registry.hpp"

namespace experiment {

Scoring::Scoring(sim::World& world, FirstContacts::Report report) : world_(world), contacts_(world, std::move(report)) {
  const auto truth = [this](const std::string& vehicle) -> const TruthHistory& { return truth_of(vehicle); };
  for (const sim::MetricConfig& config : world.config().metrics)
    metrics_.push_back(make_metric({config, world, truth}));
}

Scoring::~Scoring() = default;

const TruthHistory& Scoring::truth_of(const std::string& vehicle) {
  std::unique_ptr<TruthHistory>& truth = truths_[vehicle];
  if (!truth) truth = std::make_unique<TruthHistory>(world_, *world_.find_vehicle(vehicle));
  return *truth;
}

void Scoring::after_step() {
  for (const auto& [vehicle, truth] : truths_) truth->after_step();
  for (const auto& metric : metrics_) metric->after_step();
  contacts_.after_step();
}

bool Scoring::is_early(const Metric& metric) const {
  return sim::to_seconds(world_.now()) < metric.config().params->from_s;
}

Figures Scoring::figures() const {
  Figures figures;
  for (const bool needs_others : {false, true})
    for (const auto& metric : metrics_) {
      if (metric->needs_others() != needs_others) continue;
      metric->add_figures(figures);
      if (!is_early(*metric)) continue;
      // A metric without data has neither a count of 0 nor a gap of 0 s, because a rule would hold by these values.
      for (const std::string& name : metric->config().figures()) figures[name] = no_figure;
    }
  return figures;
}

void Scoring::visit_state(sim::StateArchive& archive, History history) {
  for (const auto& [vehicle, truth] : truths_) {
    archive.section("truth of " + vehicle);
    archive(*truth);
  }
  for (const auto& metric : metrics_) {
    archive.section("metric " + metric->config().name);
    // NaN and infinity in figures represent missing data.
    struct State {
      Metric& metric;
      History history;
      void visit_state(sim::StateArchive& each) { metric.visit_state(each, history); }
    } state{*metric, history};
    archive.not_only_finite(state);
  }
  archive.section("contacts");
  archive(contacts_);
}

std::string Scoring::why_none(const std::string& name) const {
  for (const auto& metric : metrics_) {
    const sim::MetricConfig& config = metric->config();
    if (!name.starts_with(config.name + ".")) continue;
    if (is_early(*metric))
      return fmt::format("the run ended at {:.6g} s, before from_s, {:.6g} s", sim::to_seconds(world_.now()),
                         config.params->from_s);
    return metric->why_none(name.substr(config.name.size() + 1));
  }
  return "there is no such metric";
}

std::vector<Scoring::Verdict> Scoring::verdicts() const {
  const Figures all = figures();
  const auto value_of = [&](const sim::RuleExpression::Figure& figure) -> FigureValue {
    const double value = all.at(figure.name);
    return {value, std::isnan(value) ? why_none(figure.name) : ""};
  };
  std::vector<Verdict> verdicts;
  for (const sim::RuleExpression& rule : world_.config().pass) verdicts.push_back(judge_rule(rule, value_of));
  return verdicts;
}

std::vector<Scoring::Track> Scoring::tracks() const {
  std::vector<Track> tracks;
  for (const auto& metric : metrics_)
    if (const std::vector<ErrorSample>* samples = metric->samples())
      tracks.push_back({metric->config().name, metric->config().params->vehicle, metric->config().params->channel,
                        metric->dimensions(), samples});
  return tracks;
}

std::int64_t Scoring::bad_messages() const {
  std::int64_t sum = 0;
  for (const auto& metric : metrics_) sum += metric->bad_messages();
  return sum;
}

void Scoring::warn_of_silence(sim::Warnings& warnings) const {
  for (const auto& metric : metrics_) {
    const std::vector<ErrorSample>* samples = metric->samples();
    if (samples == nullptr || !samples->empty()) continue;
    const std::string& name = metric->config().name;
    warnings.warn(metric->config().place, "metric '" + name + "'",
                  why_none(name + ".samples") + ": its figures are not numbers");
  }
}

std::string restore_scores(Scoring& scoring, const sim::Bytes& saved) {
  try {
    auto scores = sim::StateArchive::restorer(saved);
    scoring.visit_state(scores, History::whole);
    scores.end();
  } catch (const sim::SnapshotError& error) {
    return std::string("the scores begin with the log: ") + error.what();
  }
  return {};
}

}  // namespace experiment
