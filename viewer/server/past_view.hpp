// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bridges/view/view_publisher.hpp"
#include "bridges/web/web_server.hpp"
#include "sim/world/world.hpp"
#include "viewer/log/scene_names.hpp"
#include "viewer/log/state_frame.hpp"
#include "viewer/page_data/page_request.hpp"
#include "viewer/server/pose_history.hpp"

namespace viewer {

/// The past of a run on the live page: keeps poses, answers `look` of the pages, and lists the branches with the first
/// time at which the poses of each differ from the present one.
class PastView {
 public:
  using Clock = std::chrono::steady_clock;

  /// `server` must outlive this.
  explicit PastView(bridges::WebServer& server) : server_(server) {}

  /// Takes a scene, which has the names of the bodies of its revision.
  void set_scene(const std::string& scene);
  /// Stores the present poses at intervals.
  void remember(const sim::World& world, const bridges::ViewPublisher& publisher);
  /// See PoseHistory::start_branch().
  void start_branch(std::int32_t number, std::int64_t start_us, std::int64_t left_us, bool continues);
  /// Says what the programs of the present branch do, for the list of branches; empty: nothing.
  void set_programs(const std::string& text);
  /// Answers a `look` of a page.
  void answer(const bridges::ViewRequest& request);
  /// Sends the list of branches when it has changed, at most once per second.
  void update(Clock::time_point now);
  /// Forgets everything, for another run.
  void clear();

  const PoseHistory& history() const { return history_; }

 private:
  /// Result of the comparison of a branch with the present one.
  struct Comparison {
    std::int64_t until_us = INT64_MIN;  // compared up to here
    std::optional<std::int64_t> differs_us;
  };

  void compare();
  std::string branches_text() const;

  bridges::WebServer& server_;
  PoseHistory history_;
  SceneNames names_;
  StateFrame kept_, sent_;
  std::map<std::int32_t, Comparison> comparisons_;
  std::map<std::int32_t, std::string> programs_;  // what the programs of a branch do
  Clock::time_point next_update_{};
  std::string branches_;
};

}  // namespace viewer
