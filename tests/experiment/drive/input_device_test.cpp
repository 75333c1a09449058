// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/input_device.hpp"

#include <gmock/gmock.h>
#include <linux/input.h>

#include <cstring>
#include <fstream>

#include "experiment/drive/drive_profile.hpp"
#include "experiment/drive/gamepad.hpp"
#include "experiment/drive/input_events.hpp"
#include "tests/experiment/drive/input_events_fixture.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using namespace input_events_fixture;

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

}  // namespace
