// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/input_events.hpp"

#include <gmock/gmock.h>
#include <linux/input.h>

#include <cstring>

#include "experiment/drive/drive_profile.hpp"
#include "experiment/drive/gamepad.hpp"
#include "tests/experiment/drive/input_events_fixture.hpp"

namespace {

using namespace input_events_fixture;

using testing::HasSubstr;

std::string error_of(const std::vector<std::byte>& bytes) {
  experiment::InputEventReader reader;
  reader.add(bytes);
  try {
    while (reader.next()) {
    }
  } catch (const experiment::DriveError& error) {
    return error.what();
  }
  return "";
}

TEST(InputEventReader, ReadsTheEventsOfTheKernelInPiecesOfAnyLength) {
  std::vector<std::byte> bytes = kernel_bytes(1700000000, 250000, EV_ABS, ABS_RY, -32768);
  const auto second = kernel_bytes(1700000001, 999999, EV_KEY, BTN_TL, 1);
  bytes.insert(bytes.end(), second.begin(), second.end());
  for (const std::size_t piece : {1u, 7u, 24u, 48u}) {
    experiment::InputEventReader reader;
    std::vector<experiment::InputEvent> events;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      reader.add(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
      while (const auto event = reader.next()) events.push_back(*event);
    }
    ASSERT_EQ(events.size(), 2u);
    EXPECT_FALSE(reader.is_cut());
    EXPECT_EQ(events[0].time_us, 1700000000250000);
    EXPECT_EQ(events[0].type, EV_ABS);
    EXPECT_EQ(events[0].code, ABS_RY);
    EXPECT_EQ(events[0].value, -32768);
    EXPECT_EQ(events[1].time_us, 1700000001999999);
    EXPECT_EQ(events[1].code, BTN_TL);
    EXPECT_EQ(experiment::bytes_of(events[1]), second);
  }
}

TEST(InputEventReader, RefusesWhatTheKernelDoesNotWrite) {
  EXPECT_EQ(error_of(kernel_bytes(0, 1000000, EV_KEY, 1, 1)),
            "input event 1: microseconds must be at most 999999, got 1000000");
  EXPECT_EQ(error_of(kernel_bytes(0, 0, 32, 1, 1)), "input event 1: type must be at most 31, got 32");
  EXPECT_EQ(error_of(kernel_bytes(0, 0, EV_KEY, 0x300, 1)), "input event 1: code must be at most 767, got 768");
  EXPECT_THAT(error_of(kernel_bytes(-1, 0, EV_KEY, 1, 1)), HasSubstr("seconds must be at most"));
}

}  // namespace
