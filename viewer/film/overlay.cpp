// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/overlay.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>

#include "sim/base/vehicle_colors.hpp"

namespace viewer {

namespace {

constexpr double max_estimate_age_s = 30;
constexpr std::size_t max_trail_points = 4000;
constexpr std::size_t max_pings = 500;
constexpr double path_height_m = 0.03;  ///< above the vehicle frame, which is on the ground on land
constexpr sim::Color ping_color{255, 255, 160};
constexpr sim::Color ray_color{255, 157, 60};  ///< as on the live page

/// Returns a color of 0xrrggbb.
constexpr sim::Color color_from(std::uint32_t rgb) {
  return {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8 & 0xff),
          static_cast<std::uint8_t>(rgb & 0xff)};
}

constexpr sim::Color estimate_color = color_from(sim::estimate_color);

sim::Color color_of(int number) {
  return color_from(sim::vehicle_color(number));
}

}  // namespace

OverlayChoice parse_overlays(const std::string& text) {
  OverlayChoice choice;
  std::istringstream words(text);
  std::string word;
  while (std::getline(words, word, ',')) {
    if (word == "none") continue;
    const bool all = word == "all";
    if (!all && word != "trails" && word != "paths" && word != "ellipses" && word != "pings" && word != "rays" &&
        word != "labels" && word != "clock")
      throw std::invalid_argument(
          "must be trails, paths, ellipses, pings, rays, labels and clock, separated by commas, all or none, "
          "got '" +
          text + "'");
    choice.trails |= all || word == "trails";
    choice.paths |= all || word == "paths";
    choice.ellipses |= all || word == "ellipses";
    choice.pings |= all || word == "pings";
    choice.rays |= all || word == "rays";
    choice.labels |= all || word == "labels";
    choice.clock |= all || word == "clock";
  }
  return choice;
}

Overlay::Overlay(const sim::World& world, Settings settings, LogEstimates estimates, LogPaths paths)
    : world_(world),
      settings_(std::move(settings)),
      estimates_(std::move(estimates)),
      paths_(std::move(paths)),
      scans_(world),
      edges_(std::make_unique<ShapeEdges>(world)) {}

void Overlay::extend(Trail& trail, double now_s, const sim::Vector3d& p_W, double trail_s) {
  auto& points_W = trail.points_W;
  if (!points_W.empty() && points_W.back().first >= now_s) return;
  points_W.emplace_back(now_s, p_W);
  while (points_W.front().first < now_s - trail_s || points_W.size() > max_trail_points) points_W.pop_front();
}

void Overlay::add(const FilmPing& ping) {
  pings_.push_back(ping);
  if (pings_.size() > max_pings) pings_.pop_front();
}

void Overlay::observe_scans() {
  if (settings_.choice.rays) scans_.observe();
}

void Overlay::observe() {
  const double now_s = sim::to_seconds(world_.now());
  observe_scans();
  if (settings_.choice.trails) {
    for (const auto& vehicle : world_.vehicles()) {
      Trail& trail = trails_[vehicle->name()];
      trail.color = color_of(vehicle->number());
      extend(trail, now_s, vehicle->X_WV().translation(), settings_.trail_s);
    }
    std::erase_if(trails_, [&](const auto& each) { return world_.find_vehicle(each.first) == nullptr; });
  }
  if (settings_.choice.ellipses)
    for (const auto& vehicle : world_.vehicles())
      if (const LogEstimate* estimate = estimates_.find(vehicle->name(), now_s, max_estimate_age_s))
        extend(estimate_trails_[vehicle->name()], now_s, estimate->position_m, settings_.trail_s);
  // Sound that has left the range.
  std::erase_if(pings_, [&](const FilmPing& ping) {
    return (now_s - ping.start_s - ping.duration_s) * ping.speed_mps > settings_.ping_range_m;
  });
}

void Overlay::prepare(SceneView& view) const {
  const bool only_edges = settings_.choice.shapes == BodyShapes::wire;
  if (only_edges && view.options.kind == sim::ImageKind::color) view.options.filter.categories = 0;
}

