// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/scene_names.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "viewer/log/state_frame.hpp"

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::string scene(int revision, const std::vector<std::string>& names) {
  std::string bodies;
  for (const std::string& name : names) bodies += R"({"name":")" + name + R"("},)";
  return R"({"revision":)" + std::to_string(revision) + R"(,"bodies":[)" + bodies + R"({"name":"wall","fixed":true}]})";
}

/// The x of bodies, -1 for those that are unknown.
std::vector<float> xs_of(std::span<const std::byte> bodies) {
  std::vector<float> xs;
  for (std::size_t at = 0; at < bodies.size(); at += viewer::StateFrame::body_bytes) {
    float x = 0;
    std::memcpy(&x, bodies.data() + at, sizeof x);
    xs.push_back(std::isnan(x) ? -1 : x);
  }
  return xs;
}

/// Bodies at x = 1, 2, ...
viewer::StateFrame frame_of(int count) {
  viewer::StateFrame frame;
  frame.begin({});
  for (int i = 1; i <= count; ++i) frame.add({static_cast<double>(i), 0, 0}, sim::Quaterniond::Identity());
  return frame;
}

TEST(SceneNames, AreThoseOfTheMovableBodiesOfEachRevision) {
  viewer::SceneNames names;
  EXPECT_EQ(names.newest(), 0u);
  names.add(scene(3, {"a", "b"}));
  names.add(scene(4, {"b"}));
  EXPECT_EQ(names.newest(), 4u);
  EXPECT_THAT(names.of(3), ElementsAre("a", "b"));
  EXPECT_THAT(names.of(4), ElementsAre("b"));
  EXPECT_THAT(names.of(5), IsEmpty());
}

TEST(SceneNames, WhatIsNoSceneIsIgnored) {
  viewer::SceneNames names;
  names.add(scene(3, {"a"}));
  for (const char* text : {"", "[", "[]", "{}", R"({"bodies":[]})", R"({"revision":9,"bodies":3})"}) names.add(text);
  EXPECT_EQ(names.newest(), 3u);
}

TEST(SceneNames, TheOldestOfTooManyAreForgotten) {
  viewer::SceneNames names;
  for (int revision = 1; revision <= static_cast<int>(viewer::SceneNames::max_scenes) + 1; ++revision)
    names.add(scene(revision, {"a"}));
  EXPECT_THAT(names.of(1), IsEmpty());
  EXPECT_THAT(names.of(2), ElementsAre("a"));
}

TEST(SceneNames, BringBodiesIntoTheOrderOfTheNewestScene) {
  viewer::SceneNames names;
  names.add(scene(1, {"a", "b", "gone"}));
  names.add(scene(2, {"b", "new", "a"}));
  const viewer::StateFrame old = frame_of(3);
  viewer::StateFrame shown;
  shown.begin({});
  names.arrange(1, old.bodies(), shown);
  EXPECT_THAT(xs_of(shown.bodies()), ElementsAre(2, -1, 1));
  shown.begin({});
  names.arrange(2, old.bodies(), shown);
  EXPECT_THAT(xs_of(shown.bodies()), ElementsAre(1, 2, 3));
}

TEST(SceneNames, BodiesWithoutANameAreLeftOut) {
  const viewer::StateFrame bodies = frame_of(3);
  viewer::StateFrame shown;
  shown.begin({});
  viewer::arrange(bodies.bodies(), {"a", "b"}, {"a", "b"}, shown);
  EXPECT_THAT(xs_of(shown.bodies()), ElementsAre(1, 2));
}

}  // namespace
