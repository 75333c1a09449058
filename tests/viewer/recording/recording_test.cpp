// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/recording/recording.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cstring>

#include "tests/viewer/recording/recording_fixture.hpp"
#include "viewer/recording/recording_page.hpp"

namespace {

using namespace recording_fixture;

using testing::HasSubstr;

using Kind = viewer::Recording::Kind;

std::vector<std::int64_t> state_times(const viewer::Recording& recording) {
  std::vector<std::int64_t> times;
  for (const auto& entry : recording.entries())
    if (entry.kind == Kind::state) times.push_back(entry.time_us);
  return times;
}

/// Returns the texts of a kind.
std::vector<std::string> texts(const viewer::Recording& recording, const std::string& op) {
  std::vector<std::string> found;
  for (const auto& entry : recording.entries())
    if (entry.kind == Kind::text && entry.bytes.find("\"op\":\"" + op + "\"") != std::string::npos)
      found.push_back(entry.bytes);
  return found;
}

TEST(Recording, HasSceneEventsAndAllStatesOfASmallLog) {
  const Log log;
  const viewer::Recording recording(log.path, "test", {});
  EXPECT_EQ(recording.start_us(), 0);
  EXPECT_EQ(recording.end_us(), 5'000'000);
  EXPECT_EQ(recording.states(), recording.states_of_log());
  const auto times = state_times(recording);
  ASSERT_EQ(times.size(), recording.states());
  EXPECT_EQ(times.front(), 0);
  EXPECT_EQ(times.back(), 5'000'000);
  EXPECT_EQ(texts(recording, "scene").size(), 1u);
  ASSERT_EQ(texts(recording, "events").size(), 1u);
  EXPECT_THAT(texts(recording, "events")[0], HasSubstr("half"));
  EXPECT_TRUE(recording.problems().empty());
}

TEST(Recording, KeepsFirstAndLastStateWhenItIsThinned) {
  const Log log;
  viewer::Recording recording(log.path, "test", {});
  for (std::size_t before = recording.states(); recording.thin(); before = recording.states()) {
    EXPECT_LT(recording.states(), before);
    const auto times = state_times(recording);
    ASSERT_EQ(times.size(), recording.states());
    EXPECT_EQ(times.front(), 0);
    EXPECT_EQ(times.back(), 5'000'000);
  }
  EXPECT_EQ(recording.states(), 2u);
}

TEST(Recording, NeedsBoundedMemoryForALongLog) {
  const Log log;
  viewer::Recording::Limits limits;
  limits.state_bytes = 10 * 52;  // a head of 32 bytes and one body of 20
  const viewer::Recording recording(log.path, "test", limits);
  EXPECT_LE(recording.states(), 11u);
  EXPECT_GE(recording.states(), 5u);
  const auto times = state_times(recording);
  EXPECT_EQ(times.back(), 5'000'000);
  for (std::size_t i = 1; i + 1 < times.size(); ++i)
    EXPECT_EQ(times[i] - times[i - 1], times[1] - times[0]) << "state " << i;
}

TEST(Recording, WritesEntriesWithHeads) {
  const Log log;
  const viewer::Recording recording(log.path, "test", {});
  const std::string bytes = recording.to_bytes();
  std::size_t at = 0, number = 0;
  for (; at < bytes.size(); ++number) {
    std::array<std::uint32_t, 2> head{};
    std::memcpy(head.data(), bytes.data() + at, sizeof head);
    ASSERT_LT(number, recording.entries().size());
    EXPECT_EQ(head[0], static_cast<std::uint32_t>(recording.entries()[number].kind));
    ASSERT_EQ(head[1], recording.entries()[number].bytes.size());
    at += 24 + head[1];
  }
  EXPECT_EQ(at, bytes.size());
  EXPECT_EQ(number, recording.entries().size());
}

}  // namespace
