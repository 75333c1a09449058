// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/summary_file.hpp"

#include <fcntl.h>
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "experiment/results/results_folder.hpp"

namespace experiment {
namespace {

std::runtime_error cannot_write(const std::string& path, int error_number) {
  return std::runtime_error(cannot_write_text(path, error_number));
}

void write_all(int file, const std::string& text, const std::string& path) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t now = pwrite(file, text.data() + done, text.size() - done, static_cast<off_t>(done));
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) throw cannot_write(path, now < 0 ? errno : EIO);
    done += static_cast<std::size_t>(now);
  }
}

}  // namespace

void remove_link(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_symlink(path, ignored) && !std::filesystem::is_character_file(path, ignored))
    std::filesystem::remove(path, ignored);
}

SummaryFile::SummaryFile(const std::string& directory, std::size_t bytes) : path_(directory + "/summary.json") {
  try {
    make_room(path_ + ".part2", bytes);
    make_room(path_ + ".part", bytes);
  } catch (...) {
    for (const Room& room : rooms_) unlink(room.path.c_str());
    throw;
  }
}

SummaryFile::~SummaryFile() {
  for (const Room& room : rooms_) unlink(room.path.c_str());
}

void SummaryFile::make_room(const std::string& path, std::size_t bytes) {
  remove_link(path);
  bridges::FileDescriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (file.number() < 0) throw cannot_write(path, errno);
  rooms_.push_back({path, std::move(file)});
  int error = EINTR;
  while (error == EINTR) error = posix_fallocate(rooms_.back().file.number(), 0, static_cast<off_t>(bytes));
  // Some file systems cannot reserve space.
  if (error != 0 && error != EINVAL && error != EOPNOTSUPP) throw cannot_write(path, error);
}

void SummaryFile::write(const std::string& text) {
  // The room was reserved at the start, so that a full disk cannot prevent the summary.
  if (rooms_.empty()) make_room(path_ + ".part", text.size());
  const Room room = std::move(rooms_.back());
  rooms_.pop_back();
  write_all(room.file.number(), text, room.path);
  if (ftruncate(room.file.number(), static_cast<off_t>(text.size())) != 0 ||
      std::rename(room.path.c_str(), path_.c_str()) != 0) {
    const int error = errno;
    unlink(room.path.c_str());
    throw cannot_write(path_, error);
  }
}

nlohmann::ordered_json audit_json(const std::vector<bridges::AuditEntry>& audit) {
  auto json = nlohmann::ordered_json::array();
  for (const bridges::AuditEntry& audit_entry : audit)
    json.push_back({{"sim_time_s", audit_entry.sim_time_s},
                    {"kind", audit_entry.kind},
                    {"client", audit_entry.client},
                    {"signed_by", audit_entry.signer},
                    {"text", audit_entry.text}});
  return json;
}

std::string audit_text(const bridges::AuditEntry& audit_entry) {
  if (audit_entry.kind == "contradiction")
    return fmt::format("{} (at {:.2f} s)", audit_entry.text, audit_entry.sim_time_s);
  return fmt::format("{}{}{} at {:.2f} s by {}", audit_entry.kind, audit_entry.text.empty() ? "" : " ",
                     audit_entry.text, audit_entry.sim_time_s,
                     bridges::who_asked(audit_entry.client, audit_entry.signer));
}

nlohmann::ordered_json json_of(const RuleVerdict& verdict) {
  nlohmann::ordered_json json{{"rule", verdict.rule}, {"passed", verdict.passed}};
  json["left"] = verdict.left;  // NaN becomes null
  json["right"] = verdict.right;
  json["margin"] = verdict.margin;
  json["result"] = verdict.result;
  return json;
}

}  // namespace experiment
