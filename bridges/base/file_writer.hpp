// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>
#include <vector>

#include "bridges/base/file_descriptor.hpp"

namespace bridges {

/// Writes a file on its own thread, in order.  The caller waits only while two blocks are pending: the disk is
/// then too slow, and nothing may be lost.
class FileWriter {
 public:
  struct Block {
    std::vector<std::byte> bytes;
    std::size_t used = 0;  ///< of them, from the first on
  };

  explicit FileWriter(FileDescriptor file);
  /// Writes what was handed over.
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  /// Takes the block, and returns an empty one that reuses memory.  False when an earlier write failed; errno has the
  /// reason.  Nothing is written after that.
  bool hand_over(Block& block);
  /// Waits until all is written.  False when the write failed; errno has the reason.
  bool finish();

 private:
  void write_all();
  bool write(const Block& block);

  FileDescriptor file_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Block next_;         // handed over; empty when nothing waits
  bool busy_ = false;  // the thread writes
  bool ending_ = false;
  int error_ = 0;       // errno of the first failure
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace bridges
