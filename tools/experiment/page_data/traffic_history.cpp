// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/page_data/traffic_history.hpp"

#include <algorithm>
#include <limits>

namespace tools {

void TrafficHistory::set(Values& values, std::uint32_t marks, std::int64_t value) {
  if ((values.empty() ? 0 : values.back().value) != value) values.push_back({marks, value});
}

std::int64_t TrafficHistory::get(const Values& values, std::size_t marks) {
  const auto after = std::upper_bound(values.begin(), values.end(), marks,
                                      [](std::size_t number, const Value& value) { return number < value.marks; });
  return after == values.begin() ? 0 : std::prev(after)->value;
}

template <typename Use>
void TrafficHistory::for_each(Use&& use) {
  for (auto& [name, channel] : channels_) {
    use(channel.count);
    use(channel.bytes);
  }
  for (auto& [names, values] : sent_) use(values);
  for (auto& [names, values] : received_) use(values);
}

void TrafficHistory::mark(std::int64_t time_us, std::uint64_t offset, const TrafficCounts& counts) {
  marks_.push_back({time_us, offset});
  const auto marks = static_cast<std::uint32_t>(marks_.size());
  for (const auto& [name, channel] : counts.channels()) {
    ChannelValues& values = channels_[name];
    values.fingerprint = channel.fingerprint;
    set(values.count, marks, channel.count);
    set(values.bytes, marks, channel.bytes);
  }
  for (const auto& [names, number] : counts.sent_) set(sent_[names], marks, number);
  for (const auto& [names, pair] : counts.pairs()) {
    set(received_[{names.first, names.second, ""}], marks, pair.received);
    for (const auto& [outcome, number] : pair.lost) set(received_[{names.first, names.second, outcome}], marks, number);
  }
}

bool TrafficHistory::rewind(std::int64_t time_us) {
  if (marks_.empty() || marks_.back().time_us <= time_us) return false;
  while (!marks_.empty() && marks_.back().time_us > time_us) marks_.pop_back();
  for_each([this](Values& values) {
    while (!values.empty() && values.back().marks > marks_.size()) values.pop_back();
  });
  return true;
}

std::int64_t TrafficHistory::last_us() const {
  return marks_.empty() ? std::numeric_limits<std::int64_t>::min() : marks_.back().time_us;
}

TrafficCounts TrafficHistory::restore(std::size_t marks) const {
  TrafficCounts counts;
  for (const auto& [name, values] : channels_)
    if (const std::int64_t count = get(values.count, marks); count > 0)
      counts.channels_[name] = {values.fingerprint, count, get(values.bytes, marks)};
  for (const auto& [names, values] : sent_)
    if (const std::int64_t number = get(values, marks); number > 0) counts.sent_[names] = number;
  for (const auto& [key, values] : received_) {
    const std::int64_t number = get(values, marks);
    if (number == 0) continue;
    const auto& [from, to, outcome] = key;
    TrafficCounts::Pair& pair = counts.pairs_[{from, to}];
    (outcome.empty() ? pair.received : pair.lost[outcome]) = number;
  }
  return counts;
}

TrafficHistory::Point TrafficHistory::before(std::uint64_t offset) const {
  const auto after = std::upper_bound(marks_.begin(), marks_.end(), offset,
                                      [](std::uint64_t place, const Mark& mark) { return place < mark.offset; });
  if (after == marks_.begin()) return {};
  return {restore(static_cast<std::size_t>(after - marks_.begin())), std::prev(after)->offset};
}

}  // namespace tools
