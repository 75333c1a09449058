// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "bridges/control/sim_service.hpp"
#include "bridges/lockstep/lockstep_service.hpp"
#include "bridges/log/run_journal.hpp"
#include "experiment/run/run_buses.hpp"

namespace experiment {

/// Inputs of a run from outside since a step, for replaying them.
class RunInputs {
 public:
  /// All must outlive this.
  RunInputs(RunBuses& buses, bridges::RunJournal& journal, bridges::SimService& service,
            bridges::LockstepService& lockstep)
      : buses_(buses), journal_(journal), service_(service), lockstep_(lockstep) {}

  /// Records all inputs from now on.  `too_much` is called when they exceed the limit.
  void keep(std::size_t max_bytes, std::function<void()> too_much);
  std::size_t bytes() const { return bytes_; }
  void discard_before(std::int64_t step);
  /// Discards the inputs of this step and later.
  void discard_from(std::int64_t step);

  /// Starts a replay: from here on nothing is sent, and incoming messages are discarded.
  void restart_replay(std::int64_t from_step);
  /// Delivers the recorded inputs after the reports of a step, up to the next.
  void deliver(std::int64_t step);
  /// To be called after each repeated step except the last one.
  void pass(std::int64_t step) { lockstep_.pass_again(step); }
  /// Returns the step to start from, so that lockstep clients receive at `step` what they received the first time.
  std::int64_t needed_from(std::int64_t step, std::int64_t max_steps) const {
    return lockstep_.needed_from(step, max_steps);
  }
  void end_replay();
  /// Names of the lockstep clients, separated by commas; empty: none.
  std::string clients() const { return lockstep_.names(); }

 private:
  struct Saved {
    std::int64_t step;
    bridges::RunJournal::Input input;
    std::size_t bytes() const;
  };
  void deliver(const bridges::RunJournal::Input& input);

  RunBuses& buses_;
  bridges::RunJournal& journal_;
  bridges::SimService& service_;
  bridges::LockstepService& lockstep_;
  std::deque<Saved> kept_;
  std::size_t bytes_ = 0;
  std::size_t next_ = 0;  ///< index of the next input to be delivered
};

}  // namespace experiment
