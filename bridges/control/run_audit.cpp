// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/control/run_audit.hpp"

#include "shoal/message_codec.hpp"
#include "shoal/sim_audit_t.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world.hpp"

namespace bridges {

void RunAudit::add(AuditEntry audit_entry, std::int32_t branch) {
  // The texts come from clients: no control characters may reach a terminal that shows the audit.
  for (std::string* text : {&audit_entry.client, &audit_entry.signer, &audit_entry.text})
    *text = sim::shortened(sim::printable(*text), 300);
  audit_entry.sim_time_s = sim::to_seconds(world_.now());
  ++count_;
  if (count_ <= static_cast<std::int64_t>(max_published)) {
    shoal::sim_audit_t message{};
    message.utime = world_.epoch_us() + world_.now().count();
    message.step = world_.step_number();
    message.branch = branch;
    message.kind = audit_entry.kind;
    message.client = audit_entry.client;
    message.signer = audit_entry.signer;
    message.text = audit_entry.text;
    shoal::encode_into(message, buffer_);
    bus_.publish("sim.audit", buffer_, world_.now());
  }
  // The first ones are kept, since an attack must not be able to push them out.
  if (all_.size() < max_kept) all_.push_back(std::move(audit_entry));
}

std::string who_asked(const std::string& client, const std::string& signer) {
  const std::string called = "client '" + sim::shortened(sim::printable(client)) + "'";
  if (signer.empty() || signer == client) return called;
  return called + " (signed by '" + sim::shortened(sim::printable(signer)) + "')";
}

}  // namespace bridges
