// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/waiting_page.hpp"

#include <gmock/gmock.h>

#include "tests/viewer/server/log_page.hpp"
#include "tests/viewer/server/served_bus.hpp"

namespace {

using namespace served_bus;

/// A viewer may join the playback of a log at any time.
TEST(BusView, SaysThatItWaitsForTheScene) {
  ServedBus bus;
  test::ViewPage page(bus.url());
  EXPECT_EQ(page.text("status")["waits_for"], "waits for sim.scene");
  const test::TrafficLog log;
  bus.play(log.path);
  page.text("status", [](const auto& text) { return text["waits_for"] == ""; });
}

}  // namespace
