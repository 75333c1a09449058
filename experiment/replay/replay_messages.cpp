// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/replay/replay_messages.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "shoal/message_codec.hpp"
#include "shoal/sim_state_t.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

namespace {

/// Limit of messages that are read but not yet compared, where time stamps do not limit the search.
constexpr std::size_t max_queued_bytes = std::size_t{256} << 20;
/// In a record, messages published in a step have the time stamp of this step or the next.
constexpr std::int64_t steps_ahead = 2;

/// Returns whether a channel belongs to the run itself, so that another run has other messages on it, or describes the
/// world for viewers, which a replay does not do: state and hashes prove the same.
bool is_of_the_run(std::string_view channel) {
  if (!channel.starts_with("sim.")) return false;
  static constexpr std::array<std::string_view, 20> names{
      "sim.ack",    "sim.control", "sim.control.reply", "sim.hash",   "sim.info",   "sim.inputs", "sim.audit",
      "sim.resend", "sim.resent",  "sim.snapshot",      "sim.record", "sim.tick",   "sim.scene",  "sim.asset",
      "sim.bodies", "sim.sound",   "sim.sound.arrival", "sim.event",  "sim.scores", "sim.current"};
  return std::find(names.begin(), names.end(), channel) != names.end();
}

std::size_t hash_of(std::span<const std::byte> payload) {
  return std::hash<std::string_view>()({reinterpret_cast<const char*>(payload.data()), payload.size()});
}

bool same(std::span<const std::byte> a, std::span<const std::byte> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size()) == 0);
}

/// Returns the first member, when it is a time stamp.
std::optional<std::int64_t> stamp_of(const shoal::MessageSchema* schema, std::span<const std::byte> payload) {
  if (schema == nullptr || schema->members.empty() || schema->members.front().name != "utime" || payload.size() < 16)
    return std::nullopt;
  std::uint64_t value = 0;
  for (std::size_t i = 8; i < 16; ++i) value = value << 8 | std::to_integer<std::uint64_t>(payload[i]);
  return static_cast<std::int64_t>(value);
}

std::string in_words(const shoal::FieldValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* bytes = std::get_if<std::span<const std::byte>>(&value))
    return fmt::format("{} bytes", bytes->size());
  return "'" + sim::shortened(sim::printable(std::string(std::get<std::string_view>(value)))) + "'";
}

bool equal_values(const shoal::FieldValue& a, const shoal::FieldValue& b) {
  if (a.index() != b.index()) return false;
  if (const double* number = std::get_if<double>(&a)) {
    const double other = std::get<double>(b);
    return *number == other ? std::signbit(*number) == std::signbit(other) : std::isnan(*number) && std::isnan(other);
  }
  if (const auto* bytes = std::get_if<std::span<const std::byte>>(&a))
    return same(*bytes, std::get<std::span<const std::byte>>(b));
  if (const bool* flag = std::get_if<bool>(&a)) return *flag == std::get<bool>(b);
  if (const auto* integer = std::get_if<std::int64_t>(&a)) return *integer == std::get<std::int64_t>(b);
  return std::get<std::string_view>(a) == std::get<std::string_view>(b);
}

using Fields = std::vector<std::pair<std::string, shoal::FieldValue>>;

Fields fields_of(const shoal::MessageSchema& schema, std::span<const std::byte> payload) {
  Fields fields;
  shoal::visit_fields(schema, payload, [&](std::string_view name, const shoal::FieldValue& value) {
    fields.emplace_back(std::string(name), value);
  });
  return fields;
}

/// Describes the first member that differs.
std::string difference_of(const shoal::MessageSchema* schema, std::span<const std::byte> logged,
                          std::span<const std::byte> here) {
  if (shoal::fingerprint(logged) != shoal::fingerprint(here)) return "is of another type in the log";
  if (schema == nullptr) return "differs (of a type that is not known here)";
  const Fields there = fields_of(*schema, logged);
  const Fields own = fields_of(*schema, here);
  if (there.empty()) return "cannot be read in the log";
  for (std::size_t i = 0; i < std::min(there.size(), own.size()); ++i) {
    if (there[i].first != own[i].first) break;
    if (!equal_values(there[i].second, own[i].second))
      return fmt::format("{} is {} in the log and {} here", own[i].first, in_words(there[i].second),
                         in_words(own[i].second));
  }
  return fmt::format("has {} values in the log and {} here", there.size(), own.size());
}

}  // namespace

