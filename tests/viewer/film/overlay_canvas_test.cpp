// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/overlay_canvas.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "viewer/film/overlay.hpp"

namespace {

/// A black image of 200 x 100 pixels with a focal length of 100 px; the camera is at the origin and looks along x.
/// Something at a depth of 10 m covers its right half.
struct Drawing {
  Drawing() {
    view.optics.width = 200, view.optics.height = 100;
    view.optics.focal_px = {100};
    rendered.image = sim::Image8(200, 100, 3);
    rendered.depth_m = sim::FloatImage(200, 100, 1);
    for (int row = 0; row < 100; ++row)
      for (int column = 0; column < 200; ++column)
        *rendered.depth_m.at(column, row) = column < 100 ? std::numeric_limits<float>::infinity() : 10.0F;
  }
  int level(int column, int row) const { return *rendered.image.at(column, row); }
  int brightness() const {
    int sum = 0;
    for (const std::uint8_t each : rendered.image.data) sum += each;
    return sum;
  }

  viewer::SceneView view;
  viewer::RenderedScene rendered;
};

TEST(OverlayCanvas, DrawsALineThroughTheProjectionsOfItsEnds) {
  Drawing drawing;
  viewer::OverlayCanvas canvas(drawing.rendered, drawing.view);
  // 5 m ahead: 1 m is 20 px.  y is to the left.
  canvas.line({5, 4, 1}, {5, 1, 1}, {{255, 255, 255}, 2});
  EXPECT_EQ(canvas.pixel({5, 4, 1}), sim::Vector2d(20, 30));
  for (const int column : {22, 50, 78}) {
    EXPECT_EQ(drawing.level(column, 29), 255) << column;
    EXPECT_EQ(drawing.level(column, 30), 255) << column;
    EXPECT_EQ(drawing.level(column, 33), 0) << column;
  }
  EXPECT_EQ(drawing.level(15, 30), 0);
  EXPECT_EQ(drawing.level(85, 30), 0);
}

TEST(OverlayCanvas, FadesWhatIsBehindSomething) {
  Drawing drawing;
  viewer::OverlayCanvas canvas(drawing.rendered, drawing.view);
  viewer::Pen pen{{200, 200, 200}, 4};
  pen.hidden_opacity = 0.5F;
  // From 5 m, before the surface, to 20 m, behind it: it passes 10 m in between, at column 140.
  canvas.line({5, -1, 0}, {20, -10, 0}, pen);
  EXPECT_EQ(canvas.pixel({10, -4, 0}), sim::Vector2d(140, 50));
  EXPECT_EQ(drawing.level(130, 50), 200);
  EXPECT_EQ(drawing.level(146, 50), 100);
  // A line on the surface itself is in front.
  Drawing other;
  viewer::OverlayCanvas(other.rendered, other.view).line({10, -2, 0}, {10, -8, 0}, pen);
  EXPECT_EQ(other.level(150, 50), 200);
}

TEST(OverlayCanvas, CutsOffWhatIsBehindTheCamera) {
  Drawing drawing;
  viewer::OverlayCanvas canvas(drawing.rendered, drawing.view);
  canvas.line({-5, 1, 0}, {-1, -1, 0}, {});
  canvas.dot({-1, 0, 0}, {});
  canvas.label({-1, 0, 0}, "behind", {});
  EXPECT_EQ(drawing.brightness(), 0);
  EXPECT_FALSE(canvas.pixel({-5, 1, 0}));
  // The part before the camera is drawn.
  canvas.line({-5, 0, -1}, {15, 0, -1}, {{255, 255, 255}, 2});
  EXPECT_EQ(drawing.level(99, 80), 255);
}

TEST(OverlayCanvas, DrawsTheVisiblePartOfALineThatPassesFarBesideTheCamera) {
  Drawing drawing;
  // At 1000 m ahead it is 30 px left of the middle, at 300 m it leaves the image; 300 m beside the camera the pixels of
  // its end have no bound.
  viewer::OverlayCanvas(drawing.rendered, drawing.view).line({1000, 300, 0}, {-1000, 300, 0}, {{255, 255, 255}, 2});
  for (const int column : {2, 35, 68}) EXPECT_GT(drawing.level(column, 50), 100) << column;
  EXPECT_EQ(drawing.level(75, 50), 0);
}

TEST(OverlayCanvas, DrawsAnEllipseThroughItsAxes) {
  Drawing drawing;
  viewer::OverlayCanvas canvas(drawing.rendered, drawing.view);
  canvas.ellipse({5, 2, 0}, {0, 1.5, 0}, {0, 0, 2}, {{255, 255, 255}, 2});
  for (const sim::Vector3d& p_W : {sim::Vector3d(5, 3.5, 0), sim::Vector3d(5, 0.5, 0), sim::Vector3d(5, 2, 2)}) {
    const auto pixel = canvas.pixel(p_W);
    ASSERT_TRUE(pixel);
    EXPECT_GT(drawing.level(static_cast<int>(pixel->x()), static_cast<int>(pixel->y())), 100) << p_W.transpose();
  }
  EXPECT_EQ(drawing.level(60, 50), 0);
}

TEST(OverlayCanvas, WritesTextBesideItsStart) {
  Drawing drawing;
  viewer::OverlayCanvas canvas(drawing.rendered, drawing.view);
  const float width = canvas.text_width("HHH");
  canvas.text(50, 60, "HHH", {{255, 255, 255}});
  int white = 0;
  for (int row = 0; row < 100; ++row)
    for (int column = 0; column < 200; ++column) {
      if (drawing.level(column, row) < 200) continue;
      ++white;
      EXPECT_GE(column, 48);
      EXPECT_LE(static_cast<float>(column), 52 + width);
      EXPECT_GE(static_cast<float>(row), 58 - canvas.text_height());
      EXPECT_LE(row, 62);
    }
  EXPECT_GT(white, 20);
}

TEST(OverlayCanvas, WritesLabelsOfOnePlaceAboveEachOther) {
  // Rows with something white: as many lines of text as there are gaps between them.
  const auto lines_of = [](const Drawing& drawing) {
    int lines = 0;
    bool white_before = false;
    for (int row = 0; row < 100; ++row) {
      bool white = false;
      for (int column = 0; column < 200; ++column) white |= drawing.level(column, row) > 200;
      lines += white && !white_before ? 1 : 0;
      white_before = white;
    }
    return lines;
  };
  Drawing near;
  viewer::OverlayCanvas canvas(near.rendered, near.view);
  for (int i = 0; i < 3; ++i) canvas.label({5, 1, 0}, "HHH", {{255, 255, 255}});
  EXPECT_EQ(lines_of(near), 3);
  // Beside each other they stay in one line.
  Drawing apart;
  viewer::OverlayCanvas other(apart.rendered, apart.view);
  for (const double y_m : {3, 1}) other.label({5, y_m, 0}, "HHH", {{255, 255, 255}});
  EXPECT_EQ(lines_of(apart), 1);
}

TEST(Overlays, AreNamedByWords) {
  const viewer::OverlayChoice some = viewer::parse_overlays("trails,clock");
  EXPECT_TRUE(some.trails && some.clock);
  EXPECT_FALSE(some.labels || some.pings || some.ellipses);
  EXPECT_TRUE(viewer::parse_overlays("all").pings);
  EXPECT_FALSE(viewer::parse_overlays("none").any());
  EXPECT_THROW(viewer::parse_overlays("trails,lables"), std::invalid_argument);
}

TEST(StrokeFont, HasAllCharactersOfAsciiWithinItsCell) {
  for (int code = 33; code < 127; ++code) {
    const std::string_view strokes = viewer::strokes_of(static_cast<char>(code));
    EXPECT_FALSE(strokes.empty()) << code;
    std::size_t start = 0;
    while (start < strokes.size()) {
      const std::size_t end = std::min(strokes.find(' ', start), strokes.size());
      EXPECT_EQ((end - start) % 2, 0U) << code;
      EXPECT_GE(end - start, 4U) << code;
      for (std::size_t i = start; i + 1 < end; i += 2) {
        EXPECT_LE(strokes[i], '4') << code;
        EXPECT_GE(strokes[i], '0') << code;
        EXPECT_LE(strokes[i + 1], '9') << code;
      }
      start = end + 1;
    }
  }
  EXPECT_EQ(viewer::strokes_of('\xE4'), viewer::strokes_of('?'));
}

}  // namespace
