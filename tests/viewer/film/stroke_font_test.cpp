// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/stroke_font.hpp"

#include <gtest/gtest.h>

#include "viewer/film/overlay.hpp"
#include "viewer/film/overlay_canvas.hpp"

namespace {

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