std::string message_difference(std::span<const std::byte> logged, std::span<const std::byte> here) {
  return difference_of(shoal::embedded_types().find(static_cast<std::uint64_t>(shoal::fingerprint(here))), logged,
                       here);
}

ReplayMessages::ReplayMessages(const ReplayLog& log) : log_(log), file_(log.path) {
  for (const auto& [name, count] : log.events)
    if (!is_of_the_run(name)) add(name).left = count;
  for (const ReplayLog::Input& input : log.inputs) {
    if (Channel* channel = find(input.channel)) channel->input_record.insert(hash_of(input.payload));
  }
}

ReplayMessages::Channel& ReplayMessages::add(std::string_view name) {
  const auto known = channels_.try_emplace(std::string(name)).first;
  known->second.name = known->first;
  by_name_.emplace(known->first, &known->second);
  return known->second;
}

ReplayMessages::Channel* ReplayMessages::find_next(std::string_view name, Channel*& last, Channel* Channel::*next) {
  Channel* found = last != nullptr ? last->*next : nullptr;
  if (found == nullptr || found->name != name) {
    found = find(name);
    if (found == nullptr) return nullptr;
    if (last != nullptr) last->*next = found;
  }
  return last = found;
}

std::optional<ReplayMessages::Payload> ReplayMessages::head(Channel& channel) {
  if (channel.left == 0) return std::nullopt;
  if (!channel.queue.empty()) return Payload(channel.queue.front());
  if (current_ == &channel) return event_.payload;
  while (channel.queue.empty() && !at_end_) {
    if (current_ != nullptr) {
      if (log_.own_stamps ? event_.utime > look_until_ : queued_bytes_ > max_queued_bytes) return std::nullopt;
      queued_bytes_ += event_.payload.size();
      current_->queue.emplace_back(event_.payload.begin(), event_.payload.end());
    }
    current_ = nullptr;
    if (!file_.next(event_)) {
      at_end_ = true;
      break;
    }
    current_ = find_next(event_.channel, last_read_, &Channel::next_read);
    if (current_ == &channel) return event_.payload;
  }
  return std::nullopt;
}

void ReplayMessages::pop(Channel& channel) {
  --channel.left;
  if (channel.queue.empty()) {  // it is the event that was read last
    current_ = nullptr;
    return;
  }
  queued_bytes_ -= channel.queue.front().size();
  channel.queue.pop_front();
}

bool ReplayMessages::is_input(Channel& channel, Payload payload) {
  if (channel.input_record.empty()) return false;
  const auto found = channel.input_record.find(hash_of(payload));
  if (found == channel.input_record.end()) return false;
  channel.input_record.erase(found);
  return true;
}

