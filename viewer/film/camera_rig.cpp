// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/camera_rig.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "devices/ranging/camera.hpp"
#include "sim/config/message_text.hpp"
#include "viewer/film/camera_path.hpp"
#include "viewer/images/overview.hpp"

namespace viewer {

namespace {

/// Share of the way to a target in a time, for a filter with a time constant.
double share_of_way(double film_step_s, double constant_s) {
  return 1 - std::exp(-film_step_s / constant_s);
}

std::string vehicle_names(const sim::World& world) {
  std::vector<std::string> names;
  for (const auto& vehicle : world.vehicles()) names.push_back(vehicle->name());
  return names.empty() ? "there is no vehicle" : "vehicles: " + sim::list_text(names, 12);
}

const sim::Vehicle& vehicle_of(const sim::World& world, const std::string& camera, const std::string& name) {
  if (const sim::Vehicle* vehicle = world.find_vehicle(name)) return *vehicle;
  throw CameraError(fmt::format("camera '{}': there is no vehicle '{}' at {:.3f} s; {}", sim::printable(camera),
                                sim::printable(name), sim::to_seconds(world.now()), vehicle_names(world)));
}

/// Diagonal of the box around a vehicle.
double size_of(const sim::World& world, const sim::Vehicle& vehicle) {
  Eigen::AlignedBox3d all;
  const auto parts = world.physics().parts();
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].group == vehicle.group())
      if (const auto box = world.physics().bounds_W(static_cast<int>(i))) all.extend(*box);
  return all.isEmpty() ? 1.0 : std::clamp(all.diagonal().norm(), 0.1, 100.0);
}

/// Camera at a distance from a vehicle, in a direction that the kind of camera chooses.
class FollowingRig : public CameraRig {
 public:
  FollowingRig(const sim::World& world, const SceneView& like, const std::string& text, const std::string& vehicle)
      : world_(world), view_(like), vehicle_(vehicle), size_m_(size_of(world, vehicle_of(world, text, vehicle))) {}

  std::string subject() const override { return vehicle_; }
  SceneView view(double film_step_s) override {
    const sim::Vehicle* vehicle = world_.find_vehicle(vehicle_);
    if (vehicle == nullptr) return view_;  // it was removed: the camera stays
    const sim::Vector3d back_W = back(*vehicle, film_step_s);
    const sim::Vector3d target_W = vehicle->X_WV().translation() + sim::Vector3d(0, 0, 0.15 * size_m_);
    // Nothing may stand between the vehicle and the camera.
    const sim::RayFilter filter{~0u, vehicle->group(), sim::RayKind::light};
    double range_m = back_W.norm();
    if (const auto hit = world_.scene().cast(target_W, back_W / range_m, range_m, filter))
      range_m = std::max(0.9 * hit->range_m, 0.3 * range_m);
    view_.X_WS = look_at(target_W + range_m * back_W.normalized(), target_W);
    return view_;
  }

 protected:
  double size_m() const { return size_m_; }
  /// Returns the displacement of the camera from the vehicle.
  virtual sim::Vector3d back(const sim::Vehicle& vehicle, double film_step_s) = 0;

 private:
  const sim::World& world_;
  SceneView view_;
  std::string vehicle_;
  double size_m_;
};

