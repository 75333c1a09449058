// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace experiment {

/// Quotes a word for a POSIX shell, if that is necessary.
std::string shell_word(const std::string& word);

}  // namespace experiment
