// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/view/view_publisher.hpp"
#include "experiment/replay/replay_log.hpp"
#include "experiment/replay/replayed_world.hpp"
#include "experiment/score/scoring.hpp"
#include "experiment/time/pacer.hpp"
#include "experiment/time/world_time.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "sim/run/run_control.hpp"
#include "viewer/resimulate/branch_programs.hpp"
#include "viewer/server/run_view.hpp"

namespace viewer {

/// Live page of a record that is run again: it shows what was never recorded, too, and the scores.  Its pages pause it,
/// step it, set its speed and go back in it; `branch` leaves the record: from then on they may change the world.  The
/// messages of the programs remain those of the record, or, with `launch`, the programs are started again.
class ResimulatedRun {
 public:
  struct Options {
    std::string log;
    sim::LoadOptions load;
    int threads = 0;  ///< threads that share a step; 0: one for each processor
    experiment::ViewOptions view;
    bool launch = false;  ///< branches start the programs of the world again
    std::string lcm_url;  ///< for them; empty: LCM_DEFAULT_URL, then the default
  };

  /// Reads the log, builds its world and starts the server.  Throws std::runtime_error when the log cannot be replayed,
  /// RunError when the buses cannot be used for programs, sim::ConfigError, bridges::BusError, bridges::WebError.
  ResimulatedRun(const Options& options, const std::string& version);

  std::string url() const { return page_.url(); }
  const sim::World& world() const { return replayed_.world(); }
  const sim::RunControl& control() const { return replayed_.parts().control; }
  const experiment::Scoring& scoring() const { return scoring_; }
  double end_s() const;
  /// Returns what the programs of the present branch do: `recorded commands`, `restarted programs` or `no programs`.
  const char* programs() const;
  /// Returns the commands of the programs that a branch starts.
  std::vector<std::string> commands() const;
  /// Runs while `goes_on` returns true; afterwards the page is closed.
  void run(const std::function<bool()>& goes_on);
  /// Answers the pages, then takes the next step if it is due; returns the time until it is.
  std::chrono::microseconds advance();
  /// Executes a request of a page.  Throws std::runtime_error with the reason when it is refused.
  std::string execute(const std::string& command, double value, const std::string& text);

 private:
  /// Returns a function that passes messages of the world on to the pages.
  experiment::ReplayedWorld::Watch page_tap();
  void check_buses();
  void serve();
  void step();
  void after_step();
  bool programs_are_ready();
  void fail(const std::string& why);
  bool at_end() const;
  /// Goes back to the first step of the record, or of its part.
  void go_to_start();
  std::string branch(const std::string& programs);
  void start_programs(std::int64_t step);
  void start_branch();
  std::string rewind(double seconds);
  void arrive();
  std::string change(const std::string& command, double value, const std::string& text);
  std::string place() const;

  experiment::ReplayLog log_;
  RunView page_;
  experiment::ReplayedWorld replayed_;
  experiment::Scoring scoring_;
  bridges::ViewPublisher view_;
  sim::RunControl& control_;
  std::unique_ptr<BranchPrograms> programs_;  // null: branches keep the commands of the record
  experiment::Pacer pacer_;
  experiment::WorldTime time_;
  experiment::SavedRun first_;  // state at the start
  // Requests of pages after a branch without programs, by step; with programs the world keeps them.
  std::multimap<std::int64_t, shoal::sim_control_request_t> changes_;
  std::optional<std::int64_t> catch_up_;  // step that is computed again without pace
  bool branched_ = false, restarted_ = false, faulty_ = false;
};

}  // namespace viewer
