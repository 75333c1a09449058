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
  /// Starts /usr/bin/python3, or the interpreter in SHOAL_PYTHON, and loads the class from a file.  Throws
  /// std::invalid_argument with the reason.
  PythonHost(const std::string& file, const std::string& class_name);
  ~PythonHost();
  PythonHost(const PythonHost&) = delete;
  PythonHost& operator=(const PythonHost&) = delete;

  /// Sends a request that has no answer.
  void send(const nlohmann::json& request);
  /// Sends a request and returns its answer.  Throws std::invalid_argument with the error of the estimator.
  nlohmann::json request(const nlohmann::json& request);
  /// Whether the class has saw(), for sights of other vehicles.
  bool has_saw() const { return has_saw_; }
  /// Returns a number for a new estimator.
  int new_number() { return ++last_number_; }

 private:
  void end();

  std::string what_;
  pid_t child_ = -1;
  bridges::FileDescriptor to_child_, from_child_;
  std::string unread_;
  bool has_saw_ = false;
  int last_number_ = 0;
};

}  // namespace navigation
