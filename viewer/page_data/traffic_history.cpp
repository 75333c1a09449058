// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/traffic_history.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace viewer {

void TrafficHistory::set(Values& values, std::uint32_t marks, std::int64_t value) {
  if ((values.empty() ? 0 : values.back().value) == value) return;
  values.push_back({marks, value});
  ++size_;
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
  for (auto& [name, sender] : senders_) {
    use(sender.count);
    use(sender.bytes);
    use(sender.sending_us);
  }
  for (auto& [names, values] : links_) use(values);
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
  for (const auto& [name, sender] : counts.senders()) {
    SenderValues& values = senders_[name];
    set(values.count, marks, sender.count);
    set(values.bytes, marks, sender.bytes);
    set(values.sending_us, marks, sender.sending_us);
  }
  for (const auto& [names, pair] : counts.pairs()) {
    set(links_[{names.first, names.second, ""}], marks, pair.received);
    for (const auto& [outcome, number] : pair.lost) set(links_[{names.first, names.second, outcome}], marks, number);
  }
  // Pages draw about as many points as they have pixels, so a long log is kept more coarsely instead of growing
  // without limit.
  if (size_ > limit_) thin();
}

void TrafficHistory::thin() {
  // In the older half only marks at least twice the average distance apart stay: at most half of them.
  const std::size_t older = marks_.size() / 2;
  const std::int64_t span_us = marks_[older].time_us - marks_[0].time_us;
  const std::int64_t apart_us = 2 * span_us / static_cast<std::int64_t>(std::max<std::size_t>(1, older));
  std::vector<std::uint32_t> renumbered(marks_.size() + 1);  // by the old number, from 1: that of the next to stay
  std::vector<Mark> kept;
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    renumbered[i + 1] = static_cast<std::uint32_t>(kept.size()) + 1;
    if (i >= older || kept.empty() || marks_[i].time_us - kept.back().time_us >= apart_us) kept.push_back(marks_[i]);
  }
  marks_ = std::move(kept);
  // If several values now begin at the same mark, the last one holds.
  size_ = 0;
  for_each([&](Values& values) {
    Values left;
    for (const Value& value : values) {
      const std::uint32_t marks = renumbered[value.marks];
      if (!left.empty() && left.back().marks == marks) left.pop_back();
      left.push_back({marks, value.value});
    }
    values = std::move(left);
    size_ += values.size();
  });
}

bool TrafficHistory::rewind(std::int64_t time_us) {
  if (marks_.empty() || marks_.back().time_us <= time_us) return false;
  while (!marks_.empty() && marks_.back().time_us > time_us) marks_.pop_back();
  for_each([this](Values& values) {
    while (!values.empty() && values.back().marks > marks_.size()) {
      values.pop_back();
      --size_;
    }
  });
  return true;
}

std::int64_t TrafficHistory::last_us() const {
  return marks_.empty() ? std::numeric_limits<std::int64_t>::min() : marks_.back().time_us;
}

TrafficCounts TrafficHistory::restore(std::size_t marks) const {
  TrafficCounts counts;
  for (const auto& [name, values] : channels_)
    // What had not appeared at this mark must not be listed with zeros.
    if (const std::int64_t count = get(values.count, marks); count > 0)
      counts.channels_[name] = {values.fingerprint, count, get(values.bytes, marks)};
  for (const auto& [names, values] : sent_)
    if (const std::int64_t number = get(values, marks); number > 0) counts.sent_[names] = number;
  for (const auto& [name, values] : senders_)
    if (const std::int64_t count = get(values.count, marks); count > 0)
      counts.senders_[name] = {count, get(values.bytes, marks), get(values.sending_us, marks)};
  for (const auto& [key, values] : links_) {
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

}  // namespace viewer
