// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/input_events.hpp"

#include <filesystem>
#include <fstream>

#include "experiment/drive/drive_profile.hpp"

namespace experiment {

namespace {

constexpr std::uint16_t last_type = 0x1f, last_code = 0x2ff;
constexpr std::uint64_t max_time_s = std::uint64_t{1} << 40;
constexpr std::uintmax_t max_file_bytes = std::uintmax_t{64} << 20;

std::uint64_t unsigned_at(std::span<const std::byte> bytes, std::size_t from, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(bytes[from + i]);
  return value;
}

}  // namespace

void InputEventReader::add(std::span<const std::byte> bytes) {
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
  at_ = 0;
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

std::optional<InputEvent> InputEventReader::next() {
  if (bytes_.size() - at_ < event_bytes) return std::nullopt;
  const auto bytes = std::span<const std::byte>(bytes_).subspan(at_, event_bytes);
  at_ += event_bytes;
  ++count_;
  const auto check = [this](const char* what, std::uint64_t value, std::uint64_t highest) {
    if (value > highest)
      throw DriveError("input event " + std::to_string(count_) + ": " + what + " must be at most " +
                       std::to_string(highest) + ", got " + std::to_string(value));
    return value;
  };
  // struct input_event of linux/input.h on 64-bit machines, little-endian.
  const std::uint64_t seconds = check("seconds", unsigned_at(bytes, 0, 8), max_time_s);
  const std::uint64_t microseconds = check("microseconds", unsigned_at(bytes, 8, 8), 999'999);
  InputEvent event;
  event.time_us = static_cast<std::int64_t>(seconds * 1'000'000 + microseconds);
  event.type = static_cast<std::uint16_t>(check("type", unsigned_at(bytes, 16, 2), last_type));
  event.code = static_cast<std::uint16_t>(check("code", unsigned_at(bytes, 18, 2), last_code));
  event.value = static_cast<std::int32_t>(static_cast<std::uint32_t>(unsigned_at(bytes, 20, 4)));
  return event;
}

std::vector<InputEvent> read_input_events(const std::string& file) {
  std::error_code no_file;
  if (std::filesystem::is_directory(file, no_file)) throw DriveError(file + ": is a folder");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw DriveError(file + ": cannot be read");
  // Read it piece by piece, so that a pipe or a device without an end is bounded too.
  InputEventReader reader;
  std::vector<InputEvent> events;
  std::uintmax_t total = 0;
  std::vector<char> piece(std::size_t{1} << 16);
  try {
    while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0) {
      total += static_cast<std::uintmax_t>(in.gcount());
      if (total > max_file_bytes) throw DriveError("larger than 64 MiB");
      reader.add(std::as_bytes(std::span(piece).first(static_cast<std::size_t>(in.gcount()))));
      while (const auto event = reader.next()) events.push_back(*event);
    }
    if (reader.is_cut()) throw DriveError("ends inside input event " + std::to_string(reader.count() + 1));
    for (std::size_t i = 1; i < events.size(); ++i)
      if (events[i].time_us < events[i - 1].time_us)
        throw DriveError("input event " + std::to_string(i + 1) + ": its time is before that of the one before");
  } catch (const DriveError& error) {
    throw DriveError(file + ": " + error.what());
  }
  return events;
}

std::vector<std::byte> bytes_of(const InputEvent& event) {
  std::vector<std::byte> bytes;
  const auto add = [&bytes](std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i) & 0xff));
  };
  add(static_cast<std::uint64_t>(event.time_us / 1'000'000), 8);
  add(static_cast<std::uint64_t>(event.time_us % 1'000'000), 8);
  add(event.type, 2);
  add(event.code, 2);
  add(static_cast<std::uint32_t>(event.value), 4);
  return bytes;
}

}  // namespace experiment
