// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/laser_scans.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "devices/ranging/lidar.hpp"
#include "devices/ranging/lidar3d.hpp"

namespace viewer {

namespace {

bool is_laser(const sim::MountedDevice& device) {
  return device.casts_rays() && (dynamic_cast<const devices::Lidar*>(device.sensor()) != nullptr ||
                                 dynamic_cast<const devices::Lidar3d*>(device.sensor()) != nullptr);
}

sim::Pose sensor_pose(const sim::MountedDevice& device) {
  const sim::DeviceConfig& config = device.config();
  const sim::Body& body = config.body.empty() ? device.vehicle().base() : device.vehicle().body(config.body);
  return body.X_WB() * config.X_BS();
}

/// Returns the rays of a plane scan with a return; without one the range is the largest or the smallest.
std::vector<LaserScans::Ray> rays_of(const devices::Lidar& lidar, const sim::Pose& X_WS) {
  const sim::FieldOfView view = lidar.field_of_view().value();
  std::vector<LaserScans::Ray> rays;
  for (std::size_t i = 0; i < lidar.ranges_m().size(); ++i) {
    const double range_m = lidar.ranges_m()[i];
    if (range_m <= view.range_min_m || range_m >= view.range_m) continue;
    const double angle_rad = lidar.first_angle_rad() + static_cast<double>(i) * lidar.step_rad();
    const sim::Vector3d hit_S(range_m * std::cos(angle_rad), range_m * std::sin(angle_rad), 0);
    rays.push_back({X_WS.translation(), X_WS * hit_S});
  }
  return rays;
}

/// Returns the rays of a rotation with a return, from the pose at the time of each column.
template <typename PoseAt>
std::vector<LaserScans::Ray> rays_of(const devices::Lidar3d& lidar, const PoseAt& pose_at) {
  std::vector<LaserScans::Ray> rays;
  std::size_t beam = 0;
  for (int column = 0; column < lidar.columns(); ++column) {
    const sim::Pose X_WS = pose_at(lidar.offset(column));
    for (int ring = 0; ring < lidar.rings(); ++ring, ++beam) {
      if (lidar.returns().returned[beam] != devices::LaserReturns::echo) continue;
      const sim::Vector3d hit_S = lidar.returns().ranges_m[beam] * lidar.direction_S(column, ring);
      rays.push_back({X_WS.translation(), X_WS * hit_S});
    }
  }
  return rays;
}

}  // namespace

sim::Pose LaserScans::pose_at(const Poses& X_WS, sim::Time at) {
  const auto after = std::find_if(X_WS.begin(), X_WS.end(), [at](const auto& each) { return each.first >= at; });
  // Before the first and after the last known pose the nearest one is the best guess.
  if (after == X_WS.begin()) return after->second;
  const auto before = std::prev(after);
  if (after == X_WS.end()) return before->second;
  const double share = sim::to_seconds(at - before->first) / sim::to_seconds(after->first - before->first);
  sim::Pose X = before->second;
  X.translation() += share * (after->second.translation() - before->second.translation());
  X.linear() = sim::Quaterniond(before->second.linear())
                   .slerp(share, sim::Quaterniond(after->second.linear()))
                   .toRotationMatrix();
  return X;
}

void LaserScans::observe() {
  std::set<std::string> present;
  for (const auto& device : world_.devices()) {
    if (!device || !is_laser(*device)) continue;
    present.insert(device->full_name());
    observe(*device, scanners_[device->full_name()]);
  }
  std::erase_if(scanners_, [&](const auto& each) { return !present.contains(each.first); });
}

void LaserScans::observe(const sim::MountedDevice& device, Scanner& scanner) const {
  const sim::Time now = world_.now();
  if (!scanner.X_WS.empty() && scanner.X_WS.back().first >= now) return;
  scanner.X_WS.emplace_back(now, sensor_pose(device));
  while (scanner.X_WS.front().first < now - sim::from_seconds(kept_s)) scanner.X_WS.pop_front();
  // A scanner without power has no sample at its time.  One that is silent or stuck has no new reading for others.
  const bool due = scanner.sample_step >= 0 && scanner.sample_step <= world_.step_number();
  scanner.sample_step = device.next_sample_step();
  if (!due || !device.vehicle().systems().powered || device.faults().silent() || device.faults().stuck()) return;
  scanner.scan.at = now;
  if (const auto* lidar = dynamic_cast<const devices::Lidar*>(device.sensor())) {
    scanner.scan.rays = rays_of(*lidar, scanner.X_WS.back().second);
    return;
  }
  const auto& lidar = dynamic_cast<const devices::Lidar3d&>(*device.sensor());
  scanner.scan.rays = rays_of(lidar, [&](sim::Time offset) { return pose_at(scanner.X_WS, now + offset); });
}

std::map<std::string, const LaserScans::Scan*> LaserScans::scans() const {
  std::map<std::string, const Scan*> all;
  for (const auto& [name, scanner] : scanners_)
    if (scanner.scan.at.count() >= 0 && world_.now() - scanner.scan.at <= sim::from_seconds(kept_s))
      all.emplace(name, &scanner.scan);
  return all;
}

}  // namespace viewer
