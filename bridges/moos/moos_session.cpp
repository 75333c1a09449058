// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/moos_session.hpp"

#include <algorithm>
#include <utility>

namespace bridges {

MoosSession::MoosSession(MoosClientTerms terms, double wall_s)
    : terms_(std::move(terms)), heard_s_(wall_s), timing_s_(wall_s) {
  output_.resize(moos_greeting_bytes);
  std::transform(moos_greeting.begin(), moos_greeting.end(), output_.begin(),
                 [](char character) { return static_cast<std::byte>(character); });
  // The key tells the MOOSDB that it may send at any time; without it, it would only answer packets.
  MoosMessage hello = message_of(MoosType::data, "asynchronous", wall_s);
  hello.value_type = 'S';
  hello.text = terms_.name;
  send({&hello, 1});
}

MoosMessage MoosSession::message_of(MoosType type, const std::string& key, double wall_s) {
  MoosMessage message;
  message.type = type;
  message.key = key;
  message.source = terms_.name;
  message.time_s = wall_s * terms_.time_warp;
  message.id = next_id_++;
  return message;
}

void MoosSession::send(std::span<const MoosMessage> messages) {
  const std::vector<std::byte> packet = encode_moos_packet(messages);
  output_.insert(output_.end(), packet.begin(), packet.end());
}

void MoosSession::sent(std::size_t bytes) {
  output_.erase(output_.begin(), output_.begin() + static_cast<std::ptrdiff_t>(bytes));
}

void MoosSession::subscribe(double wall_s) {
  std::vector<MoosMessage> orders;
  for (const std::string& variable : terms_.variables) {
    const bool all = variable == "*";
    orders.push_back(message_of(all ? MoosType::subscribe_pattern : MoosType::subscribe, variable, wall_s));
    if (!all) continue;  // else the number is the least interval in seconds: 0
    orders.back().value_type = 'S';
    orders.back().text = "AppPattern=*,VarPattern=*,Interval=0";
  }
  if (!orders.empty()) send(orders);
}

void MoosSession::receive(std::span<const std::byte> bytes, double wall_s) {
  heard_s_ = wall_s;
  for (MoosMessage& message : reader_.add(bytes)) {
    if (message.type == MoosType::poison)
      throw MoosError("the MOOSDB refuses the client '" + terms_.name + "': " + message.text);
    if (!open_) {
      if (message.type != MoosType::welcome) throw MoosError("the MOOSDB answers the greeting with something else");
      if (message.text != "asynchronous")
        throw MoosError("the MOOSDB has no asynchronous clients: it is older than 10");
      open_ = true;
      community_ = message.community;
      subscribe(wall_s);
    } else if (message.type == MoosType::notify) {
      inbox_.push_back(std::move(message));
    }
  }
}

void MoosSession::notify(std::span<const MoosValue> values, double wall_s) {
  if (values.empty()) return;
  if (!open_ || output_.size() > max_waiting_bytes) {
    if (open_) dropped_ += values.size();
    return;
  }
  std::vector<MoosMessage> messages;
  for (const MoosValue& value : values) {
    MoosMessage& message = messages.emplace_back(message_of(MoosType::notify, value.key, wall_s));
    if (const double* number = std::get_if<double>(&value.value)) {
      message.number = *number;
    } else {
      message.value_type = 'S';
      message.text = std::get<std::string>(value.value);
    }
  }
  send(messages);
}

void MoosSession::keep_alive(double wall_s) {
  // Setting the wall clock back is not silence.
  heard_s_ = std::min(heard_s_, wall_s);
  timing_s_ = std::min(timing_s_, wall_s);
  if (wall_s - heard_s_ > silence_limit_s)
    throw MoosError(open_ ? "the MOOSDB is silent" : "the MOOSDB does not answer the greeting");
  if (!open_ || wall_s - timing_s_ < timing_period_s || output_.size() > max_waiting_bytes) return;
  timing_s_ = wall_s;
  MoosMessage timing = message_of(MoosType::timing, "_async_timing", wall_s);
  timing.time_s = wall_s;  // the MOOSDB compares it with its own clock, without the time warp
  send({&timing, 1});
}

}  // namespace bridges
