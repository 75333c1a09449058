// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/control/run_notices.hpp"

#include "shoal/message_codec.hpp"
#include "shoal/sim_notice_t.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world.hpp"

namespace bridges {

void RunNotices::add(RunNotice notice, std::int32_t branch) {
  for (std::string* text : {&notice.client, &notice.signer, &notice.text})
    *text = sim::shortened(sim::printable(*text), 300);
  notice.sim_time_s = sim::to_seconds(world_.now());
  ++count_;
  if (count_ <= static_cast<std::int64_t>(max_published)) {
    shoal::sim_notice_t message;
    message.utime = world_.epoch_us() + world_.now().count();
    message.step = world_.step_number();
    message.branch = branch;
    message.kind = notice.kind;
    message.client = notice.client;
    message.signer = notice.signer;
    message.text = notice.text;
    shoal::encode_into(message, buffer_);
    bus_.publish("sim.notice", buffer_, world_.now());
  }
  if (all_.size() < max_kept) all_.push_back(std::move(notice));
}

std::string who_asked(const std::string& client, const std::string& signer) {
  const std::string called = "client '" + sim::shortened(sim::printable(client)) + "'";
  if (signer.empty() || signer == client) return called;
  return called + " (signed by '" + sim::shortened(sim::printable(signer)) + "')";
}

}  // namespace bridges
