// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/world_file/load_world.hpp"
#include "viewer/film/film_writer.hpp"
#include "viewer/film/overlay.hpp"
#include "viewer/film/scene_painter.hpp"

namespace viewer {

struct FilmOptions {
  std::string source;  ///< a log of `shoal run --record`, or a world
  sim::LoadOptions load;
  std::string out;
  FilmFormat format;
  std::vector<std::string> cameras;  ///< one, or two side by side
  bool split = false;                ///< the camera on board beside the one of `cameras`
  double from_s = 0;
  std::optional<double> until_s;  ///< of a log: its end; of a world: 10 s of film
  double speed = 1;               ///< playback speed: simulated seconds per second of film
  double fov_rad = sim::degrees_to_radians(60);
  int antialias = 1;
  std::optional<double> visibility_m = 60;  ///< none: the water is invisible
  OverlayChoice overlays;
  int threads = 0;  ///< for rendering; 0: one for each processor
  bool quiet = false;
};

/// Result of a film.
struct FilmOutcome {
  std::int64_t frames = 0;
  double film_s = 0, sim_s = 0, wall_s = 0;
  std::string note;          ///< why it is shorter than asked for; empty: it is not
  bool interrupted = false;  ///< by a signal; there is no film then

  /// Returns `film.mp4: 300 frames of 640x480, 10.0 s, in 7.1 s (42 frames/s)`.
  std::string to_text(const FilmOptions& options) const;
};

/// Returns the lens of a film, without a pose.
SceneView film_view(const FilmOptions& options, const sim::World& world);
/// Returns the settings of the overlays of a film.
Overlay::Settings film_overlay(const FilmOptions& options);

/// Renders a film of a run.  Throws sim::ConfigError, std::invalid_argument and CameraError (options), FilmError and
/// std::runtime_error (files), sim::PhysicsFault.
FilmOutcome make_film(const FilmOptions& options);

}  // namespace viewer
