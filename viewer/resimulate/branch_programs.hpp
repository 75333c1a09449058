// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bridges/control/sim_service.hpp"
#include "experiment/replay/replayed_world.hpp"
#include "experiment/run/run_programs.hpp"

namespace viewer {

/// Programs of a world that is run again, for a branch whose programs are started again.  They start at the first step,
/// follow the recorded steps in the lockstep, so that they know what they knew in the run, and act from the branch on.
class BranchPrograms final : private bridges::TimeMachine {
 public:
  /// Executes a request about time of another program on the bus.  Throws std::runtime_error when it is refused.
  using Execute = std::function<std::string(const std::string& command, double value)>;

  /// `replayed` has been built for programs and must outlive this.
  BranchPrograms(experiment::ReplayedWorld& replayed, Execute execute);

  /// Starts the programs on the buses of the world, which is at the first step.  Throws RunError.
  void start();
  /// Ends the programs, and mutes the buses.  Does nothing when none run.
  void stop();
  bool running() const { return programs_ != nullptr; }
  /// Publishes what the world has published in this step, and the ticks.
  void end_of_step();
  /// Answers requests on the bus, checks the programs, and waits up to 20 ms for those that have to join or to answer.
  /// Returns whether the world may take the next step.  Throws RunError when the branch cannot continue, and
  /// bridges::LockstepTimeout.
  bool ready();
  /// Returns what the world waits for, for the pages; empty: nothing.
  std::string waits_for();
  /// Sets whether the programs act, or only follow the record: then requests that change the world are those of the
  /// record, and further ones are answered without an effect.
  void set_acting(bool acting);

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<std::string> execute(const std::string& command, const std::string& text, double value) override;
  /// Returns whether all programs have joined.
  bool joined();

  experiment::ReplayedWorld& replayed_;
  experiment::RunParts& parts_;  // of it
  const Execute execute_;
  experiment::RunOptions options_;
  std::unique_ptr<experiment::RunPrograms> programs_;
  std::vector<std::string> awaited_;  // lockstep clients that have to join
  Clock::time_point join_until_{};
  bool synchronized_ = false, begun_ = false, acting_ = false;
};

}  // namespace viewer
