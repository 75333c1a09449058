// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "bridges/control/sim_service.hpp"
#include "bridges/lockstep/lockstep_service.hpp"
#include "bridges/log/run_journal.hpp"
#include "tools/experiment/run/run_buses.hpp"

namespace tools {

/// What came into a run from outside since a step, and a way to let it come in again.
class RunMail {
 public:
  /// All must outlive this.
  RunMail(RunBuses& buses, bridges::RunJournal& journal, bridges::SimService& service,
          bridges::LockstepService& lockstep)
      : buses_(buses), journal_(journal), service_(service), lockstep_(lockstep) {}

  /// Keeps all that comes from now on.  `too_much` is called when it is more than so many bytes.
  void keep(std::size_t most_bytes, std::function<void()> too_much);
  std::size_t bytes() const { return bytes_; }
  void forget_before(std::int64_t step);
  /// What came at this step and later.
  void forget_from(std::int64_t step);

  /// Nothing goes out from here on, and what comes in is thrown away.
  void begin_again(std::int64_t from_step);
  /// What came after the reports of a step, up to the next, takes effect again.
  void deliver(std::int64_t step);
  /// Call after each step that is run again, without the last one.
  void pass(std::int64_t step) { lockstep_.pass_again(step); }
  /// Where to begin, so that lockstep clients get at `step` what they got the first time.
  std::int64_t needed_from(std::int64_t step, std::int64_t most_steps) const {
    return lockstep_.needed_from(step, most_steps);
  }
  void end_again();
  /// Names of the lockstep clients, with commas between; empty: nobody takes part.
  std::string clients() const { return lockstep_.names(); }

 private:
  struct Kept {
    std::int64_t step;
    bridges::RunJournal::Letter letter;
    std::size_t bytes() const;
  };
  void deliver(const bridges::RunJournal::Letter& letter);

  RunBuses& buses_;
  bridges::RunJournal& journal_;
  bridges::SimService& service_;
  bridges::LockstepService& lockstep_;
  std::deque<Kept> kept_;
  std::size_t bytes_ = 0;
  std::size_t next_ = 0;  ///< to be delivered
};

}  // namespace tools