void ReplayMessages::published(std::string_view name, std::span<const std::byte> payload, std::int64_t step) {
  if (log_.is_rewound) return;
  // Find the channel.
  Channel* known = find_next(name, last_published_, &Channel::next_published);
  if (known == nullptr && is_of_the_run(name)) return;
  Channel& channel = known != nullptr ? *known : add(name);
  channel.published = true;
  look_until_ = log_.info.epoch_utime + (step + steps_ahead) * log_.info.step_us;
  while (const std::optional<Payload> logged = head(channel)) {
    if (same(*logged, payload)) {
      ++equal_;
      return pop(channel);
    }
    if (is_input(channel, *logged)) {
      pop(channel);
      continue;
    }
    // Compare the time stamps.
    const auto* schema = shoal::embedded_types().find(static_cast<std::uint64_t>(shoal::fingerprint(payload)));
    const bool one_type = shoal::fingerprint(*logged) == shoal::fingerprint(payload);
    const auto here = one_type ? stamp_of(schema, payload) : std::nullopt;
    const std::int64_t stamp = here.value_or(0);
    const std::int64_t logged_stamp = here ? stamp_of(schema, *logged).value_or(stamp) : stamp;
    if (logged_stamp > stamp) break;  // the log lacks this message
    if (logged_stamp < stamp) {
      differ(name, step, fmt::format("a message stamped {} is in the log and was not published here", logged_stamp));
      pop(channel);
      continue;
    }
    // Compare the content.
    if (name == "sim.state" && one_type)
      compare_states(*logged, payload, step);
    else
      differ(name, step, difference_of(schema, *logged, payload));
    return pop(channel);
  }
  // The log has no such message.
  if (++missing_ == 1) first_missing_ = Difference{step, std::string(name), "is not in the log"};
  if (log_.own_stamps && !log_.is_thinned) differ(name, step, "was published here and is not in the log");
}

void ReplayMessages::differ(std::string_view channel, std::int64_t step, const std::string& what) {
  ++different_;
  if (by_channel_.contains(std::string(channel))) return;
  const Difference difference{step, std::string(channel), what};
  by_channel_.emplace(channel, difference);
  if (!first_) first_ = difference;
}

void ReplayMessages::compare_states(Payload logged, Payload here, std::int64_t step) {
  // Decode both messages.
  shoal::sim_state_t there{}, own{};
  try {
    there = shoal::decode<shoal::sim_state_t>(logged, shoal::Finite::any);
    own = shoal::decode<shoal::sim_state_t>(here, shoal::Finite::any);
  } catch (const shoal::MessageError& error) {
    return differ("sim.state", step, std::string("cannot be read in the log: ") + error.what());
  }
  if (there.vehicle != own.vehicle) differ("sim.state", step, "has other vehicles in the log");
  // Find the first difference of each vehicle.
  std::string what = "differs";
  for (std::size_t i = 0; i < own.vehicle.size(); ++i) {
    const auto found = std::find(there.vehicle.begin(), there.vehicle.end(), own.vehicle[i]);
    if (found == there.vehicle.end()) continue;
    const auto j = static_cast<std::size_t>(found - there.vehicle.begin());
    const auto look = [&](const char* quantity, const std::vector<double>& a, const std::vector<double>& b) {
      for (std::size_t k = 0; k < b.size(); ++k)
        if (what == "differs" && !equal_values(a[k], b[k]))
          what =
              fmt::format("vehicle '{}': {}[{}] is {} in the log and {} here", own.vehicle[i], quantity, k, a[k], b[k]);
    };
    look("position_m", there.position_m[j], own.position_m[i]);
    look("orientation", there.orientation[j], own.orientation[i]);
    look("velocity_mps", there.velocity_mps[j], own.velocity_mps[i]);
    look("angular_velocity_radps", there.angular_velocity_radps[j], own.angular_velocity_radps[i]);
    // Distance between the true positions.
    const auto& a = there.position_m[j];
    const auto& b = own.position_m[i];
    const double apart_m = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    if (apart_m == 0) continue;
    Distance& distance = distances_.try_emplace(own.vehicle[i], Distance{0, step, step}).first->second;
    if (apart_m <= distance.max_m) continue;
    distance.max_m = apart_m;
    distance.max_step = step;
  }
  if (what != "differs" && !first_motion_) first_motion_ = Difference{step, "sim.state", what};
  differ("sim.state", step, what);
}

void ReplayMessages::finish(std::int64_t step) {
  // In a record every message is either an input or published by the simulator.
  if (!log_.own_stamps || log_.is_rewound || !log_.cut.empty() || log_.usable_step() < log_.last_step ||
      step < log_.last_step)
    return;
  for (auto& [name, channel] : channels_)
    if (!channel.published && channel.left > channel.input_record.size())
      differ(name, step,
             fmt::format("the log has {} messages that were not published here",
                         channel.left - channel.input_record.size()));
}

}  // namespace experiment
