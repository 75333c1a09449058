// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/branch_log.hpp"

#include <algorithm>
#include <filesystem>

namespace experiment {

void BranchLog::mark(std::int64_t step, std::int64_t oldest) {
  // Keep the mark that is valid at the oldest step.
  while (marks_.size() > 1 && marks_[1].step <= oldest) marks_.pop_front();
  if (!marks_.empty() && marks_.back().step == step) return;  // start of this branch
  const bool same = !marks_.empty() && marks_.back().sequence == journal_.sequence();
  if (same && record_.empty()) return;
  marks_.push_back({step, buses_.record_mark(), journal_.sequence()});
}

void BranchLog::prepare(std::int32_t branch, std::int64_t step, bool ours) {
  next_ = {step, {}, journal_.sequence() + 1};  // not from the start: the gap in the numbers shows this
  const auto mark =
      std::find_if(marks_.rbegin(), marks_.rend(), [step](const Mark& known) { return known.step <= step; });
  if (ours && mark != marks_.rend()) next_ = *mark;
  next_is_ours_ = ours;
  if (record_.empty()) return;
  std::error_code error;
  if (!overwrite_ && std::filesystem::exists(file_of(branch), error))
    throw bridges::BusError(file_of(branch) + ": already exists; the record of the branch would be written there");
  buses_.prepare_record(file_of(branch), next_.record, overwrite_);
}

void BranchLog::branch(std::int32_t branch) {
  while (!marks_.empty() && (!next_is_ours_ || marks_.back().step > next_.step)) marks_.pop_back();
  journal_.start_branch(branch, next_.sequence);
  buses_.branch_record();
}

void BranchLog::give_up() {
  buses_.give_up_record();
}

std::string BranchLog::file_of(std::int32_t branch) const {
  const std::filesystem::path path(record_);
  const std::string name = path.stem().string() + ".branch" + std::to_string(branch) + path.extension().string();
  return (path.parent_path() / name).string();
}

}  // namespace experiment
