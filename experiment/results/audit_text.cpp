// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/audit_text.hpp"

#include <spdlog/fmt/fmt.h>

namespace experiment {

nlohmann::ordered_json audit_json(const std::vector<bridges::AuditEntry>& audit) {
  auto json = nlohmann::ordered_json::array();
  for (const bridges::AuditEntry& audit_entry : audit)
    json.push_back({{"sim_time_s", audit_entry.sim_time_s},
                    {"kind", audit_entry.kind},
                    {"client", audit_entry.client},
                    {"signed_by", audit_entry.signer},
                    {"text", audit_entry.text}});
  return json;
}

std::string audit_text(const bridges::AuditEntry& audit_entry) {
  if (audit_entry.kind == "contradiction")
    return fmt::format("{} (at {:.2f} s)", audit_entry.text, audit_entry.sim_time_s);
  return fmt::format("{}{}{} at {:.2f} s by {}", audit_entry.kind, audit_entry.text.empty() ? "" : " ",
                     audit_entry.text, audit_entry.sim_time_s,
                     bridges::who_asked(audit_entry.client, audit_entry.signer));
}

}  // namespace experiment
