// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "bridges/log/run_journal.hpp"
#include "experiment/run/run_buses.hpp"

namespace experiment {

/// Records of a run's branches: each branch has its own file, which starts with a copy of its parent's up to the step
/// of the branch point.
class BranchLog {
 public:
  /// `record`: file of branch 0; empty: no record.  All must outlive this.
  BranchLog(RunBuses& buses, bridges::RunJournal& journal, const std::string& record, bool overwrite)
      : buses_(buses), journal_(journal), record_(record), overwrite_(overwrite) {}

  /// Marks a step; to be called after all of its messages are written.  `oldest`: the earliest step of a rewind.
  void mark(std::int64_t step, std::int64_t oldest);
  /// Prepares a branch that starts at `step`.  `ours`: the step is from this run; otherwise the log restarts. Throws
  /// BusError, without any change, when the file cannot be created, or exists and must not be replaced.
  void prepare(std::int32_t branch, std::int64_t step, bool ours);
  /// Switches to the prepared branch after the rewind.
  void branch(std::int32_t branch);
  /// Discards the prepared branch; the run stays on the current one.
  void give_up();
  /// Returns the file of a branch: `coop.lcm` becomes `coop.branch2.lcm`.
  std::string file_of(std::int32_t branch) const;

 private:
  struct Mark {
    std::int64_t step;
    RunBuses::RecordMark record;
    std::int64_t sequence;
  };

  RunBuses& buses_;
  bridges::RunJournal& journal_;
  std::string record_;
  bool overwrite_;
  std::deque<Mark> marks_;
  Mark next_{};  ///< of the branch that is being prepared
  bool next_is_ours_ = false;
};

}  // namespace experiment
