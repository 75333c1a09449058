// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>
#include <vector>

#include "bridges/base/file_descriptor.hpp"

namespace bridges {

/// Writer of a file in its own thread, in order.  The caller blocks only while two blocks are pending, when the disk is
/// too slow, because no data may be lost.
class FileWriter {
 public:
  struct Block {
    std::vector<std::byte> bytes;
    std::size_t used = 0;  ///< number of used bytes, from the first
  };

  explicit FileWriter(FileDescriptor file);
  /// Writes the pending blocks.
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  /// Takes the block, and replaces it by an empty one that reuses memory.  Returns false when an earlier write failed;
  /// errno has the reason.  Nothing is written after that.
  bool hand_over(Block& block);
  /// Waits until everything is written.  Returns false when a write failed; errno has the reason.
  bool finish();

 private:
  void write_all();
  bool write(const Block& block);

  FileDescriptor file_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Block next_;         // pending block; empty when there is none
  bool busy_ = false;  // the thread is writing
  bool ending_ = false;
  int error_ = 0;       // errno of the first failure
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace bridges
