// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/log_poses.hpp"

#include <gmock/gmock.h>

#include "tests/viewer/server/log_page.hpp"
#include "viewer/log/state_frame.hpp"

namespace {

TEST(LogPoses, AreThoseOfTheTimeWithTheNamesOfTheBodies) {
  const test::FallLog log;
  const viewer::LogIndex index(log.path);
  viewer::LogPoses poses(log.path, index);
  const viewer::LogPoses::Poses* start = poses.at(0);
  ASSERT_NE(start, nullptr);
  EXPECT_EQ(start->time_us, 0);
  ASSERT_EQ(start->names->size(), start->message.position_m.size());
  EXPECT_EQ(start->bodies.size(), start->names->size() * viewer::StateFrame::body_bytes);
  const double start_m = start->message.position_m[0][2];
  const viewer::LogPoses::Poses* later = poses.at(1'000'000);
  ASSERT_NE(later, nullptr);
  EXPECT_LE(later->time_us, 1'000'000);
  EXPECT_LT(later->message.position_m[0][2], start_m);  // it falls
}

TEST(LogPoses, BeforeTheStartAndAfterTheEndAreThoseOfTheEnds) {
  const test::FallLog log;
  const viewer::LogIndex index(log.path);
  viewer::LogPoses poses(log.path, index);
  EXPECT_EQ(poses.at(-5'000'000)->time_us, index.start_us());
  EXPECT_EQ(poses.at(99'000'000)->time_us, index.end_us());
}

TEST(LogPoses, TheSameTimeIsNotReadAgain) {
  const test::FallLog log;
  const viewer::LogIndex index(log.path);
  viewer::LogPoses poses(log.path, index);
  const viewer::LogPoses::Poses* first = poses.at(500'000);
  const std::byte* bodies = first->bodies.data();
  EXPECT_EQ(poses.at(500'000), first);
  EXPECT_EQ(poses.at(500'000)->bodies.data(), bodies);
}

}  // namespace
