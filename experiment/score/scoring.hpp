// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiment/score/first_contacts.hpp"
#include "experiment/score/metric.hpp"
#include "experiment/score/rule_verdict.hpp"
#include "experiment/score/truth_history.hpp"
#include "sim/config/warnings.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/world/world.hpp"

namespace experiment {

/// Scores a run by the `metrics:` of its world, from the truth, estimates on the bus of their vehicle, contacts and
/// packets.  Scoring does not change the run.
class Scoring {
 public:
  /// Samples that a metric compared.
  struct Track {
    std::string metric;
    std::string vehicle;
    std::string channel;
    int dimensions;
    const std::vector<ErrorSample>* samples;
  };
  using Verdict = RuleVerdict;

  /// `world` must outlive this.  `report`: see FirstContacts.
  explicit Scoring(sim::World& world, FirstContacts::Report report = {});
  ~Scoring();
  /// Call after every step.
  void after_step();

  /// Returns the figures of every metric, by name.  They are NaN before the from_s of the metric.
  Figures figures() const;
  /// Returns the rules of the world, each with its outcome.
  std::vector<Verdict> verdicts() const;
  /// Returns the tracks of the metrics that compare estimates with the truth.
  std::vector<Track> tracks() const;
  std::int64_t bad_messages() const;
  /// Contacts between vehicles and objects.
  const FirstContacts& contacts() const { return contacts_; }
  /// Warns of metrics without data for their figures, at the end of a run.
  void warn_of_silence(sim::Warnings& warnings) const;
  /// Visits the state of each metric in its own section.
  void visit_state(sim::StateArchive& archive, History history);

 private:
  const TruthHistory& truth_of(const std::string& vehicle);
  /// Returns whether the run has not reached the time from which the metric counts.
  bool is_early(const Metric& metric) const;
  /// Returns why a figure, `NAME.figure`, is NaN.
  std::string why_none(const std::string& name) const;

  sim::World& world_;
  std::map<std::string, std::unique_ptr<TruthHistory>> truths_;  ///< by vehicle
  std::vector<std::unique_ptr<Metric>> metrics_;
  FirstContacts contacts_;
};

/// Continues scores from those of the snapshot with which a record begins.  Returns why that is not possible, and the
/// scores begin with the log; empty: they continue.
std::string restore_scores(Scoring& scoring, const sim::Bytes& saved);

}  // namespace experiment
