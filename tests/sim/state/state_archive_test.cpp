// SPDX-License-Identifier: BSD-3-Clause
#include "sim/state/state_archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "sim/base/time.hpp"

namespace {

using sim::SnapshotError;
using sim::StateArchive;
using testing::HasSubstr;

enum class Gear : unsigned char { neutral, first };

/// A class as devices are.
struct Engine {
  double speed = 0;
  Gear gear = Gear::neutral;
  int reported = 0;  ///< how often something was said: changes nothing
  bool operator==(const Engine&) const = default;
  void visit_state(StateArchive& archive) {
    archive(speed, gear);
    archive.unhashed(reported);
  }
};

/// One of each kind that the archive takes.
struct Everything {
  bool flag = false;
  std::int64_t number = 0;
  float small = 0;
  std::string text;
  sim::Time time{0};
  sim::Vector3d vector = sim::Vector3d::Zero();
  sim::Quaterniond turn = sim::Quaterniond::Identity();
  sim::Pose pose = sim::Pose::Identity();
  std::vector<double> doubles;
  std::vector<Engine> engines;
  std::vector<std::string> texts;
  std::deque<int> deque;
  std::array<Engine, 2> array;
  int plain_array[3] = {};
  std::pair<int, std::string> pair;
  std::optional<Engine> some, none = Engine{};
  std::map<std::string, Engine> map;
  std::map<std::pair<sim::Time, int>, std::size_t> by_time;
  std::set<std::pair<std::int64_t, std::int64_t>> set;

  void visit_state(StateArchive& archive) {
    archive(flag, number, small, text, time, vector, turn, pose, doubles, engines, texts, deque, array, plain_array,
            pair, some, none, map, by_time, set);
  }
};

Everything example() {
  Everything all;
  all.flag = true;
  all.number = -7;
  all.small = 0.1F;
  all.text = "a text";
  all.time = sim::Time{123456};
  all.vector = {1, -2, 3};
  all.turn = sim::Quaterniond(0.5, 0.5, -0.5, 0.5);
  all.pose = sim::make_pose({4, 5, 6}, {0.1, 0.2, 0.3});
  all.doubles = {1.5, -0.0};
  all.engines = {{3, Gear::first, 1}, {4, Gear::neutral, 2}};
  all.texts = {"", "two"};
  all.deque = {1, 2, 3};
  all.array = {Engine{8, Gear::first, 0}, Engine{9, Gear::neutral, 5}};
  all.plain_array[1] = 17;
  all.pair = {3, "three"};
  all.some = Engine{1, Gear::first, 2};
  all.none.reset();
  all.map = {{"a", {1, Gear::neutral, 0}}, {"b", {2, Gear::first, 3}}};
  all.by_time = {{{sim::Time{5}, 1}, 2}};
  all.set = {{1, 2}, {3, 4}};
  return all;
}

template <typename T>
std::vector<std::byte> saved(T value) {
  StateArchive archive = StateArchive::saver();
  archive.section("all");
  archive(value);
  archive.end();
  return archive.take_bytes();
}

template <typename T>
void restore(T& value, std::span<const std::byte> bytes) {
  StateArchive archive = StateArchive::restorer(bytes);
  archive.section("all");
  archive(value);
  archive.end();
}

template <typename T>
std::uint64_t hash_of(T value) {
  StateArchive archive = StateArchive::hasher();
  archive(value);
  return archive.hash();
}

/// What restoring says; empty: nothing.
template <typename Visit>
std::string error_of(std::span<const std::byte> bytes, const Visit& visit) {
  StateArchive archive = StateArchive::restorer(bytes);
  try {
    visit(archive);
    return {};
  } catch (const SnapshotError& error) {
    return error.what();
  }
}

TEST(StateArchive, EveryKindComesBack) {
  const std::vector<std::byte> bytes = saved(example());
  Everything back;
  restore(back, bytes);
  EXPECT_EQ(saved(back), bytes);
  const Everything all = example();
  EXPECT_EQ(back.text, all.text);
  EXPECT_EQ(back.engines, all.engines);
  EXPECT_EQ(back.map, all.map);
  EXPECT_EQ(back.set, all.set);
  EXPECT_EQ(back.by_time, all.by_time);
  EXPECT_EQ(back.some, all.some);
  EXPECT_FALSE(back.none);
  EXPECT_EQ(back.pose.matrix(), all.pose.matrix());
  EXPECT_TRUE(std::signbit(back.doubles[1]));
}

TEST(StateArchive, TheHashIsTheSameAfterwards) {
  Everything back;
  restore(back, saved(example()));
  EXPECT_EQ(hash_of(back), hash_of(example()));
  EXPECT_NE(hash_of(back), hash_of(Everything{}));
}

TEST(StateArchive, HashingAndSavingChangeNothing) {
  Everything all = example();
  const std::vector<std::byte> before = saved(all);
  StateArchive hasher = StateArchive::hasher(), saver = StateArchive::saver();
  hasher(all);
  saver(all);
  EXPECT_EQ(saved(all), before);
}

TEST(StateArchive, WhatIsUnhashedIsSavedAllTheSame) {
  EXPECT_EQ(hash_of(Engine{1, Gear::first, 5}), hash_of(Engine{1, Gear::first, 6}));
  Engine back;
  restore(back, saved(Engine{1, Gear::first, 6}));
  EXPECT_EQ(back.reported, 6);
}

TEST(StateArchive, IsRefusedWhereverItIsCutOff) {
  const std::vector<std::byte> bytes = saved(example());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Everything back;
    EXPECT_THROW(restore(back, std::span(bytes).first(size)), SnapshotError) << size << " of " << bytes.size();
  }
}

