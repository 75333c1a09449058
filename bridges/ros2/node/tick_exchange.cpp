// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/node/tick_exchange.hpp"

#include <algorithm>
#include <utility>

#include "bridges/ros2/cdr.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "bridges/ros2/ros2_schema.hpp"

namespace bridges::ros2 {

std::string Tick::schema() {
  return std::string(definition) + schema_separator + "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
}

std::vector<std::byte> encode(const Tick& tick) {
  std::vector<std::byte> cdr;
  CdrWriter out(cdr);
  put_time(out, tick.utime);
  out.put(tick.step);
  out.put(tick.branch);
  out.put(tick.last);
  out.put(std::string_view(tick.node));
  std::vector<std::uint32_t> counts, kept;
  out.put_count(tick.counts.size());
  for (const auto& [topic, count] : tick.counts) {
    out.put(std::string_view(topic));
    counts.push_back(count);
    if (const auto of_topic = tick.kept.find(topic); of_topic != tick.kept.end()) kept.push_back(of_topic->second);
  }
  out.put_sequence(std::span<const std::uint32_t>(counts));
  out.put_sequence(std::span<const std::uint32_t>(kept));
  return cdr;
}

Tick decode_tick(std::span<const std::byte> cdr) {
  constexpr std::size_t min_text_bytes = sizeof(std::uint32_t);
  CdrReader in(cdr);
  Tick tick;
  const auto seconds = in.get<std::int32_t>();
  tick.utime = std::int64_t{1'000'000} * seconds + in.get<std::uint32_t>() / 1000;
  tick.step = in.get<std::int64_t>();
  tick.branch = in.get<std::int32_t>();
  tick.last = in.get<bool>();
  tick.node = in.text();
  std::vector<std::string> topics(in.count(min_text_bytes));
  for (std::string& topic : topics) topic = in.text();
  if (in.count(sizeof(std::uint32_t)) != topics.size())
    throw shoal::MessageError("counts must have one value for each of topics");
  for (const std::string& topic : topics) tick.counts[topic] += in.get<std::uint32_t>();
  // A node may answer with the tick that it got, where only the topics are its own.
  const std::size_t kept = in.count(sizeof(std::uint32_t));
  for (std::size_t i = 0; i < kept; ++i) {
    const auto count = in.get<std::uint32_t>();
    if (kept == topics.size()) tick.kept[topics[i]] = count;
  }
  return tick;
}

void TickExchange::count(const std::string& topic, std::uint32_t depth) {
  ++counts_[topic];
  std::uint32_t& kept = kept_[topic];
  kept = std::min(kept + 1, depth);
}

const Tick& TickExchange::begin(std::int64_t utime, std::int64_t step, std::int32_t branch, bool last) {
  tick_ = {utime, step, branch, last, "", counts_, kept_};
  for (auto& [topic, count] : counts_) count = 0;
  answers_.clear();
  contested_.clear();
  return tick_;
}

bool TickExchange::add(const std::string& topic, std::optional<Command> command) {
  if (held_ == max_commands) return false;
  ++held_;
  commands_[topic].push_back(std::move(command));
  return true;
}

void TickExchange::take(const Tick& answer) {
  if (answer.step != tick_.step || answer.branch != tick_.branch) return;
  if (std::find(nodes_.begin(), nodes_.end(), answer.node) == nodes_.end()) return;
  for (const auto& [node, other] : answers_)
    for (const auto& [topic, count] : other.counts)
      if (const auto own = answer.counts.find(topic);
          node != answer.node && contested_.empty() && count > 0 && own != answer.counts.end() && own->second > 0)
        contested_ = topic;
  answers_[answer.node] = answer;
}

std::string TickExchange::missing() const {
  std::map<std::string, std::uint64_t> named;
  for (const std::string& node : nodes_) {
    const auto answer = answers_.find(node);
    if (answer == answers_.end()) return "the answer of '" + node + "'";
    for (const auto& [topic, count] : answer->second.counts) named[topic] += count;
  }
  for (const auto& [topic, count] : named) {
    const auto arrived = commands_.find(topic);
    if (count > (arrived == commands_.end() ? 0 : arrived->second.size())) return "a message on " + topic;
  }
  return "";
}

std::vector<TickExchange::Command> TickExchange::finish() {
  std::vector<Command> all;
  held_ = 0;
  for (auto& [topic, commands] : std::exchange(commands_, {}))
    for (std::optional<Command>& command : commands)
      if (command) all.push_back(std::move(*command));
  return all;
}

}  // namespace bridges::ros2