void Overlay::draw(RenderedScene& rendered, const SceneView& view) const {
  OverlayCanvas canvas(rendered, view);
  if (settings_.choice.shapes != BodyShapes::drawn) edges_->draw(canvas, settings_.choice.shapes);
  if (settings_.choice.pings) draw_pings(canvas);
  if (settings_.choice.rays) draw_rays(canvas);
  if (settings_.choice.paths) draw_paths(canvas);
  if (settings_.choice.trails) draw_trails(canvas);
  if (settings_.choice.ellipses) draw_estimates(canvas);
  if (settings_.choice.labels) draw_labels(canvas, view);
  if (settings_.choice.clock) draw_clock(canvas, view);
}

void Overlay::draw_trails(OverlayCanvas& canvas) const {
  const double now_s = sim::to_seconds(world_.now());
  for (const auto& [name, trail] : trails_) {
    // The trail fades towards its end.
    for (std::size_t i = 1; i < trail.points_W.size(); ++i) {
      const double age = (now_s - trail.points_W[i].first) / settings_.trail_s;
      Pen pen{trail.color, 2, static_cast<float>(std::clamp(1 - 0.85 * age, 0.1, 1.0))};
      pen.hidden_opacity = 0.35F;
      canvas.line(trail.points_W[i - 1].second, trail.points_W[i].second, pen);
    }
  }
}

void Overlay::draw_paths(OverlayCanvas& canvas) const {
  for (const auto& [channel, path] : paths_.at(sim::to_seconds(world_.now()))) {
    const sim::Vehicle* const vehicle = world_.find_vehicle(path_vehicle(channel));
    const double height_m = (vehicle == nullptr ? 0 : vehicle->X_WV().translation().z()) + path_height_m;
    std::vector<sim::Vector3d> points_W;
    for (const VehiclePath::Point& point : path->points) {
      const double z_m = world_.medium().still_surface_m() - point.depth_m;  // not finite without water or depth
      points_W.emplace_back(point.x_m, point.y_m, std::isfinite(z_m) ? z_m : height_m);
    }
    if (points_W.empty()) continue;
    if (path->loop) points_W.push_back(points_W.front());
    // Paler than the trail.
    sim::Color color = vehicle == nullptr ? sim::Color{255, 255, 255} : color_of(vehicle->number());
    for (std::uint8_t& level : color) level = static_cast<std::uint8_t>((level + 255) / 2);
    Pen pen{color, 2, 0.9F}, dot = pen;
    pen.hidden_opacity = 0.5F;
    dot.width_px = 6;
    dot.hidden_opacity = 0.5F;
    canvas.polyline(points_W, pen);
    for (const sim::Vector3d& p_W : points_W) canvas.dot(p_W, dot);
  }
}

void Overlay::draw_estimates(OverlayCanvas& canvas) const {
  const double now_s = sim::to_seconds(world_.now());
  for (const auto& vehicle : world_.vehicles()) {
    const LogEstimate* estimate = estimates_.find(vehicle->name(), now_s, max_estimate_age_s);
    if (estimate == nullptr) continue;
    // Where it thinks it is, and the error.
    const Pen pen{estimate_color, 1.5F, 0.9F};
    Pen dot = pen, error = pen;
    dot.width_px = 7;
    dot.hidden_opacity = 0.8F;
    error.opacity = 0.6F;
    error.hidden_opacity = 0.6F;
    canvas.dot(estimate->position_m, dot);
    canvas.line(estimate->position_m, vehicle->X_WV().translation(), error);
    // The ellipsoid of 3 sigma by its three principal ellipses.
    if (!estimate->covariance_m2 || !estimate->covariance_m2->allFinite()) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(*estimate->covariance_m2);
    if (solver.info() != Eigen::Success || !solver.eigenvalues().allFinite()) continue;
    sim::Vector3d axes_W[3];
    for (int i = 0; i < 3; ++i)
      axes_W[i] = 3 * std::sqrt(std::max(0.0, solver.eigenvalues()[i])) * solver.eigenvectors().col(i);
    for (int i = 0; i < 3; ++i) canvas.ellipse(estimate->position_m, axes_W[i], axes_W[(i + 1) % 3], pen);
  }
  for (const auto& [name, trail] : estimate_trails_)
    for (std::size_t i = 1; i < trail.points_W.size(); ++i)
      canvas.line(trail.points_W[i - 1].second, trail.points_W[i].second, {estimate_color, 1.2F, 0.5F});
}

