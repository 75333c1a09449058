// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sim/world/world.hpp"

namespace viewer {

/// Last scans of the laser scanners of a world, as rays from where the sensor was when it measured to what it hit.
class LaserScans {
 public:
  /// Time for which a scan is kept, s.
  static constexpr double kept_s = 2;

  struct Ray {
    sim::Vector3d from_W = sim::Vector3d::Zero();
    sim::Vector3d to_W = sim::Vector3d::Zero();
  };
  struct Scan {
    sim::Time at{-1};       ///< of the sample; -1: there was none yet
    std::vector<Ray> rays;  ///< of the beams with a return
  };

  /// `world` must outlive this.
  explicit LaserScans(const sim::World& world) : world_(world) {}

  /// Takes the scans of the last step.  To be called after each step.
  void observe();
  /// Returns the scans that are not older than `kept_s`, by VEHICLE/DEVICE.
  std::map<std::string, const Scan*> scans() const;

 private:
  using Poses = std::deque<std::pair<sim::Time, sim::Pose>>;

  /// Scanner that is watched.
  struct Scanner {
    std::int64_t sample_step = -1;  ///< after which it samples next; -1: not known
    Poses X_WS;                     ///< by time
    Scan scan;
  };

  void observe(const sim::MountedDevice& device, Scanner& scanner) const;
  static sim::Pose pose_at(const Poses& X_WS, sim::Time at);

  const sim::World& world_;
  std::map<std::string, Scanner> scanners_;
};

}  // namespace viewer
