// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "bridges/log/run_journal.hpp"
#include "tools/experiment/run/run_buses.hpp"

namespace tools {

/// The records of a run's branches: each branch has its own file, which starts with a copy of its parent's up to the
/// step where they part.
class BranchLog {
 public:
  /// `record`: of branch 0; empty: there is none.  All must outlive this.
  BranchLog(RunBuses& buses, bridges::RunJournal& journal, const std::string& record, bool overwrite)
      : buses_(buses), journal_(journal), record_(record), overwrite_(overwrite) {}

  /// Call after each step whose messages are out.  `oldest`: the earliest step of a rewind.
  void mark(std::int64_t step, std::int64_t oldest);
  /// Prepares a branch that starts at `step`.  `ours`: the step is from this run; otherwise the log restarts.
  ///   Throws BusError when the file cannot be made, or is there already and may not be replaced; nothing has
  /// changed then.
  void prepare(std::int32_t branch, std::int64_t step, bool ours);
  /// It has gone there.
  void branch(std::int32_t branch);
  /// Discards the prepared branch; the run stays on the current one.
  void give_up();
  /// `coop.lcm` becomes `coop.branch2.lcm`.
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
  Mark next_{};  ///< of the branch that is prepared
  bool next_is_ours_ = false;
};

}  // namespace tools
