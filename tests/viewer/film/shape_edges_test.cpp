// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/shape_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/scratch_folder.hpp"
#include "viewer/film/overlay.hpp"
#include "viewer/film/scene_painter.hpp"

namespace {

double length_of(const std::vector<sim::Vector3d>& line) {
  double sum_m = 0;
  for (std::size_t i = 1; i < line.size(); ++i) sum_m += (line[i] - line[i - 1]).norm();
  return sum_m;
}

TEST(ShapeEdges, AreThoseOfTheShapes) {
  sim::PartConfig part;
  part.size_m = {1, 2, 3};
  double sum_m = 0;
  for (const auto& line : viewer::ShapeEdges::lines_of(part)) sum_m += length_of(line);
  EXPECT_EQ(viewer::ShapeEdges::lines_of(part).size(), 12U);
  EXPECT_DOUBLE_EQ(sum_m, 4 * (1 + 2 + 3));
  // Great circles of a sphere, and what is as far from the axis of a cylinder as its radius.
  part.radius_m = 0.5, part.length_m = 4;
  part.shape = sim::PartShape::sphere;
  for (const auto& line : viewer::ShapeEdges::lines_of(part))
    for (const sim::Vector3d& point : line) EXPECT_NEAR(point.norm(), 0.5, 1e-12);
  part.shape = sim::PartShape::cylinder;
  for (const auto& line : viewer::ShapeEdges::lines_of(part))
    for (const sim::Vector3d& point : line) {
      EXPECT_NEAR(point.head<2>().norm(), 0.5, 1e-12);
      EXPECT_NEAR(std::abs(point.z()), 2, 1e-12);
    }
  // The caps of a capsule reach half a meter beyond its ends.
  part.shape = sim::PartShape::capsule;
  double top_m = 0, bottom_m = 0;
  for (const auto& line : viewer::ShapeEdges::lines_of(part))
    for (const sim::Vector3d& point : line) {
      top_m = std::max(top_m, point.z());
      bottom_m = std::min(bottom_m, point.z());
    }
  EXPECT_NEAR(top_m, 2.5, 1e-12);
  EXPECT_NEAR(bottom_m, -2.5, 1e-12);
  part.shape = sim::PartShape::plane;
  EXPECT_TRUE(viewer::ShapeEdges::lines_of(part).empty());
}

/// A block of 2 m, 10 m ahead of the camera at the origin, and a lamp of 0.4 m at its left that collides with nothing.
struct Block {
  explicit Block(viewer::BodyShapes shapes, const std::string& block = "shape: box, size_m: [2, 2, 2]")
      : loaded(
            sim::load_world_text("shoal: 1\nname: block\ncategories: [light]\nobjects:\n"
                                 "  - name: block\n    fixed: true\n    position_m: [10, 0, 0]\n    parts:\n"
                                 "      - {" +
                                     block +
                                     ", color: \"#ffffff\"}\n"
                                     "      - {shape: box, size_m: [0.4, 0.4, 0.4], position_m: [0, 5, 0], category: "
                                     "light, collides_with: [light], color: \"#ffffff\"}\n",
                                 "block", {})),
        world(loaded.config, bus) {
    viewer::Overlay::Settings settings;
    settings.choice.shapes = shapes;
    const viewer::Overlay overlay(world, settings, {});
    viewer::SceneView view;
    view.optics.width = 201, view.optics.height = 101;
    view.optics.focal_px = {100};
    view.optics.principal_px = {100.5, 50.5};
    view.antialias = 1;
    overlay.prepare(view);
    viewer::ScenePainter painter(world, 1);
    viewer::RenderedScene& rendered = painter.paint(view);
    before = rendered.image;
    overlay.draw(rendered, view);
    after = rendered.image;
  }

  /// Whether anything was drawn in the columns [from, to] of the middle row.
  bool drawn(int from, int to) const {
    for (int column = from; column <= to; ++column)
      if (!std::equal(before.at(column, 50), before.at(column, 50) + 3, after.at(column, 50))) return true;
    return false;
  }

  sim::LoadedWorld loaded;
  sim::InProcessBus bus;
  sim::World world;
  sim::Image8 before, after;
};

TEST(ShapeEdges, OfAWireFrameStandAloneInTheImage) {
  const Block wire(viewer::BodyShapes::wire);
  // The face is at 9 m: its upright edges are 100/9 px from the middle, those behind 100/11 px; the lamp is at 50 px.
  EXPECT_TRUE(wire.drawn(88, 90));
  EXPECT_TRUE(wire.drawn(110, 112));
  EXPECT_FALSE(wire.drawn(94, 107));
  EXPECT_TRUE(wire.drawn(45, 55));
  // Without the block there is the sky on both sides of an edge.
  EXPECT_EQ(wire.before.at(100, 50)[0], wire.before.at(150, 50)[0]);
}

TEST(ShapeEdges, OfCollisionsAreOnTheBodiesThatCollide) {
  const Block collision(viewer::BodyShapes::collision);
  EXPECT_TRUE(collision.drawn(88, 90));
  EXPECT_FALSE(collision.drawn(45, 55));                                        // the lamp
  EXPECT_NE(collision.before.at(100, 50)[0], collision.before.at(150, 50)[0]);  // the block is there
  const Block drawn(viewer::BodyShapes::drawn);
  EXPECT_EQ(drawn.before.data, drawn.after.data);
}

TEST(ShapeEdges, OfAMeshAreThoseBetweenItsFaces) {
  // A plate of 2 m in the yz-plane, of two triangles: its diagonal is none.
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("plate.obj")) << "v 0 -1 -1\nv 0 1 -1\nv 0 1 1\nv 0 -1 1\nf 1 2 3\nf 1 3 4\n";
  const Block plate(viewer::BodyShapes::wire, "shape: mesh, mesh: \"" + folder.file("plate.obj") + "\"");
  EXPECT_TRUE(plate.drawn(89, 92));  // 10 px
  EXPECT_TRUE(plate.drawn(109, 112));
  EXPECT_FALSE(plate.drawn(95, 106));
}

}  // namespace
