// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bridges/base/file_descriptor.hpp"

namespace navigation {

/// File of the host in Python, embedded in the program.
struct HostFile {
  const char* path;
  const unsigned char* begin;
  const unsigned char* end;
};

/// Interpreter in a child process that has the estimators of one class.
class PythonHost {
 public:
  /// Starts /usr/bin/python3, or the interpreter in SHOAL_PYTHON, and loads the class from a file. SHOAL_PYTHON_LIMIT_S
  /// is the wall time for an answer, without it 60 s.  Throws std::invalid_argument with the reason.
  PythonHost(const std::string& file, const std::string& class_name);
  ~PythonHost();
  PythonHost(const PythonHost&) = delete;
  PythonHost& operator=(const PythonHost&) = delete;

  /// Sends a request that has no answer.  Throws EstimatorFailure when the interpreter has ended, or takes no request
  /// within the limit.
  void send(const nlohmann::json& request);
  /// Sends a request and returns its answer.  Throws EstimatorFailure, too, with the error of the estimator; for a
  /// ValueError of start() std::invalid_argument: it cannot work with this set-up.
  nlohmann::json request(const nlohmann::json& request);
  /// Whether the class has on_bearing(), for relative measurements of other vehicles.
  bool has_on_bearing() const { return has_on_bearing_; }
  /// Returns the CPU time that the interpreter has used so far; after its end 0.
  double cpu_s() const;
  /// Returns a number for a new estimator.
  int new_number() { return ++last_number_; }

 private:
  void end();
  /// Waits until a descriptor is ready for `events`.  Throws when that takes longer than the limit.
  void wait_for(const bridges::FileDescriptor& descriptor, short events, const nlohmann::json& request);

  std::string what_;
  double limit_s_;  ///< wall time for an answer
  pid_t child_ = -1;
  bridges::FileDescriptor to_child_, from_child_;
  std::string unread_;
  bool has_on_bearing_ = false;
  bool is_stuck_ = false;  ///< it gave no answer in time
  int last_number_ = 0;
};

}  // namespace navigation
