// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdlib.h>

#include <clocale>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace test_support {

/// While it lives, the process has the numbers of de_DE: 1,5 for one and a half.  The locale is made here, so that the
/// test depends on no package of the machine.
class CommaLocale {
 public:
  CommaLocale() {
    // localedef fails for the other categories, which are not defined, and writes this one.
    const std::string make =
        "localedef -c -i '" + source_path("tests/comma_locale.txt") + "' '" + folder_.file("comma") + "' 2> /dev/null";
    [[maybe_unused]] const int exit_code = std::system(make.c_str());
    setenv("LOCPATH", folder_.file("").c_str(), 1);
    char text[8];
    if (std::setlocale(LC_NUMERIC, "comma") == nullptr || std::snprintf(text, sizeof text, "%.1f", 1.5) != 3 ||
        std::string(text) != "1,5")
      throw std::runtime_error("no locale with a comma: " + make);
  }
  ~CommaLocale() {
    std::setlocale(LC_NUMERIC, "C");
    unsetenv("LOCPATH");
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

 private:
  ScratchFolder folder_;
};

}  // namespace test_support
