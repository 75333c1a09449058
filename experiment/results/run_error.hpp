// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace experiment {

/// Error that ends the run, with its exit code and its name in the summary.
struct RunError : std::runtime_error {
  RunError(int code, std::string how_ended, const std::string& text)
      : std::runtime_error(text), exit_code(code), ended(std::move(how_ended)) {}
  int exit_code;
  std::string ended;
};

}  // namespace experiment