/// Displacement of a camera by azimuth and elevation.
sim::Vector3d displacement(double range_m, double azimuth_rad, double elevation_rad) {
  return range_m * sim::Vector3d(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                 std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
}

/// Camera behind a vehicle, which follows its turns smoothly.
class ChaseRig final : public FollowingRig {
 public:
  using FollowingRig::FollowingRig;

 private:
  sim::Vector3d back(const sim::Vehicle& vehicle, double film_step_s) override {
    const sim::Vector3d ahead_W = vehicle.X_WV().linear().col(0);
    if (std::hypot(ahead_W.x(), ahead_W.y()) > 0.1) {
      const double yaw_rad = std::atan2(ahead_W.y(), ahead_W.x());
      const double turn_rad = std::remainder(yaw_rad - yaw_rad_, 2 * std::numbers::pi);
      yaw_rad_ += first_ ? turn_rad : turn_rad * share_of_way(film_step_s, 0.7);
      first_ = false;
    }
    return displacement(2.6 * size_m() + 0.5, yaw_rad_ + std::numbers::pi, sim::degrees_to_radians(20));
  }

  double yaw_rad_ = 0;
  bool first_ = true;
};

/// Camera that circles a vehicle once in 30 s of the film.
class OrbitRig final : public FollowingRig {
 public:
  using FollowingRig::FollowingRig;

 private:
  sim::Vector3d back(const sim::Vehicle&, double film_step_s) override {
    azimuth_rad_ += film_step_s * 2 * std::numbers::pi / 30;
    return displacement(2.8 * size_m() + 0.8, azimuth_rad_, sim::degrees_to_radians(24));
  }

  double azimuth_rad_ = std::atan2(-0.75, -0.5);
};

/// Camera that has all vehicles, or one, in view from a constant direction.
class FramingRig final : public CameraRig {
 public:
  /// `back_W`: direction to the camera; none: that of the overview of the world.
  FramingRig(const sim::World& world, const SceneView& like, std::optional<sim::Vector3d> back_W,
             const std::string& vehicle)
      : world_(world), view_(like), vehicle_(vehicle) {
    back_W_ = back_W ? *back_W : sim::Vector3d(-overview_of(world, like.optics).X_WS.linear().col(0));
  }

  std::string subject() const override { return vehicle_; }
  SceneView view(double film_step_s) override {
    if (!vehicle_.empty() && world_.find_vehicle(vehicle_) == nullptr) return view_;  // it was removed
    const sim::Pose wanted_W = framing_pose(world_, view_.optics, back_W_, vehicle_);
    const double share = first_ ? 1 : share_of_way(film_step_s, 0.7);
    first_ = false;
    view_.X_WS.linear() = wanted_W.linear();
    view_.X_WS.translation() += share * (wanted_W.translation() - view_.X_WS.translation());
    return view_;
  }

 private:
  const sim::World& world_;
  SceneView view_;
  std::string vehicle_;
  sim::Vector3d back_W_;
  bool first_ = true;
};

/// Camera of a vehicle, scaled to the size of the film.
class MountedRig final : public CameraRig {
 public:
  MountedRig(const sim::World& world, const SceneView& like, const std::string& name)
      : world_(world), like_(like), name_(name), view_(view_of_camera(world, name)) {}

  std::string subject() const override { return name_.substr(0, name_.find_first_of("./")); }
  SceneView view(double) override {
    if (world_.find_vehicle(subject()) == nullptr) return view_;  // it was removed
    SceneView view = view_of_camera(world_, name_);
    scale(view.optics);
    view.antialias = std::max(view.antialias, like_.antialias);
    if (!view.water) view.water = like_.water;
    return view_ = view;
  }

 private:
  /// Fits the image into the film.
  void scale(sim::OpticsConfig& optics) const {
    const double factor = std::min(static_cast<double>(like_.optics.width) / optics.width,
                                   static_cast<double>(like_.optics.height) / optics.height);
    optics.width = std::max(1, static_cast<int>(std::lround(factor * optics.width)));
    optics.height = std::max(1, static_cast<int>(std::lround(factor * optics.height)));
    for (double& focal_px : optics.focal_px) focal_px *= factor;
    for (double& principal_px : optics.principal_px) principal_px *= factor;
  }

  const sim::World& world_;
  SceneView like_;
  std::string name_;
  SceneView view_;
};

/// Camera on a path through key poses.
class PathRig final : public CameraRig {
 public:
  PathRig(const sim::World& world, const SceneView& like, const std::string& file)
      : world_(world), view_(like), path_(read_camera_path(file)) {
    if (!path_.follow.empty()) vehicle_of(world, file, path_.follow);
  }

  std::string subject() const override { return path_.follow; }
  SceneView view(double) override {
    const CameraKey key = path_.at(sim::to_seconds(world_.now()));
    if (const sim::Vehicle* vehicle = path_.follow.empty() ? nullptr : world_.find_vehicle(path_.follow))
      origin_W_ = vehicle->X_WV().translation();
    view_.optics.fov_rad = key.fov_rad;
    view_.X_WS = look_at(origin_W_ + key.eye_m, origin_W_ + key.look_m);
    return view_;
  }

 private:
  const sim::World& world_;
  SceneView view_;
  CameraPath path_;
  sim::Vector3d origin_W_ = sim::Vector3d::Zero();
};

}  // namespace

