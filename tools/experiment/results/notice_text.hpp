// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bridges/control/run_notices.hpp"

namespace tools {

/// The entries of `notices` in summary.json.
nlohmann::ordered_json notices_json(const std::vector<bridges::RunNotice>& notices);

/// One line: `quit at 12.30 s by client 'shoal-control-4711'`.
std::string notice_text(const bridges::RunNotice& notice);

}  // namespace tools
