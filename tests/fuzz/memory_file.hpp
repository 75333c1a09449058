// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "tests/fuzz/fuzz_target.hpp"

namespace fuzz {

/// A file that is in memory only, for parsers that want a path.
class MemoryFile {
 public:
  explicit MemoryFile(Input content) : number_(memfd_create("fuzz", MFD_CLOEXEC)) {
    std::size_t done = 0;
    while (done < content.size()) {
      const ssize_t now = ::write(number_, content.data() + done, content.size() - done);
      if (now <= 0) std::abort();
      done += static_cast<std::size_t>(now);
    }
  }
  ~MemoryFile() { ::close(number_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(number_); }

 private:
  int number_;
};

}  // namespace fuzz
