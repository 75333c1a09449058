#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/world/world.hpp"

namespace tools {

/// Scores a run by the `metrics:` of its world: compares estimates, on the bus of the vehicle, with the truth.
class Scoring {
 public:
  /// One estimate beside the truth at the estimate's own time.
  struct Sample {
    double time_s;
    sim::Vector3d truth_m, estimate_m;
    double error_m() const { return (estimate_m - truth_m).head<2>().norm(); }
  };
  struct Track {
    std::string metric;
    std::string vehicle;
    std::vector<Sample> samples;
  };
  struct Verdict {
    std::string rule;
    bool passed;
  };

  explicit Scoring(const sim::World& world);
  /// Takes the estimates that have come.  Call after every step.
  void after_step();

  /// `NAME.rms_m`, `NAME.final_m`, `NAME.max_m` and `NAME.samples` of every metric, by name.  NaN without samples.
  /// The error is horizontal.
  std::map<std::string, double> figures() const;
  /// The pass rules of the world, each with its outcome.
  std::vector<Verdict> verdicts() const;
  std::vector<Track> tracks() const;
  std::int64_t bad_messages() const { return bad_messages_; }

 private:
  struct Metric {
    const sim::MetricConfig* config;
    const sim::Vehicle* vehicle;
    std::unique_ptr<sim::Mailbox> mailbox;
    std::vector<sim::Vector3d> recent_truth;  ///< ring by step number: estimates come late
    std::vector<Sample> samples;
  };
  void take(Metric& metric, const sim::Message& message);

  const sim::World& world_;
  std::vector<Metric> metrics_;
  std::int64_t bad_messages_ = 0;
};

}  // namespace tools