TEST(StateArchive, IsRefusedWhenItIsTooLong) {
  std::vector<std::byte> bytes = saved(example());
  bytes.push_back(std::byte{0});
  Everything back;
  EXPECT_EQ(error_of(bytes,
                     [&](StateArchive& archive) {
                       archive.section("all");
                       archive(back);
                       archive.end();
                     }),
            "snapshot: the end: 1 bytes are left over in the snapshot");
}

TEST(StateArchive, SaysWhichPartIsLongerOrShorterThanTheWorlds) {
  StateArchive saver = StateArchive::saver();
  double one = 1, two = 2;
  saver.section("auv1/imu");
  saver(one, two);
  saver.section("auv1/dvl");
  saver(one);
  saver.end();
  const std::vector<std::byte> bytes = saver.take_bytes();
  EXPECT_EQ(error_of(bytes,
                     [&](StateArchive& archive) {
                       archive.section("auv1/imu");
                       archive(one);
                       archive.section("auv1/dvl");
                     }),
            "snapshot: auv1/imu: the snapshot has 8 bytes more than this world");
  EXPECT_EQ(error_of(bytes,
                     [&](StateArchive& archive) {
                       archive.section("auv1/imu");
                       archive(one, two, two);
                     }),
            "snapshot: auv1/imu: the snapshot ends where 8 bytes should follow");
}

TEST(StateArchive, SaysWhichPartIsNotTheWorlds) {
  EXPECT_EQ(error_of(saved(Engine{}), [](StateArchive& archive) { archive.section("other"); }),
            "the snapshot has 'all' where this world has 'other'");
}

TEST(StateArchive, CountsThatCannotBeAreRefusedBeforeMemoryIsAskedFor) {
  StateArchive saver = StateArchive::saver();
  std::uint64_t huge = std::uint64_t{1} << 60;
  saver(huge);
  const std::vector<std::byte> bytes = saver.take_bytes();
  std::vector<double> numbers;
  std::map<int, int> map;
  EXPECT_THAT(error_of(bytes, [&](StateArchive& archive) { archive(numbers); }), HasSubstr("more than it has bytes"));
  EXPECT_THAT(error_of(bytes, [&](StateArchive& archive) { archive(map); }), HasSubstr("more than it has bytes"));
}

TEST(StateArchive, AFlagIsTrueOrFalse) {
  const std::byte two[] = {std::byte{2}};
  bool flag = false;
  EXPECT_THAT(error_of(two, [&](StateArchive& archive) { archive(flag); }), HasSubstr("neither true nor false"));
}

TEST(StateArchive, ExpectedCountsAreCompared) {
  StateArchive saver = StateArchive::saver();
  saver.expect_count(3, "wheels");
  const std::vector<std::byte> bytes = saver.take_bytes();
  EXPECT_EQ(error_of(bytes, [](StateArchive& archive) { archive.expect_count(3, "wheels"); }), "");
  EXPECT_EQ(error_of(bytes, [](StateArchive& archive) { archive.expect_count(4, "wheels"); }),
            "snapshot: the start: the snapshot has 3 wheels, this world 4");
}

