// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiment/drive/drive_profile.hpp"
#include "tests/experiment/replay/replay_fixture.hpp"
#include "viewer/server/page_drive.hpp"

namespace page_drive_fixture {

using namespace std::chrono_literals;

/// A rover that pages drive, with the time of the test.
class PageDriveTest : public test::ReplayTest {
 protected:
  /// Positions of the controls of a page.
  static viewer::PageDrive::Request ahead(double forward) { return {"r1", "twist", {{"forward", forward}}}; }

  std::string refused(int client, const viewer::PageDrive::Request& request, const sim::World& world,
                      std::chrono::milliseconds at) {
    try {
      drive.take(client, request, world, start + at);
    } catch (const experiment::DriveError& error) {
      return error.what();
    }
    return "";
  }
  /// Speeds that are commanded at a time.
  std::vector<double> speeds(const sim::World& world, std::chrono::milliseconds at, bool paused = false) {
    std::vector<double> all;
    drive.run(world, start + at, paused, [&](const std::string& vehicle, const std::string& channel, auto payload) {
      EXPECT_EQ(vehicle, "r1");
      EXPECT_EQ(channel, "r1.drive.cmd");
      all.push_back(shoal::decode<shoal::twist_command_t>(payload, shoal::Finite::required).forward_mps);
    });
    return all;
  }

  const viewer::PageDrive::Clock::time_point start{1h};
  viewer::PageDrive drive{experiment::read_drive_profile("")};
};

}  // namespace page_drive_fixture
