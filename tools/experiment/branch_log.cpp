#include "tools/experiment/branch_log.hpp"

#include <algorithm>
#include <filesystem>

namespace tools {

void BranchLog::mark(std::int64_t step, std::int64_t oldest) {
  while (!marks_.empty() && marks_.front().step < oldest) marks_.pop_front();
  marks_.push_back({step, buses_.record_mark(), journal_.sequence()});
}

void BranchLog::check(std::int32_t branch) const {
  std::error_code error;
  if (record_.empty() || overwrite_ || !std::filesystem::exists(file_of(branch), error)) return;
  throw bridges::BusError(file_of(branch) + ": exists already; the record of the branch would go there");
}

void BranchLog::branch(std::int32_t branch, std::int64_t step, bool ours) {
  while (!marks_.empty() && marks_.back().step > step) marks_.pop_back();
  Mark mark{step, {}, 1};  // not from the start: the gap in the numbers says so
  if (ours && !marks_.empty() && marks_.back().step == step) mark = marks_.back();
  if (!ours) marks_.clear();
  journal_.begin_branch(branch, mark.sequence);
  if (!record_.empty()) buses_.branch_record(file_of(branch), mark.record, overwrite_);
}

std::string BranchLog::file_of(std::int32_t branch) const {
  const std::filesystem::path path(record_);
  const std::string name = path.stem().string() + ".branch" + std::to_string(branch) + path.extension().string();
  return (path.parent_path() / name).string();
}

}  // namespace tools
