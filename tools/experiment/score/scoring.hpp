// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/config/warnings.hpp"
#include "sim/world/world.hpp"
#include "tools/experiment/score/first_contacts.hpp"
#include "tools/experiment/score/metric.hpp"
#include "tools/experiment/score/rule_verdict.hpp"
#include "tools/experiment/score/truth_history.hpp"

namespace tools {

/// Scores a run by the `metrics:` of its world: looks at the truth, at estimates on the bus of their vehicle, at
/// contacts and packets.  Scoring does not change the run.
class Scoring {
 public:
  /// What a metric compared.
  struct Track {
    std::string metric;
    std::string vehicle;
    std::string channel;
    int dimensions;
    const std::vector<ErrorSample>* samples;
  };
  using Verdict = RuleVerdict;

  /// `world` must outlive this.  `say`: see FirstContacts.
  explicit Scoring(sim::World& world, FirstContacts::Report report = {});
  ~Scoring();
  /// Call after every step.
  void after_step();

  /// The figures of every metric, by name.  Before its from_s a metric has none: they are NaN.
  Figures figures() const;
  /// The rules of the world, each with its outcome.
  std::vector<Verdict> verdicts() const;
  /// Of the metrics that compare estimates with the truth.
  std::vector<Track> tracks() const;
  std::int64_t bad_messages() const;
  /// Who hit whom.
  const FirstContacts& contacts() const { return contacts_; }
  /// Warns of metrics that had nothing to make figures of.  At the end of a run.
  void warn_of_silence(sim::Warnings& warnings) const;
  /// In sections of their own.
  void visit_state(sim::StateArchive& archive, History history);

 private:
  const TruthHistory& truth_of(const std::string& vehicle);
  /// The run has not come to the time from which the metric counts.
  bool is_early(const Metric& metric) const;
  /// Why a figure, `NAME.figure`, is NaN.
  std::string why_none(const std::string& name) const;

  sim::World& world_;
  std::map<std::string, std::unique_ptr<TruthHistory>> truths_;  ///< by vehicle
  std::vector<std::unique_ptr<Metric>> metrics_;
  FirstContacts contacts_;
};

}  // namespace tools
