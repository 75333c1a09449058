// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep/answer_history.hpp"

#include <algorithm>

#include "sim/base/state_hash.hpp"

namespace bridges {

namespace {

std::uint64_t hash_of_list(const shoal::sim_ack_t& ack) {
  sim::StateHash hash;
  for (std::size_t i = 0; i < ack.channel.size(); ++i) {
    hash.add_bytes(ack.channel[i].c_str(), ack.channel[i].size() + 1);
    hash.add_bytes(&ack.crc[i], sizeof ack.crc[i]);
  }
  return hash.value();
}

std::string list_text(bool listed, std::int32_t count) {
  if (!listed) return "does not list what was published";
  return "lists " + std::to_string(count) + (count == 1 ? " message" : " messages");
}

}  // namespace

std::optional<std::string> AnswerHistory::add(const shoal::sim_ack_t& ack) {
  if (ack.session != 0 && ack.sequence == 0) return std::nullopt;  // only a sign of life
  const Answer answer{ack.session, ack.sequence, ack.step, ack.listed != 0, ack.count, hash_of_list(ack)};
  const auto first = std::find_if(answers_.begin(), answers_.end(), [&](const Answer& each) {
    return each.session == answer.session && each.sequence == answer.sequence &&
           (answer.session != 0 || each.step == answer.step);
  });
  if (first == answers_.end()) {
    answers_.push_back(answer);
    if (answers_.size() > max_answers) answers_.pop_front();
    return std::nullopt;
  }
  if (first->step != answer.step)
    return "one is for step " + std::to_string(first->step) + ", the other for step " + std::to_string(answer.step);
  if (first->listed == answer.listed && first->count == answer.count && first->hash == answer.hash) return std::nullopt;
  if (first->listed == answer.listed && first->count == answer.count)
    return "both list " + std::to_string(answer.count) + (answer.count == 1 ? " message" : " messages") +
           ", but not the same";
  return "one " + list_text(first->listed, first->count) + ", the other " + list_text(answer.listed, answer.count);
}

void AnswerHistory::set_branch() {
  std::erase_if(answers_, [](const Answer& each) { return each.session == 0; });
}

}  // namespace bridges
