// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sim/world/world.hpp"
#include "viewer/film/overlay_canvas.hpp"

namespace viewer {

/// How bodies are shown.
enum class BodyShapes {
  drawn,      ///< as they look
  collision,  ///< with the edges of those parts that collide, green of what can move and gray of what is fixed
  wire,       ///< only the edges of all parts
};

/// Edges of the parts of a world.  Planes and terrains have none.
class ShapeEdges {
 public:
  using Lines = std::vector<std::vector<sim::Vector3d>>;

  /// `world` must outlive this.
  explicit ShapeEdges(const sim::World& world) : world_(world) {}

  /// Draws the edges of the parts at their present poses.
  void draw(OverlayCanvas& canvas, BodyShapes shapes);

  /// Returns the edges of a box, sphere, cylinder or capsule in the frame of the part; none of other shapes.
  static Lines lines_of(const sim::PartConfig& part);

 private:
  void draw(OverlayCanvas& canvas, const sim::PartConfig& part, const sim::Pose& X_WB, const Pen& pen);
  const Lines& lines_of_mesh(const sim::PartConfig& part);

  const sim::World& world_;
  std::map<std::pair<std::string, double>, Lines> meshes_;  // by file and scale
};

}  // namespace viewer
