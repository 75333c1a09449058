// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/director/world_observer.hpp"
#include "sim/world/world.hpp"
#include "viewer/estimates/log_estimates.hpp"
#include "viewer/estimates/log_paths.hpp"
#include "viewer/film/laser_scans.hpp"
#include "viewer/film/overlay_canvas.hpp"
#include "viewer/film/shape_edges.hpp"

namespace viewer {

/// Signs that are drawn over images.
struct OverlayChoice {
  bool trails = false;    ///< where the vehicles have been
  bool paths = false;     ///< where they mean to go, by messages of a log
  bool ellipses = false;  ///< estimates of a log: position, its covariance (3 sigma) and its error
  bool pings = false;     ///< sound in the water as spheres that expand
  bool rays = false;      ///< rays of laser scanners, from the sensor to what they hit
  bool labels = false;    ///< names of the vehicles
  bool clock = false;     ///< simulated time
  BodyShapes shapes = BodyShapes::drawn;

  bool any() const {
    return trails || paths || ellipses || pings || rays || labels || clock || shapes != BodyShapes::drawn;
  }
};

/// Parses `trails,labels` and so on, `all` or `none`; bodies are drawn as they look.  Throws std::invalid_argument.
OverlayChoice parse_overlays(const std::string& text);

/// Sound that a transducer sent.
struct FilmPing {
  sim::Vector3d position_W = sim::Vector3d::Zero();
  double start_s = 0;
  double duration_s = 0;
  double speed_mps = 1500;
};

/// Overlays of the images of a run.
class Overlay {
 public:
  struct Settings {
    OverlayChoice choice;
    double trail_s = 60;  ///< simulated time that a trail covers
    double ping_range_m = 2000;
    std::string title;  ///< beside the clock
  };

  /// `world` must outlive this.
  Overlay(const sim::World& world, Settings settings, LogEstimates estimates, LogPaths paths = {});

  /// Notes where the vehicles are.  To be called at least once before each image; between images it makes trails
  /// smoother.
  void observe();
  /// Notes what laser scanners measure.  To be called after each step of the last LaserScans::kept_s before an image.
  void observe_scans();
  /// Adds a sound.  Of very many the last ones are drawn.
  void add(const FilmPing& ping);
  /// Prepares a view for draw(): without the bodies where only their edges are to be seen.
  void prepare(SceneView& view) const;
  /// Draws into a color image of the present state of the world.
  void draw(RenderedScene& rendered, const SceneView& view) const;

 private:
  /// Path of a vehicle, or of its estimate.
  struct Trail {
    sim::Color color;
    std::deque<std::pair<double, sim::Vector3d>> points_W;  // by time
  };

  static void extend(Trail& trail, double now_s, const sim::Vector3d& p_W, double trail_s);
  void draw_trails(OverlayCanvas& canvas) const;
  void draw_paths(OverlayCanvas& canvas) const;
  void draw_estimates(OverlayCanvas& canvas) const;
  void draw_pings(OverlayCanvas& canvas) const;
  void draw_rays(OverlayCanvas& canvas) const;
  void draw_labels(OverlayCanvas& canvas, const SceneView& view) const;
  void draw_clock(OverlayCanvas& canvas, const SceneView& view) const;

  const sim::World& world_;
  Settings settings_;
  LogEstimates estimates_;
  LogPaths paths_;
  std::map<std::string, Trail> trails_, estimate_trails_;
  std::deque<FilmPing> pings_;
  LaserScans scans_;
  std::unique_ptr<ShapeEdges> edges_;
};

/// Observer that gives the sounds of a world to an overlay.
class PingObserver final : public sim::WorldObserver {
 public:
  /// Observes while it exists.  Both must outlive it.
  PingObserver(sim::World& world, Overlay& overlay) : world_(world), overlay_(overlay) { world_.set_observer(this); }
  ~PingObserver() override { world_.set_observer(nullptr); }
  PingObserver(const PingObserver&) = delete;
  PingObserver& operator=(const PingObserver&) = delete;

  void sound_sent(const sim::SoundSent& sent) override {
    overlay_.add({sent.p_W, sim::to_seconds(sent.sent), sim::to_seconds(sent.signal.duration), sent.sound_speed_mps});
  }
  void sound_arrived(const sim::SoundArrived&) override {}
  void happened(const sim::Occurrence&) override {}

 private:
  sim::World& world_;
  Overlay& overlay_;
};

}  // namespace viewer
