// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "bridges/view/view_publisher.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/tap_bus.hpp"
#include "tests/bridges/web/web_client.hpp"
#include "tests/devices/world_fixture.hpp"
#include "viewer/server/run_view.hpp"

// What a live page costs the run: allocations of the thread that steps the world, and memory of the process.

namespace {

thread_local std::int64_t allocations = 0;
// Sanitizers have their own allocators, which keep freed memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool counts_memory = false;
#else
constexpr bool counts_memory = true;
#endif

}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
void* operator new(std::size_t bytes) {
  ++allocations;
  if (void* const memory = std::malloc(std::max<std::size_t>(1, bytes))) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
#endif

namespace {

const std::string measured_world =
    test::rover_world("        - {name: lidar, type: lidar}\n", "", "", "name: small\nrun: {seed: 7}\n");

experiment::ViewOptions any_port() {
  experiment::ViewOptions options;
  options.port = 0;
  return options;
}

TEST(RunViewCost, WithoutAPageOnlyAStepWhosePosesAreKeptAllocates) {
  if (!counts_memory) GTEST_SKIP() << "the sanitizer allocates";
  test::TestWorld test(measured_world);
  viewer::RunView page(any_port(), "test");
  experiment::TapBus bus(test.bus, [&](std::string_view channel, std::span<const std::byte> payload, sim::Time at) {
    page.message(channel, payload, at);
  });
  bridges::ViewPublisher publisher(bus, test.world, {}, [] { return true; });
  const sim::RunControl control;
  const auto report = std::vector<std::byte>(800, std::byte{7});
  page.start(test.world, 10);
  int steps_that_allocate = 0, steps = 0;
  const sim::Time begin = sim::from_seconds(2), end = sim::from_seconds(4);
  while (test.world.now() < end) {
    test.world.step();
    const std::int64_t before = allocations;
    publisher.after_step();
    page.message("r1.lidar", report, test.world.now());
    page.after_step(test.world, publisher, control);
    page.serve(test.world, publisher, control, "",
               [](const std::string&, double, const std::string&) { return viewer::RunView::Answer{}; });
    if (test.world.now() < begin) continue;  // buffers get their sizes
    ++steps;
    steps_that_allocate += allocations > before;
  }
  EXPECT_GT(steps, 150);
  // Per simulated second poses are kept ten times, and counts of messages at most five times.
  EXPECT_LE(steps_that_allocate, 30);
}

/// Largest memory of this process, in MB, while `work` is done.
template <typename Work>
double peak_MB(const Work& work) {
  std::ofstream("/proc/self/clear_refs") << 5;  // resets the peak
  work();
  std::ifstream file("/proc/self/status");
  std::string line;
  while (std::getline(file, line))
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  throw std::runtime_error("/proc/self/status has no VmHWM");
}

experiment::RunOptions fast_run(const experiment::ViewOptions& view) {
  experiment::RunOptions options;
  options.bus = "none";
  options.quiet = true;
  options.keys = false;
  options.speed = 0;
  options.rewind_s = 0;
  options.duration_s = 30;
  options.page = viewer::run_page(view);
  return options;
}

TEST(RunViewCost, APageThatDoesNotReadTakesAtMostEightMegabytesAndChangesNothing) {
  const sim::LoadedWorld loaded = sim::load_world_text(measured_world, "small.yaml");
  // A first run, so that both that are compared find the same memory in the process.
  experiment::ViewOptions view = any_port();
  experiment::run_world(loaded, fast_run(view));
  experiment::Summary alone, watched;
  const double alone_MB = peak_MB([&] { alone = experiment::run_world(loaded, fast_run(view)); });
  const experiment::RunOptions options = fast_run(view);
  std::unique_ptr<web_test::Client> frozen;
  view.opened = [&](const std::string& url) {
    frozen = std::make_unique<web_test::Client>(static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1))),
                                                false, 4096);
    frozen->upgrade();
    frozen->send_json({{"op", "hello"}});
    frozen->send_json({{"op", "subscribe"}, {"channels", {{{"name", "r1.lidar"}, {"rate_hz", 30}}}}});
  };
  const double watched_MB = peak_MB([&] { watched = experiment::run_world(loaded, options); });
  RecordProperty("frozen_page_MB", std::to_string(watched_MB - alone_MB));
  if (counts_memory) {
    EXPECT_LE(watched_MB - alone_MB, 8);
  }
  EXPECT_EQ(watched.run_hash, alone.run_hash);
  EXPECT_EQ(watched.state_hash, alone.state_hash);
}

}  // namespace