TEST(StateArchive, HashesByPartReportWhichPartDiffers) {
  const auto parts = [](double imu, double dvl) {
    StateArchive archive = StateArchive::hasher();
    archive.section("auv1/imu");
    archive(imu);
    archive.section("auv1/dvl");
    archive(dvl);
    archive.end();
    return std::pair(archive.parts(), archive.hash());
  };
  const auto [one, hash] = parts(1, 2);
  const auto [other, other_hash] = parts(1, 3);
  ASSERT_EQ(one.size(), 2u);
  EXPECT_EQ(one[0].part, "auv1/imu");
  EXPECT_EQ(one[0], other[0]);
  EXPECT_FALSE(one[1] == other[1]);
  EXPECT_NE(hash, other_hash);
}

TEST(StateArchive, TheQuickHasherGivesTheSameHashWithoutTheParts) {
  const auto visit = [](StateArchive archive) {
    Everything all = example();
    archive.section("all");
    archive(all);
    archive.end();
    return std::pair(archive.hash(), archive.parts().size());
  };
  const auto [hash, parts] = visit(StateArchive::hasher());
  const auto [quick_hash, quick_parts] = visit(StateArchive::quick_hasher());
  EXPECT_EQ(hash, quick_hash);
  EXPECT_EQ(parts, 1u);
  EXPECT_EQ(quick_parts, 0u);
}

/// Counts how many there ever were.
struct Counted {
  Counted() { ++made; }
  double number = 0;
  void visit_state(StateArchive& archive) { archive(number); }
  static inline int made = 0;
};

TEST(StateArchive, AListIsNotLongerThanWhatWasRead) {
  StateArchive saver = StateArchive::saver();
  std::uint64_t reports = 800;
  std::vector<double> numbers(100);
  saver(reports);
  saver.raw(numbers.data(), numbers.size() * sizeof(double));
  const std::vector<std::byte> bytes = saver.take_bytes();
  std::vector<Counted> list;
  Counted::made = 0;
  StateArchive restorer = StateArchive::restorer(bytes);
  EXPECT_THROW(restorer(list), SnapshotError);
  EXPECT_EQ(Counted::made, 101);
}

enum class Mode { off, on, automatic };

/// What a value of another type says when it is restored as T.
template <typename T, typename Bits>
std::string error_of_restoring(Bits bits) {
  StateArchive saver = StateArchive::saver();
  saver.raw(&bits, sizeof bits);
  const std::vector<std::byte> bytes = saver.take_bytes();
  StateArchive restorer = StateArchive::restorer(bytes);
  T value{};
  try {
    restorer(value);
    return "";
  } catch (const SnapshotError& error) {
    return error.what();
  }
}

TEST(StateArchive, RestoresNoValueThatAnEnumerationDoesNotHave) {
  EXPECT_EQ(error_of_restoring<Mode>(2), "");
  for (const int number : {3, 31, 32, 1 << 20, -1})
    EXPECT_EQ(error_of_restoring<Mode>(number), "snapshot: the start: a value out of range") << number;
}

TEST(StateArchive, RestoresNoNumberThatIsNotFiniteUnlessItMeansSomething) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(error_of_restoring<double>(1e100), "");
  EXPECT_EQ(error_of_restoring<double>(-1e300), "snapshot: the start: the snapshot has the invalid number -1e+300");
  EXPECT_NE(error_of_restoring<double>(infinity), "");
  EXPECT_NE(error_of_restoring<sim::Vector3d>(std::array{0.0, std::nan(""), 0.0}), "");
  struct Target {
    double heading_rad = std::nan(""), limit = infinity;
    void visit_state(StateArchive& archive) { archive.not_only_finite(heading_rad, limit); }
  };
  EXPECT_EQ(error_of_restoring<Target>(std::array{std::nan(""), infinity}), "");
  EXPECT_NE(error_of_restoring<Target>(std::array{1e300, 0.0}), "");
}

TEST(StateArchive, RestoresNoTimeThatIsFurtherThanARunCanBe) {
  const std::int64_t max_us = StateArchive::max_time.count();
  EXPECT_EQ(error_of_restoring<std::chrono::microseconds>(max_us), "");
  EXPECT_EQ(error_of_restoring<std::chrono::microseconds>(-max_us), "");
  EXPECT_EQ(error_of_restoring<std::chrono::microseconds>(max_us + 1),
            "snapshot: the start: the snapshot has an invalid value: a time");
  EXPECT_NE(error_of_restoring<std::chrono::microseconds>(std::numeric_limits<std::int64_t>::min()), "");
}

}  // namespace
