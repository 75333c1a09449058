// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/input_events.hpp"

#include <gmock/gmock.h>
#include <linux/input.h>

#include <cstring>
#include <fstream>

#include "experiment/drive/drive_error.hpp"
#include "experiment/drive/gamepad.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::HasSubstr;

/// What the kernel writes.
std::vector<std::byte> kernel_bytes(long s, long us, std::uint16_t type, std::uint16_t code, std::int32_t value) {
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

TEST(InputEventFile, NamesTheFileInErrors) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("pad.events");
  const auto write = [&](const std::vector<std::byte>& bytes) {
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  };
  const auto error = [&](const std::string& file) -> std::string {
    try {
      experiment::read_input_events(file);
    } catch (const experiment::DriveError& problem) {
      return problem.what();
    }
    return "";
  };
  EXPECT_EQ(error(folder.file("none")), folder.file("none") + ": cannot be read");
  EXPECT_EQ(error(folder.file("")), folder.file("") + ": is a folder");
  std::vector<std::byte> bytes = kernel_bytes(5, 0, EV_KEY, 1, 1);
  const auto earlier = kernel_bytes(4, 0, EV_KEY, 1, 0);
  bytes.insert(bytes.end(), earlier.begin(), earlier.end());
  write(bytes);
  EXPECT_EQ(error(path), path + ": input event 2: its time is before that of the one before");
  bytes.resize(30);
  write(bytes);
  EXPECT_EQ(error(path), path + ": ends inside input event 2");
  write({});
  EXPECT_TRUE(experiment::read_input_events(path).empty());
}

class GamepadTest : public testing::Test {
 protected:
  experiment::Gamepad pad{experiment::read_drive_profile("").gamepad};
};

TEST_F(GamepadTest, IsHeldWhileTheDeadManButtonIsDown) {
  EXPECT_FALSE(pad.holds());
  pad.take({0, EV_KEY, BTN_TL, 1});
  EXPECT_TRUE(pad.holds());
  pad.take({0, EV_KEY, BTN_TL, 2});
  EXPECT_TRUE(pad.holds());
  pad.take({0, EV_KEY, BTN_TL, 0});
  EXPECT_FALSE(pad.holds());
}

TEST_F(GamepadTest, IsReleasedWhenTheKernelDroppedEvents) {
  pad.take({0, EV_KEY, BTN_TL, 1});
  pad.take({0, EV_SYN, SYN_DROPPED, 0});
  EXPECT_FALSE(pad.holds());
  pad.take({0, EV_KEY, BTN_TL, 2});
  EXPECT_FALSE(pad.holds());
}

TEST_F(GamepadTest, HasADeadBandAndFullDeflectionAtTheEndsOfTheRange) {
  pad.set_range(ABS_Y, 0, 255);
  const auto forward = [&](int value) {
    pad.take({0, EV_ABS, ABS_Y, value});
    return pad.values().at("forward");
  };
  EXPECT_DOUBLE_EQ(forward(0), 1);  // up is negative
  EXPECT_DOUBLE_EQ(forward(255), -1);
  EXPECT_DOUBLE_EQ(forward(128), 0);
  // Half way up: deflection 1 - 2 * 64 / 255, of which 0.1 is the dead band.
  EXPECT_NEAR(forward(64), (1 - 2 * 64 / 255. - 0.1) / 0.9, 1e-12);
  pad.take({0, EV_ABS, ABS_Y, 1000});
  EXPECT_DOUBLE_EQ(pad.values().at("forward"), -1);
}

}  // namespace
