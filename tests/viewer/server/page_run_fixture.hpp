// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include "experiment/replay/replay.hpp"
#include "experiment/run/runner.hpp"
#include "sim/config/config_node.hpp"
#include "tests/viewer/server/view_page.hpp"
#include "viewer/server/run_view.hpp"

namespace page_run_fixture {

/// A ball that falls from 100 m, in steps of 10 ms.
inline const std::string falling =
    "shoal: 1\nname: fall\nrun: {duration_s: 4, hash_every_steps: 10}\nphysics: {step_s: 0.01}\nobjects: [{name: ball, "
    "position_m: [1, 2, 100], parts: [{shape: sphere, mass_kg: 1}]}]\n";

inline float height_m(double t_s) {  // the step is exact for constant gravity
  return static_cast<float>(100 - 9.80665 * t_s * t_s / 2);
}

/// A run in another thread, paused, with a page.
class PageRun {
 public:
  explicit PageRun(const std::string& record = "", const std::string& world = falling) {
    loaded_ = sim::load_world_text(world, "worlds/test.yaml", test::LoadedTestWorld::with_messages({}));
    options_.bus = "none";
    options_.quiet = options_.paused = true;
    options_.speed = 0;
    options_.record = record;
    view_.port = 0;
    options_.page = viewer::run_page(view_);
    std::promise<std::string> address;
    auto opened = address.get_future();
    view_.opened = [&address](const std::string& text) { address.set_value(text); };
    thread_ = std::thread([this] { summary = experiment::run_world(loaded_, options_); });
    url = opened.get();
    page = std::make_unique<test::ViewPage>(url);
  }
  ~PageRun() { end(); }
  /// Steps, and waits until it is done.
  void step(int count, std::int64_t to_step) {
    page->control("step", count);
    page->text("status", [&](const web_test::Json& status) { return status["step"] == to_step; });
  }
  /// Runs to the end.
  void end() {
    if (!thread_.joinable()) return;
    page->control("resume");
    thread_.join();
  }

  experiment::Summary summary;
  std::string url;
  std::unique_ptr<test::ViewPage> page;

 private:
  sim::LoadedWorld loaded_;
  experiment::RunOptions options_;
  experiment::ViewOptions view_;
  std::thread thread_;
};

inline experiment::Summary plain_run() {
  const auto loaded = sim::load_world_text(falling, "worlds/test.yaml", test::LoadedTestWorld::with_messages({}));
  experiment::RunOptions options;
  options.bus = "none";
  options.quiet = true;
  options.speed = 0;
  return experiment::run_world(loaded, options);
}

}  // namespace page_run_fixture