void Overlay::draw_pings(OverlayCanvas& canvas) const {
  const double now_s = sim::to_seconds(world_.now());
  for (const FilmPing& ping : pings_) {
    const double front_m = (now_s - ping.start_s) * ping.speed_mps;
    if (front_m <= 0 || front_m > settings_.ping_range_m) continue;
    // Front and tail of the sound, each as three circles; it becomes weaker with the range.
    const double tail_m = std::max(0.0, front_m - ping.duration_s * ping.speed_mps);
    const auto strength = static_cast<float>(std::clamp(1 - front_m / settings_.ping_range_m, 0.05, 1.0));
    for (const double radius_m : {front_m, tail_m}) {
      if (radius_m <= 0) continue;
      const Pen pen{ping_color, 1.5F, (radius_m == front_m ? 0.8F : 0.4F) * strength};
      for (int i = 0; i < 3; ++i)
        canvas.ellipse(ping.position_W, radius_m * sim::Vector3d::Unit(i), radius_m * sim::Vector3d::Unit((i + 1) % 3),
                       pen);
    }
  }
}

void Overlay::draw_rays(OverlayCanvas& canvas) const {
  for (const auto& [name, scan] : scans_.scans()) {
    // Thousands of rays must leave something to be seen behind them.
    const auto count = static_cast<float>(std::max<std::size_t>(1, scan->rays.size()));
    Pen ray{ray_color, 1, std::clamp(90 / count, 0.05F, 0.6F)}, hit{ray_color, 4, 0.95F};
    ray.hidden_opacity = hit.hidden_opacity = 0.3F;
    for (const LaserScans::Ray& each : scan->rays) canvas.line(each.from_W, each.to_W, ray);
    for (const LaserScans::Ray& each : scan->rays) canvas.dot(each.to_W, hit);
  }
}

void Overlay::draw_labels(OverlayCanvas& canvas, const SceneView& view) const {
  const auto parts = world_.physics().parts();
  std::map<int, double> tops_m;  // by group
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].group >= 0)
      if (const auto box = world_.physics().bounds_W(static_cast<int>(i))) {
        const auto top = tops_m.try_emplace(parts[i].group, box->max().z()).first;
        top->second = std::max(top->second, box->max().z());
      }
  for (const auto& vehicle : world_.vehicles()) {
    if (vehicle->group() == view.options.filter.exclude_group) continue;  // the camera is on it
    sim::Vector3d p_W = vehicle->X_WV().translation();
    if (const auto top = tops_m.find(vehicle->group()); top != tops_m.end()) p_W.z() = top->second;
    canvas.label(p_W, vehicle->name(), {color_of(vehicle->number())});
  }
}

void Overlay::draw_clock(OverlayCanvas& canvas, const SceneView& view) const {
  const double now_s = sim::to_seconds(world_.now());
  const int minutes = static_cast<int>(now_s / 60);
  const double seconds = now_s - 60.0 * minutes;
  const std::string time = minutes >= 60 ? fmt::format("{}:{:02}:{:04.1f}", minutes / 60, minutes % 60, seconds)
                           : minutes > 0 ? fmt::format("{}:{:04.1f}", minutes, seconds)
                                         : fmt::format("{:.1f} s", now_s);
  const float margin = 1.6F * canvas.text_height();
  const auto height = static_cast<float>(view.optics.height);
  canvas.text(margin, height - margin, time + (settings_.title.empty() ? "" : "  " + settings_.title), {});
}

}  // namespace viewer
