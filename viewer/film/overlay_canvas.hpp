// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/camera/optics.hpp"
#include "sim/image/image.hpp"
#include "sim/scene/material.hpp"
#include "viewer/film/scene_painter.hpp"

namespace viewer {

/// Look of a line, a dot or a text.
struct Pen {
  sim::Color color{255, 255, 255};
  float width_px = 1.5F;
  float opacity = 1;
  float hidden_opacity = 0.25F;  ///< times `opacity` where something is in front
};

/// Drawing in an image of a scene: points of the world are projected, and compared with the depth of the image.
class OverlayCanvas {
 public:
  /// `rendered` is drawn into and must outlive this; `view` is the camera with which it was painted.
  OverlayCanvas(RenderedScene& rendered, const SceneView& view);

  /// Draws a line between two points of the world.
  void line(const sim::Vector3d& from_W, const sim::Vector3d& to_W, const Pen& pen);
  /// Draws a line through points of the world.
  void polyline(std::span<const sim::Vector3d> points_W, const Pen& pen);
  /// Draws an ellipse with two half axes.
  void ellipse(const sim::Vector3d& center_W, const sim::Vector3d& axis_W, const sim::Vector3d& other_axis_W,
               const Pen& pen);
  /// Draws a disc of a diameter of `pen.width_px` at a point of the world.
  void dot(const sim::Vector3d& p_W, const Pen& pen);
  /// Writes text, centered above a point of the world, and above the labels that were written there before.
  void label(const sim::Vector3d& p_W, const std::string& text, const Pen& pen);
  /// Writes text with its base line from (u, v) on, in pixels.
  void text(float u, float v, const std::string& text, const Pen& pen);

  /// Returns the place of a point of the world in the image; none: behind the camera or outside the lens.
  std::optional<sim::Vector2d> pixel(const sim::Vector3d& p_W) const;
  /// Returns the height of capitals in pixels.
  float text_height() const { return 6 * unit_px_; }
  float text_width(const std::string& text) const;

 private:
  /// Point in the image.
  struct Place {
    float u = 0, v = 0;
    float inverse_depth = 0;  // linear along a line in the image
  };

  /// Base line of a label: its left end, its height in the image, its width.
  struct LabelPlace {
    float u = 0, v = 0, width = 0;
  };

  Place place_of(const sim::Vector2d& pixel, double depth_m) const;
  std::optional<Place> project(const sim::Vector3d& p_S) const;
  void segment(const Place& from, const Place& to, const Pen& pen, bool tested);
  void blend(int column, int row, float opacity, const Pen& pen);
  bool is_hidden(int column, int row, float inverse_depth) const;
  void strokes(float u, float v, const std::string& text, const Pen& pen);

  sim::Image8& image_;
  const sim::FloatImage& depth_m_;
  sim::Optics optics_;
  sim::Pose X_SW_;
  bool straight_;  // lines of the world are straight in the image
  float unit_px_;  // of the font
  std::vector<LabelPlace> labels_;
};

/// Returns the strokes of a character of ASCII, drawn by lines: `082248 0242` are two lines through the points
/// (0, 8), (2, 2), (4, 8) and (0, 2), (4, 2).  x is 0 to 4, y upwards: 2 is the base line, 6 the height of small
/// letters, 8 that of capitals.  Other characters have the strokes of `?`.
std::string_view strokes_of(char character);

/// Distance between characters, in the same unit.
inline constexpr float character_width = 5.8F;

}  // namespace viewer
