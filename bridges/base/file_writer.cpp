// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/base/file_writer.hpp"

#include <unistd.h>

#include <cerrno>
#include <utility>

namespace bridges {

FileWriter::FileWriter(FileDescriptor file) : file_(std::move(file)), thread_([this] { write_all(); }) {}

FileWriter::~FileWriter() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

bool FileWriter::hand_over(Block& block) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return next_.used == 0; });
  if (error_ == 0) std::swap(next_, block);
  block.used = 0;
  const int error = error_;
  lock.unlock();
  changed_.notify_all();
  errno = error;
  return error == 0;
}

bool FileWriter::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return next_.used == 0 && !busy_; });
  errno = error_;
  return error_ == 0;
}

void FileWriter::write_all() {
  Block block;
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return next_.used > 0 || ending_; });
    if (next_.used == 0) return;
    std::swap(next_, block);
    busy_ = true;
    const bool lost = error_ != 0;  // a write failed while this block was pending
    lock.unlock();
    changed_.notify_all();
    const int error = lost || write(block) ? 0 : (errno != 0 ? errno : EIO);
    block.used = 0;
    lock.lock();
    busy_ = false;
    if (error_ == 0) error_ = error;
    changed_.notify_all();
  }
}

bool FileWriter::write(const Block& block) {
  for (std::size_t done = 0; done < block.used;) {
    errno = 0;
    const ssize_t now = ::write(file_.number(), block.bytes.data() + done, block.used - done);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) return false;
    done += static_cast<std::size_t>(now);
  }
  return true;
}

}  // namespace bridges
