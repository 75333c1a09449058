// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/world_files/watched_files.hpp"

namespace experiment {

namespace {

constexpr std::chrono::milliseconds look_interval{250};

void collect_files(const sim::ConfigNode& node, std::set<std::string>& files) {
  if (node.place.file != nullptr) files.insert(*node.place.file);
  for (const sim::ConfigNode& item : node.items) collect_files(item, files);
  for (const sim::ConfigNode::Entry& entry : node.entries) {
    if (entry.place.file != nullptr) files.insert(*entry.place.file);
    collect_files(entry.value, files);
  }
}

}  // namespace

std::set<std::string> files_of(const sim::ConfigNode& tree) {
  std::set<std::string> files;
  collect_files(tree, files);
  return files;
}

WatchedFiles::State WatchedFiles::state_of(const std::string& path) {
  std::error_code error;
  State state;
  const auto size = std::filesystem::file_size(path, error);
  if (error) return state;
  const auto time = std::filesystem::last_write_time(path, error);
  if (error) return state;
  state.size = static_cast<std::int64_t>(size);
  state.time = time;
  return state;
}

void WatchedFiles::add(const std::set<std::string>& paths) {
  for (const std::string& path : paths) first_.try_emplace(path, state_of(path));
  last_ = first_;
}

bool WatchedFiles::changed() {
  if (changed_ || Clock::now() < next_look_) return changed_;
  next_look_ = Clock::now() + look_interval;
  for (const auto& [path, before] : first_) {
    const State state = state_of(path);
    const State previous = std::exchange(last_[path], state);
    // Editors that replace a file remove it for a moment.
    if (state != before && state == previous && state.size >= 0) changed_ = true;
  }
  return changed_;
}

}  // namespace experiment
