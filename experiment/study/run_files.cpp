// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/run_files.hpp"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "bridges/base/file_descriptor.hpp"
#include "experiment/files/file_replacement.hpp"
#include "experiment/files/no_links.hpp"
#include "experiment/study/study_algorithms.hpp"

namespace experiment {
namespace {

std::string stamp_path(const std::string& directory) {
  return directory + "/study_stamp.txt";
}

std::string failure_path(const std::string& directory) {
  return directory + "/study_failure.txt";
}

void write_mark(const std::string& directory, const std::string& path, const std::string& text) {
  refuse_links(directory, path);
  write_whole_file(path, text);
}

/// Reads a file of two lines: `inputs HASH`, and a second one after `word`.  Nothing for any other content.
std::optional<std::pair<std::string, std::string>> read_mark(const std::string& path, const std::string& word) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  std::string text;
  try {
    text = read_whole_file(path);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
  const std::string first = "inputs ", second = "\n" + word + " ";
  if (!text.starts_with(first) || !text.ends_with('\n') || text.find(second) != first.size() + 16) return std::nullopt;
  const std::size_t begin = first.size() + 16 + second.size();
  return std::pair(text.substr(first.size(), 16), text.substr(begin, text.size() - begin - 1));
}

}  // namespace

std::optional<RunStamp> read_stamp(const std::string& directory) {
  const auto mark = read_mark(stamp_path(directory), "shoal");
  return mark ? std::optional(RunStamp{mark->first, mark->second}) : std::nullopt;
}

void write_stamp(const std::string& directory, const RunStamp& stamp) {
  write_mark(directory, stamp_path(directory), "inputs " + stamp.inputs + "\nshoal " + stamp.version + "\n");
}

std::optional<RunFailure> read_failure(const std::string& directory) {
  const auto mark = read_mark(failure_path(directory), "failed");
  return mark ? std::optional(RunFailure{mark->first, mark->second}) : std::nullopt;
}

void write_failure(const std::string& directory, const RunFailure& failure) {
  write_mark(directory, failure_path(directory), "inputs " + failure.inputs + "\nfailed " + failure.reason + "\n");
}

void remove_marks(const StudyRun& run) {
  const std::string& directory = run.directory;
  std::error_code ignored;
  for (const std::string& path : {stamp_path(directory), failure_path(directory), directory + "/summary.json",
                                  record_of(run), algorithm_scores_of(run)}) {
    refuse_links(directory, path);
    std::filesystem::remove(path, ignored);
  }
}

RunClaim::RunClaim(const std::string& root, const std::string& directory) {
  make_folders(root, directory);
  const std::string path = directory + "/study_claim";
  refuse_links(root, path);
  file_ = bridges::FileDescriptor(open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (file_.number() < 0) throw std::runtime_error(path + ": cannot be opened: " + std::strerror(errno));
  owner_ = bridges::lock_against_others(file_.number());
  if (owner_) return;
  // The runner may have been killed a moment ago, while its `shoal run` still ends: that locks the folder itself.
  const bridges::FileDescriptor folder(open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.number() >= 0) owner_ = bridges::lock_against_others(folder.number());
  if (owner_) file_ = bridges::FileDescriptor();
}

}  // namespace experiment
