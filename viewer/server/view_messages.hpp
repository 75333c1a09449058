// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/web/page_output.hpp"
#include "sim/bus/bus.hpp"
#include "viewer/estimates/vehicle_estimate.hpp"
#include "viewer/estimates/vehicle_path.hpp"
#include "viewer/log/state_frame.hpp"
#include "viewer/page_data/earlier_events.hpp"

namespace viewer {

/// Returns an item of the text `estimates` of the page protocol.  `time_us`: simulated time of the estimate.
std::string estimate_text(const std::string& vehicle, const VehicleEstimate& estimate, std::int64_t time_us);

/// Returns an item of the text `paths` of the page protocol.  `time_us`: simulated time of the path.
std::string path_text(const std::string& channel, const VehiclePath& path, std::int64_t time_us);

/// Passes messages of a bus or a log on to the pages: scene, assets, sounds, events, scores, estimates and paths, and,
/// if there is no simulator in this process, the poses.  A message that cannot be read is counted and left out.
class ViewMessages {
 public:
  /// Whether `sim.bodies` make the state frames.
  enum class Frames { from_bodies, from_elsewhere };

  /// `server` must outlive this.
  ViewMessages(bridges::PageOutput& server, Frames frames) : server_(server), frames_(frames) {}

  /// Passes a message on.
  void take(std::string_view channel, std::span<const std::byte> payload);
  /// Sends what was held back by its rate: estimates, the newest poses, and earlier events for pages that have just
  /// connected.  Call some ten times per second of wall time.
  void flush();
  /// Sets what is known of the time: of the frames from `sim.bodies`.
  void set_pace(float speed, bool paused) {
    speed_ = speed;
    paused_ = paused;
  }
  /// Notes that a page has left: one that comes at the same time gets the newest poses and the earlier events, too.
  void page_left() {
    earlier_.page_left();
    poses_are_new_ = true;
  }
  /// Forgets the paths after a simulated time, to which the run went back: those before count again.
  void rewind_paths(std::int64_t time_us);
  /// Marks the next state as a jump in time.
  void mark_jump() { jump_ = true; }
  /// Sets the UTC of simulated time 0, us since 1970, which message stamps include.
  void set_epoch(std::int64_t epoch_us) { epoch_us_ = epoch_us; }
  std::int64_t epoch_us() const { return epoch_us_; }
  /// Return simulated time and branch of the newest `sim.bodies`.
  std::int64_t newest_us() const { return newest_us_; }
  std::int32_t branch() const { return branch_; }
  /// Returns whether a scene has arrived.
  bool has_scene() const { return !scene_.empty(); }
  /// Return the newest scene, and a number that changes with it.
  const std::string& scene() const { return scene_; }
  int scene_number() const { return scene_number_; }
  /// Returns the number of messages that could not be read.
  std::int64_t bad_messages() const { return bad_messages_; }

 private:
  struct Poses {
    std::int64_t time_us = 0;
    std::int32_t branch = 0, revision = 0;
    std::vector<std::vector<double>> position_m;
    std::vector<std::vector<float>> orientation;
  };
  struct Estimate {
    std::string channel, json;
    bool is_new = false;
  };

  /// Path of a channel, at the simulated time that its message says.
  struct Path {
    std::int64_t time_us = 0;
    VehiclePath path;
  };

  bool take_named(std::string_view channel, std::span<const std::byte> payload);
  void take_scene(std::span<const std::byte> payload);
  void take_asset(std::span<const std::byte> payload);
  void take_bodies(std::span<const std::byte> payload);
  void take_sound(std::span<const std::byte> payload);
  void take_arrival(std::span<const std::byte> payload);
  void take_event(std::span<const std::byte> payload);
  void take_current(std::span<const std::byte> payload);
  void take_scores(std::span<const std::byte> payload);
  void take_path(std::string_view channel, std::span<const std::byte> payload);
  void send_paths();
  void take_estimate(std::string_view channel, std::span<const std::byte> payload);
  std::int64_t time_us(std::int64_t utime) const { return utime - epoch_us_; }

  bridges::PageOutput& server_;
  const Frames frames_;
  std::int64_t epoch_us_ = 0;
  std::string scene_;
  int scene_number_ = 0;
  float speed_ = 1;
  bool paused_ = false, jump_ = false;
  std::optional<Poses> poses_;  // newest
  bool poses_are_new_ = false;  // not sent to all pages
  int clients_ = 0;             // at the last flush
  std::int64_t newest_us_ = 0;
  std::int32_t branch_ = 0;
  StateFrame frame_;
  EarlierEvents earlier_;
  std::map<std::string, Estimate, std::less<>> estimates_;      // newest by vehicle
  std::map<std::string, std::deque<Path>, std::less<>> paths_;  // by channel and time
  bool paths_changed_ = false;
  std::int64_t bad_messages_ = 0;
};

}  // namespace viewer
