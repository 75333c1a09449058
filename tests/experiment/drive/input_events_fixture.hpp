// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <linux/input.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace input_events_fixture {

/// What the kernel writes.
inline std::vector<std::byte> kernel_bytes(long s, long us, std::uint16_t type, std::uint16_t code,
                                           std::int32_t value) {
  input_event event{};
  event.input_event_sec = s;
  event.input_event_usec = us;
  event.type = type;
  event.code = code;
  event.value = value;
  std::vector<std::byte> bytes(sizeof event);
  std::memcpy(bytes.data(), &event, sizeof event);
  return bytes;
}

}  // namespace input_events_fixture