SceneView view_of_camera(const sim::World& world, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& device : world.devices()) {
    if (!device) continue;
    const auto* camera = dynamic_cast<const devices::Camera*>(device->sensor());
    if (camera == nullptr) continue;
    names.push_back(device->vehicle().name() + "." + device->config().name);
    if (name != names.back() && name != device->full_name()) continue;
    // Lens and pose of the camera.
    const sim::DeviceConfig& config = device->config();
    const sim::Vehicle& vehicle = device->vehicle();
    const sim::Body& body = config.body.empty() ? vehicle.base() : vehicle.body(config.body);
    SceneView view;
    view.optics = camera->params().optics;
    view.X_WS = body.X_WB() * config.X_BS();
    view.options = camera->render_options();
    // Vectors have no look: the camera is drawn in color.
    if (view.options.kind == sim::ImageKind::normals || view.options.kind == sim::ImageKind::flow)
      view.options.kind = sim::ImageKind::color;
    view.grey = camera->params().image == devices::Camera::Kind::grey;
    view.water = camera->water_look(camera->params());
    view.follows_daylight = !view.water;
    view.flat_port = camera->params().flat_port;
    view.antialias = camera->params().antialias;
    view.gain = static_cast<float>(camera->params().exposure.gain);
    return view;
  }
  throw CameraError("there is no camera '" + sim::printable(name) + "'" +
                    (names.empty() ? "; this world has none" : "; there are: " + sim::list_text(names, 12)));
}

std::string first_camera(const sim::World& world, const std::string& vehicle) {
  for (const auto& device : world.devices())
    if (device && dynamic_cast<const devices::Camera*>(device->sensor()) != nullptr &&
        (vehicle.empty() || device->vehicle().name() == vehicle))
      return device->full_name();
  return "";
}

std::unique_ptr<CameraRig> make_camera_rig(const std::string& text, const sim::World& world, const SceneView& like) {
  const std::size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  const std::string name = colon == std::string::npos ? "" : text.substr(colon + 1);
  const bool named = colon != std::string::npos;
  if (text == "all") return std::make_unique<FramingRig>(world, like, std::nullopt, "");
  if (kind == "top") {
    // The name is checked now, not after minutes of rendering.
    if (named) vehicle_of(world, text, name);
    return std::make_unique<FramingRig>(world, like, sim::Vector3d::UnitZ(), name);
  }
  if (kind == "chase" && named) return std::make_unique<ChaseRig>(world, like, text, name);
  if (kind == "orbit" && named) return std::make_unique<OrbitRig>(world, like, text, name);
  if (kind == "from" && named) return std::make_unique<MountedRig>(world, like, name);
  if (text.ends_with(".yaml") || text.ends_with(".yml")) return std::make_unique<PathRig>(world, like, text);
  throw CameraError("camera '" + sim::printable(text) +
                    "': must be all, top, top:VEHICLE, chase:VEHICLE, orbit:VEHICLE, from:VEHICLE/CAMERA or a file "
                    "*.yaml");
}

}  // namespace viewer
