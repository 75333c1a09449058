// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bridges/base/file_descriptor.hpp"
#include "motion/record/take.hpp"

namespace motion {

/// File that holds a recording while it lasts, in the format of parse_take().  Each frame is handed to the system
/// before it is played, so that it outlives the program however that ends; it may be lost when the machine loses its
/// power.
class TakeJournal {
 public:
  /// Creates the file and locks it.  Throws std::runtime_error when it exists, or cannot be written.
  TakeJournal(std::string path, const TakeSettings& settings);

  /// Appends a frame: the values of all joints, rad or m.
  void frame(std::span<const double> values);
  void change(double at_s, const sim::ConfigNode& action);
  void back(std::int64_t frame);
  const std::string& path() const { return path_; }

 private:
  void write(const std::string& text);

  std::string path_;
  bridges::FileDescriptor file_;
  std::vector<double> before_;  ///< empty: the next frame has all values
};

/// Returns whether a process has the journal locked.
bool is_recording(const std::string& journal);

}  // namespace motion
