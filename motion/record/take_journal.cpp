// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/take_journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"

namespace motion {

TakeJournal::TakeJournal(std::string path, const TakeSettings& settings)
    : path_(std::move(path)), file_(open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666)) {
  if (file_.number() < 0) throw std::runtime_error("'" + path_ + "' cannot be created: " + std::strerror(errno));
  flock(file_.number(), LOCK_EX | LOCK_NB);
  write(std::string(take_head) + settings.text() + "\n");
}

void TakeJournal::write(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t written = ::write(file_.number(), text.data() + at, text.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw std::runtime_error("'" + path_ + "' cannot be written: " + std::strerror(errno));
    at += static_cast<std::size_t>(written);
  }
}

void TakeJournal::frame(std::span<const double> values) {
  std::string line = "f";
  for (std::size_t i = 0; i < values.size(); ++i)
    if (before_.empty() || std::memcmp(&values[i], &before_[i], sizeof(double)) != 0)
      line += " " + std::to_string(i) + "=" + sim::number_text(values[i]);
  write(line + "\n");
  before_.assign(values.begin(), values.end());
}

void TakeJournal::change(double at_s, const sim::ConfigNode& action) {
  write("c " + sim::number_text(at_s) + " " + sim::to_flow_yaml(action) + "\n");
}

void TakeJournal::back(std::int64_t frame) {
  write("b " + std::to_string(frame) + "\n");
  before_.clear();
}

bool is_recording(const std::string& journal) {
  const bridges::FileDescriptor file(open(journal.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));  // not for a pipe
  return file.number() >= 0 && flock(file.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace motion
