#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bridges/lcm/run_notices.hpp"

namespace tools {

/// The entries of `notices` in summary.json.
nlohmann::ordered_json notices_json(const std::vector<bridges::RunNotice>& notices);

/// One line: `quit at 12.30 s by client 'shoal-control-4711'`.
std::string notice_text(const bridges::RunNotice& notice);

}  // namespace tools
