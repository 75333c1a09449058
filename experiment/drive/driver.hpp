// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiment/drive/drive_mapping.hpp"
#include "experiment/drive/drive_profile.hpp"

namespace experiment {

/// Driver of one vehicle: dead-man switch, watchdog and rate of its commands.  The vehicle moves only while signs of
/// life come; it gets its safe command at once when it is released, and `hold_s` after the last sign otherwise.  The
/// time is passed in.
class Driver {
 public:
  using Clock = std::chrono::steady_clock;
  /// The safe command is repeated, because a datagram may be lost.
  static constexpr int safe_commands = 3;

  Driver(const DriveProfile& profile, const DrivenVehicle& vehicle, std::optional<DriveKind> kind)
      : mapping_(profile, vehicle, kind),
        interval_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / profile.rate_hz))),
        hold_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(profile.hold_s))) {}

  const DriveMapping& mapping() const { return mapping_; }
  /// Takes the positions of the axes, which are a sign of life.
  void hold(const DriveValues& values, Clock::time_point now);
  /// The driver has let go.
  void release();
  /// Returns whether the vehicle is commanded to move, or is being stopped.
  bool busy() const { return held_ || safe_left_ > 0; }
  /// Returns whether signs of life come.
  bool held() const { return held_; }
  /// Returns the commands that are due; empty: none.
  std::vector<DriveCommand> due(Clock::time_point now, std::int64_t utime, const std::optional<DrivePose>& pose);
  /// Returns the safe command.
  std::vector<DriveCommand> safe(std::int64_t utime, const std::optional<DrivePose>& pose) {
    return mapping_.commands({}, utime, pose);
  }

 private:
  DriveMapping mapping_;
  Clock::duration interval_, hold_;
  DriveValues values_;
  bool held_ = false;
  int safe_left_ = 0;
  Clock::time_point sign_{}, next_{};
};

/// Set positions of the axes, moved by keys.
class DriveKeys {
 public:
  /// Effect of a key.
  enum class Effect { none, sign_of_life, next_joint };

  explicit DriveKeys(const DriveProfile::Keys& keys) : keys_(keys) {}
  /// Takes a key by its name, as in KeyEvent.  Every key of the profile is a sign of life except the one that centers.
  Effect press(const std::string& key);
  /// Returns the set position of each axis.
  const DriveValues& values() const { return values_; }
  void centre() { values_.clear(); }

 private:
  DriveProfile::Keys keys_;
  DriveValues values_;
};

}  // namespace experiment
