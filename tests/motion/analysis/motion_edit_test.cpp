// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/motion_edit.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "sim/motion/motion_frames.hpp"

namespace {

using sim::Easing;
using testing::HasSubstr;

/// Joints a and b: a goes from 0 to 1 in 1 s and back to 0 at 3 s, b from 2 to 4 in 3 s.
sim::JointMotion two_joints(Easing ease = Easing::linear) {
  sim::JointMotion motion;
  motion.name = "m";
  motion.angles = sim::AngleUnit::rad;
  motion.ease = ease;
  motion.poses = {{"home", {{"a", 0}, {"b", 4}}}};
  motion.keys = {
      {0, "", {{"a", 0}, {"b", 2}}, {}, "", {}}, {1, "", {{"a", 1}}, {}, "top", {}}, {3, "home", {}, {}, "", {}}};
  return motion;
}

double value(const sim::JointMotion& motion, const std::string& joint, double at_s) {
  for (const sim::MotionTrack& track : motion.tracks())
    if (track.joint == joint) return track.value_at(at_s);
  ADD_FAILURE() << "no joint " << joint;
  return NAN;
}

/// Greatest difference of two motions over a part, the second one later by `later_s`.
double difference(const sim::JointMotion& one, const sim::JointMotion& other, double from_s, double to_s,
                  double later_s) {
  double greatest = 0;
  for (const char* joint : {"a", "b"})
    for (double t_s = from_s; t_s <= to_s + 1e-9; t_s += 0.008)
      greatest = std::max(greatest, std::abs(value(one, joint, t_s) - value(other, joint, t_s + later_s)));
  return greatest;
}

template <typename Action>
std::string error_of(Action action) {
  try {
    action();
    return {};
  } catch (const motion::EditError& error) {
    return error.what();
  }
}

/// As two_joints, with b as a light of the left side, and sounds at 0.5 s and 2 s.
sim::JointMotion with_light() {
  sim::JointMotion motion = two_joints();
  motion.poses.clear();
  motion.keys = {{0, "", {{"a", 0}, {"left_b", 0}}, {}, "", {}}, {3, "", {{"a", 1}, {"left_b", 1}}, {}, "", {}}};
  motion.lights = {"left_b"};
  motion.sounds = {{0.5, "bark", 1}, {2, "whine", 0.5}};
  return motion;
}

std::vector<std::pair<double, std::string>> sounds_of(const sim::JointMotion& motion) {
  std::vector<std::pair<double, std::string>> sounds;
  for (const sim::MotionSound& sound : motion.sounds) sounds.emplace_back(sound.at_s, sound.sound);
  return sounds;
}

TEST(MotionEdit, SoundsMoveWithTheirMotion) {
  using testing::ElementsAre;
  using testing::Pair;
  const sim::JointMotion motion = with_light();
  EXPECT_THAT(sounds_of(motion::trimmed(motion, 1, 3)), ElementsAre(Pair(1, "whine")));
  EXPECT_THAT(sounds_of(motion::without(motion, 0.25, 1.25)), ElementsAre(Pair(1, "whine")));
  EXPECT_THAT(sounds_of(motion::stretched(motion, 2)), ElementsAre(Pair(1, "bark"), Pair(4, "whine")));
  EXPECT_THAT(sounds_of(motion::shifted(motion, 1, {})), ElementsAre(Pair(1.5, "bark"), Pair(3, "whine")));
  EXPECT_THAT(sounds_of(motion::shifted(motion, 1, {"a"})), ElementsAre(Pair(0.5, "bark"), Pair(2, "whine")));
  EXPECT_THAT(sounds_of(motion::appended(motion, motion, 1)),
              ElementsAre(Pair(0.5, "bark"), Pair(2, "whine"), Pair(4.5, "bark"), Pair(6, "whine")));
  EXPECT_THAT(sounds_of(motion::merged(motion, motion, true)), ElementsAre(Pair(0.5, "bark"), Pair(2, "whine")));
}

TEST(MotionEdit, LightsStayLightsOnTheOtherSideAndBehindAnotherMotion) {
  const sim::JointMotion motion = with_light(), plain = two_joints();
  const motion::MirrorRule rule{{{"left_", "right_"}}, {}};
  const sim::JointMotion other = motion::mirrored(motion, rule);
  EXPECT_TRUE(other.is_light("right_b"));
  EXPECT_FALSE(other.is_light("left_b"));
  EXPECT_EQ(value(other, "right_b", 1.5), 0.5);
  EXPECT_TRUE(motion::appended(plain, motion, 1).is_light("left_b"));
  EXPECT_TRUE(motion::merged(plain, motion, true).is_light("left_b"));
  const sim::JointMotion cycle = motion::with_mirrored_half(motion, rule);
  EXPECT_TRUE(cycle.is_light("left_b") && cycle.is_light("right_b"));
  EXPECT_NEAR(value(cycle, "right_b", 4.5), 0.5, 1e-9);
}

TEST(MotionEdit, TrimKeepsThePartAsItWas) {
  for (const Easing ease : {Easing::linear, Easing::cosine, Easing::smooth, Easing::spline}) {
    const sim::JointMotion motion = two_joints(ease);
    const sim::JointMotion part = motion::trimmed(motion, 0.4, 2.4);
    EXPECT_NEAR(part.end_s(), 2, 1e-9);
    // Cut segments are linear between frames of 8 ms: the error is at most their curvature (below 8 / s^2) times
    // (8 ms)^2 / 8, with 0.4 s and 2.4 s at whole frames.
    EXPECT_LE(difference(part, motion, 0, 2, 0.4), 8 * 0.008 * 0.008 / 8) << static_cast<int>(ease);
  }
}

TEST(MotionEdit, TrimMovesNotesWithTheirKeys) {
  const sim::JointMotion part = motion::trimmed(two_joints(), 0.5, 3);
  ASSERT_EQ(part.keys.size(), 3u);
  EXPECT_NEAR(part.keys[1].at_s, 0.5, 1e-9);
  EXPECT_EQ(part.keys[1].note, "top");
  EXPECT_EQ(part.keys[2].pose, "home");
}

TEST(MotionEdit, CutRemovesAPartAndContinuesWithWhatFollows) {
  const sim::JointMotion motion = two_joints();
  const sim::JointMotion rest = motion::without(motion, 0.5, 2);
  EXPECT_NEAR(rest.end_s(), 1.5, 1e-9);
  EXPECT_LE(difference(rest, motion, 0, 0.4, 0), 1e-9);
  EXPECT_LE(difference(rest, motion, 0.504, 1.5, 1.5), 1e-9);
}

TEST(MotionEdit, AppendMovesToTheOtherWithinTheGap) {
  const sim::JointMotion motion = two_joints();
  const sim::JointMotion both = motion::appended(motion, motion, 0.5);
  EXPECT_NEAR(both.end_s(), 6.5, 1e-9);
  EXPECT_LE(difference(motion, both, 0, 3, 0), 1e-9);
  EXPECT_LE(difference(motion, both, 0, 3, 3.5), 1e-9);
  EXPECT_NEAR(value(both, "b", 3.25), 3, 1e-9);  // half way from 4 to 2
}

TEST(MotionEdit, MergeAddsJointsAndRefusesTwoOfAKind) {
  sim::JointMotion head;
  head.name = "head";
  head.keys = {{0, "", {{"pan", 0}}, {}, "", {}}, {2, "", {{"pan", 1}}, {}, "", {}}};
  const sim::JointMotion both = motion::merged(two_joints(), head, false);
  EXPECT_NEAR(value(both, "pan", 1), 0.5, 1e-9);
  EXPECT_NEAR(value(both, "a", 1), 1, 1e-9);
  EXPECT_THAT(error_of([&] { motion::merged(two_joints(), two_joints(), false); }),
              HasSubstr("both motions have joint 'a'"));
  EXPECT_NO_THROW(motion::merged(two_joints(), two_joints(), true));
}

TEST(MotionEdit, MirrorExchangesSidesAndTwiceItIsTheSame) {
  sim::JointMotion motion;
  motion.name = "kick";
  motion.poses = {{"lifted", {{"lf_knee", 1}}}};
  motion.keys = {{0, "", {{"lf_knee", 0}, {"rf_knee", 0.2}, {"head_pan", 0.5}}, {}, "", {}},
                 {1, "lifted", {{"head_pan", -0.3}}, {}, "", {}}};
  const motion::MirrorRule rule{{{"lf_", "rf_"}}, {"head_pan"}};
  const sim::JointMotion other = motion::mirrored(motion, rule);
  EXPECT_NEAR(value(other, "rf_knee", 1), 1, 1e-15);
  EXPECT_NEAR(value(other, "lf_knee", 0), 0.2, 1e-15);
  EXPECT_NEAR(value(other, "head_pan", 1), 0.3, 1e-15);
  EXPECT_EQ(sim::motion_text(motion::mirrored(other, rule)), sim::motion_text(motion));
  // Half a cycle and its mirror image.
  const sim::JointMotion cycle = motion::with_mirrored_half(motion, rule);
  EXPECT_NEAR(cycle.end_s(), 2, 1e-9);
  EXPECT_NEAR(value(cycle, "lf_knee", 0.5), 0.5, 1e-9);
  EXPECT_NEAR(value(cycle, "rf_knee", 1.5), value(motion, "lf_knee", 0.5), 1e-9);
  EXPECT_NEAR(value(cycle, "rf_knee", 2), 1, 1e-9);
}

TEST(MotionEdit, TimesMove) {
  EXPECT_NEAR(value(motion::shifted(two_joints(), 0.5, {"a"}), "a", 1.5), 1, 1e-9);
  EXPECT_NEAR(value(motion::shifted(two_joints(), 0.5, {"a"}), "b", 3), 4, 1e-9);
  EXPECT_THAT(error_of([&] { motion::shifted(two_joints(), -0.5, {}); }), HasSubstr("joint 'a' would start at -0.5 s"));
  EXPECT_NEAR(motion::stretched(two_joints(), 2).end_s(), 6, 1e-9);
  EXPECT_NEAR(value(motion::stretched(two_joints(), 2), "a", 2), 1, 1e-9);
  EXPECT_NEAR(value(motion::retimed(two_joints(), 1, 2), "a", 2), 1, 1e-9);
  EXPECT_THAT(error_of([&] { motion::retimed(two_joints(), 1, 3.5); }),
              HasSubstr("between its neighbors, at 0 s and 3 s"));
  EXPECT_THAT(error_of([&] { motion::retimed(two_joints(), 1.1, 2); }), HasSubstr("no key is at 1.1 s"));
}

TEST(MotionEdit, SmoothKeepsTheEndsAndRoundsTheCorner) {
  const sim::JointMotion smooth = motion::smoothed(two_joints(), 0.2);
  EXPECT_NEAR(value(smooth, "a", 0), 0, 1e-12);
  EXPECT_NEAR(value(smooth, "a", 3), 0, 1e-12);
  // Over 12 frames to each side, rising by 1 and falling by 0.5 per second: mean fall 0.75 * 8 ms * (12 * 13 / 25).
  EXPECT_NEAR(value(smooth, "a", 1), 1 - 0.75 * 0.008 * 12 * 13 / 25, 1e-9);
}

TEST(MotionEdit, SimplifyFindsTheKeysOfSampledLines) {
  sim::JointMotion sampled = two_joints();
  sampled = motion::with_tracks(sampled, sim::sampled(sampled.tracks(), 3, 0.008), [](double t_s) { return t_s; });
  EXPECT_EQ(sampled.keys.size(), 376u);
  const sim::JointMotion simple = motion::simplified(sampled, 1e-6);
  EXPECT_EQ(simple.keys.size(), 3u);
  EXPECT_LE(difference(simple, two_joints(), 0, 3, 0), 1e-6);
}

TEST(MotionEdit, SetAndPoseAddKeysAndNames) {
  const sim::JointMotion set = motion::with_values(two_joints(), 2, {{"a", 9}, {"c", 1}});
  EXPECT_NEAR(value(set, "a", 2), 9, 1e-12);
  EXPECT_NEAR(value(set, "b", 2), value(two_joints(), "b", 2), 1e-12);
  EXPECT_NEAR(value(set, "c", 0), 1, 1e-12);
  const sim::JointMotion named = motion::with_pose(two_joints(), "middle", 1.5);
  ASSERT_NE(named.find_pose("middle"), nullptr);
  EXPECT_NEAR(named.find_pose("middle")->joints[1].second, 3, 1e-12);
}

TEST(MotionEdit, RefusesPartsOutsideOfTheMotion) {
  EXPECT_THAT(error_of([] { motion::trimmed(two_joints(), 2, 4); }), HasSubstr("from 0 to 3 s, got 2 to 4"));
  EXPECT_THAT(error_of([] { motion::without(two_joints(), 0, 3); }), HasSubstr("nothing of the motion would be left"));
  EXPECT_THAT(error_of([] { motion::stretched(two_joints(), 0); }), HasSubstr("must be > 0, got 0"));
}

TEST(MotionEdit, ChangesOfTheWorldMoveWithTheMotion) {
  sim::JointMotion motion;
  motion.name = "m";
  motion.keys = {{0, "", {{"a", 0}}, {}, "", {}}, {10, "", {{"a", 1}}, {}, "", {}}};
  for (const double at_s : {1.0, 5.0, 9.0}) motion.changes.emplace_back().at_s = at_s;
  const auto times = [](const sim::JointMotion& one) {
    std::vector<double> all;
    for (const sim::MotionChange& change : one.changes) all.push_back(change.at_s);
    return all;
  };
  using testing::ElementsAre;
  EXPECT_THAT(times(motion::trimmed(motion, 4, 6)), ElementsAre(0, 1));
  EXPECT_THAT(times(motion::without(motion, 4, 6)), ElementsAre(1, 4, 7));
  EXPECT_THAT(times(motion::shifted(motion, 3, {})), ElementsAre(4, 8, 12));
  EXPECT_THAT(times(motion::shifted(motion, 3, {"a"})), ElementsAre(1, 5, 9));
  EXPECT_THAT(times(motion::appended(motion, motion, 1)), ElementsAre(1, 5, 9, 12, 16, 20));
}

sim::ConfigNode action(const std::string& text) {
  sim::Diagnostics diagnostics;
  return sim::parse_config_text(text, "action", diagnostics);
}

TEST(MotionEdit, MergeKeepsTheChangesOfBothAndTheirSliders) {
  sim::JointMotion legs, head;
  legs.name = "legs";
  legs.keys = {{0, "", {{"a", 0}}, {}, "", {}}, {2, "", {{"a", 1}}, {}, "", {}}};
  legs.changes = {{1, action("{remove: crate}")}, {1.5, action("{remove: block}")}};
  head.name = "head";
  head.keys = {{0, "", {{"b", 0.5}}, {}, "", {}}, {3, "", {{"b", 1}}, {}, "", {}}};
  head.sliders = {"b"};
  head.changes = {{0.5, action("{remove: ball}")}, {1, action("{remove: crate}")}, {1.5, action("{remove: box}")}};
  const sim::JointMotion both = motion::merged(legs, head, false);
  std::vector<std::pair<double, std::string>> changes;
  for (const sim::MotionChange& change : both.changes)
    changes.emplace_back(change.at_s, change.action.entries.at(0).value.scalar);
  using testing::ElementsAre;
  using testing::Pair;
  // The crate can be removed once only.
  EXPECT_THAT(changes, ElementsAre(Pair(0.5, "ball"), Pair(1, "crate"), Pair(1.5, "block"), Pair(1.5, "box")));
  EXPECT_THAT(both.sliders, ElementsAre("b"));
  EXPECT_THAT(motion::appended(legs, head, 1).sliders, ElementsAre("b"));
}

}  // namespace
