// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bridges/control/run_audit.hpp"

namespace experiment {

/// Returns the entries of `control.audit` in summary.json.
nlohmann::ordered_json audit_json(const std::vector<bridges::AuditEntry>& audit);

/// Returns one line: `quit at 12.30 s by client 'shoal-control-4711'`.
std::string audit_text(const bridges::AuditEntry& audit_entry);

}  // namespace experiment
