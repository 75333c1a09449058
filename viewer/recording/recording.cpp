// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/recording/recording.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <utility>

#include "bridges/base/json_text.hpp"
#include "bridges/log/event_log.hpp"
#include "viewer/log/log_index.hpp"
#include "viewer/log/message_times.hpp"
#include "viewer/server/view_messages.hpp"

namespace viewer {

namespace {

using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little, "recordings are little-endian");

/// Returns whether a text of ViewMessages has this `op`.  In names quotes are escaped.
bool has_op(std::string_view json, std::string_view op) {
  return json.find("\"op\":\"" + std::string(op) + "\"") != std::string_view::npos;
}

bool is_sound(const Recording::Entry& entry) {
  return entry.kind == Recording::Kind::text && (has_op(entry.bytes, "sounds") || has_op(entry.bytes, "receptions"));
}

template <typename Number>
void put(std::string& bytes, Number number) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof number);
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

}  // namespace

Recording::Recording(const std::string& log, const std::string& version, const Limits& limits,
                     const std::function<void(double share)>& progress)
    : limits_(limits) {
  const LogIndex index(log, [&](double share) {
    if (progress) progress(share / 2);
  });
  world_ = index.world();
  problems_ = index.problems();
  start_us_ = index.start_us();
  end_us_ = index.end_us();
  epoch_us_ = index.epoch_us();
  now_us_ = start_us_;
  add(Kind::text, bridges::json_text({{"op", "hello"},
                                      {"version", 1},
                                      {"shoal", version},
                                      {"source", "log"},
                                      {"control", true},
                                      {"name", std::filesystem::path(log).filename().string()},
                                      {"world", world_},
                                      {"epoch_us", epoch_us_},
                                      {"start_us", start_us_},
                                      {"end_us", end_us_}}));
  // The events of the whole log, for the time line.
  Json items = Json::array();
  for (const LogIndex::Occasion& each : index.occasions())
    items.push_back({{"time_us", each.time_us}, {"kind", each.kind}, {"who", each.who}, {"text", each.text}});
  if (!items.empty()) add(Kind::text, bridges::json_text({{"op", "events"}, {"items", std::move(items)}}));
  read(log, progress);
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.time_us < b.time_us; });
}

void Recording::read(const std::string& log, const std::function<void(double share)>& progress) {
  bridges::EventLogReader reader(log);
  bridges::LogEventView event;
  ViewMessages messages(*this, ViewMessages::Frames::from_bodies);
  messages.set_epoch(epoch_us_);
  // States are made at multiples of an interval, which doubles when they would not fit.
  std::size_t number = 0, stride = 1;
  while (reader.next(event)) {
    constexpr std::int64_t events_per_report = 1 << 16;
    if (progress && event.number % events_per_report == 0)
      progress(0.5 + static_cast<double>(event.offset) / static_cast<double>(2 * reader.file_bytes()));
    if (event.channel == "sim.event") continue;  // all are at the start
    if (event.channel != "sim.bodies") {
      const auto stamp = stamp_of(event.payload);
      const std::int64_t before_us = messages.newest_us();
      now_us_ = event.channel.starts_with("sim.sound") && stamp ? std::max(start_us_, *stamp - epoch_us_)
                                                                : std::max(start_us_, before_us);
      messages.take(event.channel, event.payload);
      continue;
    }
    // Poses: estimates go with them.
    const std::int64_t before_us = messages.newest_us();
    messages.take(event.channel, event.payload);
    now_us_ = std::clamp(messages.newest_us(), start_us_, end_us_);
    if (states_of_log_ > 0 && messages.newest_us() < before_us) rewind(now_us_);
    ++states_of_log_;
    if (number++ % stride != 0) continue;
    messages.flush();
    if ((states_ + 1) * last_state_bytes_ <= limits_.state_bytes) continue;
    if (thin(false)) stride *= 2;
  }
  // The last state ends the time line.
  messages.flush();
}

void Recording::add(Kind kind, std::string bytes) {
  entries_.push_back({kind, now_us_, 0, std::move(bytes)});
}

void Recording::rewind(std::int64_t time_us) {
  std::erase_if(entries_, [&](const Entry& entry) { return entry.kind != Kind::asset && entry.time_us > time_us; });
  states_ = static_cast<std::size_t>(
      std::count_if(entries_.begin(), entries_.end(), [](const Entry& entry) { return entry.kind == Kind::state; }));
}

bool Recording::thin(bool keep_last) {
  if (states_ <= 2) return false;
  // States and groups of estimates are numbered separately.
  std::size_t state = 0, estimates = 0;
  const std::size_t last = states_ - 1;
  std::erase_if(entries_, [&](const Entry& entry) {
    if (entry.kind == Kind::state) {
      const std::size_t number = state++;
      const bool is_left_out = number % 2 == 1 && !(keep_last && number == last);
      states_ -= is_left_out ? 1 : 0;
      return is_left_out;
    }
    if (entry.kind != Kind::estimates || estimates++ % 2 == 0) return false;
    text_bytes_ -= entry.bytes.size();
    return true;
  });
  return true;
}

bool Recording::drop_sounds() {
  const std::size_t count = std::erase_if(entries_, is_sound);
  dropped_texts_ += count;
  return count > 0;
}

std::string Recording::to_bytes() const {
  std::size_t size = 0;
  for (const Entry& entry : entries_) size += 24 + entry.bytes.size();
  std::string bytes;
  bytes.reserve(size);
  for (const Entry& entry : entries_) {
    put(bytes, static_cast<std::uint32_t>(entry.kind));
    put(bytes, static_cast<std::uint32_t>(entry.bytes.size()));
    put(bytes, entry.time_us);
    put(bytes, entry.asset);
    bytes += entry.bytes;
  }
  return bytes;
}

void Recording::send_state(std::span<const std::byte> state) {
  last_state_bytes_ = state.size();
  add(Kind::state, {reinterpret_cast<const char*>(state.data()), state.size()});
  ++states_;
}

void Recording::send_text(std::string json) {
  if (text_bytes_ + json.size() > limits_.text_bytes) {
    ++dropped_texts_;
    return;
  }
  text_bytes_ += json.size();
  add(has_op(json, "estimates") ? Kind::estimates : Kind::text, std::move(json));
}

void Recording::retain(std::string_view op, std::string json) {
  if (op == "paths") return send_text(std::move(json));  // of a program, which may make very many
  add(Kind::text, std::move(json));
}

void Recording::set_asset(std::uint64_t hash, std::span<const std::byte> bytes) {
  const auto known = [&](const Entry& entry) { return entry.kind == Kind::asset && entry.asset == hash; };
  if (std::any_of(entries_.begin(), entries_.end(), known)) return;
  entries_.push_back({Kind::asset, start_us_, hash, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}});
}

}  // namespace viewer
