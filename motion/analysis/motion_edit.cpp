// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/motion_edit.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"
#include "sim/motion/motion_frames.hpp"

namespace motion {

namespace {

using sim::Easing;
using sim::JointMotion;
using sim::MotionTrack;
using sim::TrackKey;

constexpr double same_time_s = 1e-9;

/// Returns a copy to change: it does not end in the state of the recording any more.
JointMotion copy_to_change(const JointMotion& motion) {
  JointMotion changed = motion;
  if (changed.recorded) changed.recorded->state_hash.clear();
  return changed;
}

double unchanged(double t_s) {
  return t_s;
}

/// Returns the tracks with a key of each joint at this time.  A segment that is not linear becomes keys at each frame.
std::vector<MotionTrack> split_at(const std::vector<MotionTrack>& tracks, double at_s, double frame_s) {
  std::vector<MotionTrack> result;
  for (const MotionTrack& track : tracks) {
    MotionTrack split{track.joint, {}};
    for (std::size_t i = 0; i < track.keys.size(); ++i) {
      const TrackKey& key = track.keys[i];
      const double before_s = i > 0 ? track.keys[i - 1].at_s : -1;
      const bool is_cut = i > 0 && at_s > before_s + same_time_s && at_s < key.at_s - same_time_s;
      if (!is_cut) {
        split.keys.push_back(key);
        continue;
      }
      std::vector<double> times{at_s, key.at_s};
      if (key.ease != Easing::linear && key.ease != Easing::step)
        for (double t_s = (std::floor(before_s / frame_s) + 1) * frame_s; t_s < key.at_s - same_time_s; t_s += frame_s)
          if (t_s > before_s + same_time_s && std::abs(t_s - at_s) > same_time_s) times.push_back(t_s);
      std::sort(times.begin(), times.end());
      const Easing ease = key.ease == Easing::step ? Easing::step : Easing::linear;
      for (const double t_s : times) split.keys.push_back({t_s, track.value_at(t_s), ease});
    }
    result.push_back(std::move(split));
  }
  return result;
}

/// Returns the tracks with those that have splines as keys at each frame: a spline depends on keys beyond a cut.
std::vector<MotionTrack> without_splines(const JointMotion& motion) {
  std::vector<MotionTrack> tracks = motion.tracks();
  const auto is_spline = [](const TrackKey& key) { return key.ease == Easing::spline; };
  for (MotionTrack& track : tracks)
    if (std::any_of(track.keys.begin(), track.keys.end(), is_spline))
      track = sim::sampled({track}, motion.end_s(), motion.frame_s).front();
  return tracks;
}

/// Tracks with a key at both ends of a part; a joint that holds before its first or after its last key gets one there.
std::vector<MotionTrack> part(const JointMotion& motion, double from_s, double to_s) {
  std::vector<MotionTrack> result;
  const auto tracks = split_at(split_at(without_splines(motion), from_s, motion.frame_s), to_s, motion.frame_s);
  for (const MotionTrack& track : tracks) {
    MotionTrack kept{track.joint, {{0, track.value_at(from_s), Easing::linear}}};
    for (const TrackKey& key : track.keys)
      if (key.at_s > from_s + same_time_s && key.at_s < to_s + same_time_s)
        kept.keys.push_back({key.at_s - from_s, key.value, key.ease});
    if (kept.keys.back().at_s < to_s - from_s - same_time_s)
      kept.keys.push_back({to_s - from_s, track.value_at(to_s), Easing::linear});
    result.push_back(std::move(kept));
  }
  return result;
}

void check_part(const JointMotion& motion, double from_s, double to_s) {
  if (!(from_s >= 0 && from_s < to_s && to_s <= motion.end_s() + same_time_s))
    throw EditError("the part must lie within the motion, from 0 to " + sim::number_text(motion.end_s()) + " s, got " +
                    sim::number_text(from_s) + " to " + sim::number_text(to_s));
}

/// Joins two parts at a time: the value there is that of the second.  Where they differ, the first ends a frame before.
std::vector<MotionTrack> joined(std::vector<MotionTrack> first, const std::vector<MotionTrack>& second, double at_s,
                                double frame_s) {
  const std::vector<MotionTrack> split = split_at(first, at_s - frame_s, frame_s);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto is_it = [&](const MotionTrack& one) { return one.joint == first[i].joint; };
    const auto other = std::find_if(second.begin(), second.end(), is_it);
    if (other == second.end()) continue;
    const bool differs = std::abs(other->keys.front().value - first[i].keys.back().value) > 1e-9;
    if (differs) first[i] = split[i];
    if (first[i].keys.size() > 1) first[i].keys.pop_back();
  }
  return first;
}

/// Adds tracks that start at `at_s`.
void add_after(std::vector<MotionTrack>& tracks, const std::vector<MotionTrack>& others, double at_s) {
  for (const MotionTrack& other : others) {
    auto place = std::find_if(tracks.begin(), tracks.end(), [&](const auto& one) { return one.joint == other.joint; });
    if (place == tracks.end()) place = tracks.insert(tracks.end(), {other.joint, {}});
    for (const TrackKey& key : other.keys)
      if (place->keys.empty() || key.at_s + at_s > place->keys.back().at_s + same_time_s)
        place->keys.push_back({key.at_s + at_s, key.value, key.ease});
  }
}

/// Adds the names of the sliders and lights of another motion.
void add_units(JointMotion& motion, const JointMotion& other) {
  const auto add = [](std::vector<std::string>& names, const std::vector<std::string>& others) {
    for (const std::string& name : others)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  add(motion.sliders, other.sliders);
  add(motion.lights, other.lights);
}

/// Moves sounds in time; `time_of` returns the new time, or a negative one for a sound that is left out.
void move_sounds(JointMotion& motion, const std::function<double(double)>& time_of) {
  for (sim::MotionSound& sound : motion.sounds) sound.at_s = time_of(sound.at_s);
  std::erase_if(motion.sounds, [](const sim::MotionSound& sound) { return sound.at_s < 0; });
}

/// Adds the sounds of a motion that starts at `at_s`.
void add_sounds(JointMotion& motion, const JointMotion& other, double at_s) {
  for (const sim::MotionSound& sound : other.sounds)
    motion.sounds.push_back({sound.at_s + at_s, sound.sound, sound.volume});
}

std::string mirrored_name(const std::string& joint, const MirrorRule& rule) {
  for (const auto& [left, right] : rule.swap) {
    if (joint.starts_with(left)) return right + joint.substr(left.size());
    if (joint.starts_with(right)) return left + joint.substr(right.size());
  }
  return joint;
}

/// Keeps keys `first` and `last`, and those between that are farthest from the line, until all are within tolerance.
void simplify(const std::vector<TrackKey>& keys, std::size_t first, std::size_t last, double tolerance,
              std::vector<bool>& kept) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    double furthest = tolerance;
    std::size_t at = 0;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double share = (keys[i].at_s - keys[a].at_s) / (keys[b].at_s - keys[a].at_s);
      const double off = std::abs(keys[i].value - keys[a].value - share * (keys[b].value - keys[a].value));
      if (off > furthest) {
        furthest = off;
        at = i;
      }
    }
    if (at == 0) continue;
    kept[at] = true;
    open.emplace_back(a, at);
    open.emplace_back(at, b);
  }
}

/// Replaces values that are those of a pose by its name.  The pose with the most joints is taken.
void use_poses(const JointMotion& motion, sim::MotionKey& key) {
  const auto has = [&](const std::pair<std::string, double>& desired) {
    return std::find(key.joints.begin(), key.joints.end(), desired) != key.joints.end();
  };
  const sim::MotionPose* best = nullptr;
  for (const sim::MotionPose& pose : motion.poses)
    if (std::all_of(pose.joints.begin(), pose.joints.end(), has) &&
        (best == nullptr || pose.joints.size() > best->joints.size()))
      best = &pose;
  if (best == nullptr || best->joints.empty()) return;
  key.pose = best->name;
  std::erase_if(key.joints, [&](const auto& one) {
    return std::find(best->joints.begin(), best->joints.end(), one) != best->joints.end();
  });
}

}  // namespace

JointMotion with_tracks(const JointMotion& motion, std::vector<MotionTrack> tracks,
                        const std::function<double(double)>& time_of) {
  JointMotion changed = copy_to_change(motion);
  changed.frames.clear();
  changed.frames_file.clear();
  changed.keys.clear();
  // Keys by their times.  The easing of a joint's first key has no effect.
  struct Instant {
    sim::JointValues joints;
    std::vector<Easing> eases;
  };
  std::map<std::int64_t, Instant> by_time;  // ns
  double end_s = 0;
  for (const MotionTrack& track : tracks)
    for (const TrackKey& key : track.keys) {
      Instant& instant = by_time[std::llround(key.at_s * 1e9)];
      instant.joints.emplace_back(track.joint, key.value);
      if (&key != &track.keys.front()) instant.eases.push_back(key.ease);
      end_s = std::max(end_s, key.at_s);
    }
  for (auto& [at_ns, at_once] : by_time) {
    Instant& instant = at_once;
    const auto differs = [&](Easing ease) { return ease != instant.eases.front(); };
    // A key has one easing: where joints differ, all are sampled.
    if (std::any_of(instant.eases.begin(), instant.eases.end(), differs))
      return with_tracks(motion, sim::sampled(tracks, end_s, motion.frame_s), time_of);
    sim::MotionKey& key = changed.keys.emplace_back();
    key.at_s = static_cast<double>(at_ns) / 1e9;
    key.joints = std::move(instant.joints);
    if (!instant.eases.empty() && instant.eases.front() != motion.ease) key.ease = instant.eases.front();
    use_poses(motion, key);
  }
  for (const sim::MotionKey& key : motion.keys) {
    const double t_s = key.note.empty() ? -1 : time_of(key.at_s);
    for (sim::MotionKey& moved : changed.keys)
      if (t_s >= 0 && std::abs(moved.at_s - t_s) < 1e-6) moved.note = key.note;
  }
  return changed;
}

JointMotion trimmed(const JointMotion& motion, double from_s, double to_s) {
  check_part(motion, from_s, to_s);
  JointMotion left =
      with_tracks(motion, part(motion, from_s, to_s), [=](double t_s) { return t_s <= to_s ? t_s - from_s : -1; });
  // Changes before the part take effect at its start.
  std::erase_if(left.changes, [=](const sim::MotionChange& change) { return change.at_s > to_s; });
  for (sim::MotionChange& change : left.changes) change.at_s = std::max(0.0, change.at_s - from_s);
  move_sounds(left, [=](double at_s) { return at_s >= from_s && at_s <= to_s ? at_s - from_s : -1; });
  return left;
}

JointMotion without(const JointMotion& motion, double from_s, double to_s) {
  check_part(motion, from_s, to_s);
  const double end_s = motion.end_s();
  if (from_s <= same_time_s && to_s >= end_s - same_time_s) throw EditError("nothing of the motion would be left");
  if (from_s <= same_time_s) return trimmed(motion, to_s, end_s);
  if (to_s >= end_s - same_time_s) return trimmed(motion, 0, from_s);
  const std::vector<MotionTrack> rest = part(motion, to_s, end_s);
  std::vector<MotionTrack> tracks = joined(part(motion, 0, from_s), rest, from_s, motion.frame_s);
  add_after(tracks, rest, from_s);
  JointMotion left = with_tracks(motion, std::move(tracks), [=](double t_s) {
    return t_s < from_s ? t_s : t_s >= to_s ? t_s - to_s + from_s : -1;
  });
  // What happened in the part that was cut out stays: otherwise the world would be a different one afterwards.
  for (sim::MotionChange& change : left.changes)
    change.at_s = change.at_s < to_s ? std::min(change.at_s, from_s) : change.at_s - to_s + from_s;
  move_sounds(left, [=](double at_s) { return at_s < from_s ? at_s : at_s < to_s ? -1 : at_s - to_s + from_s; });
  return left;
}

JointMotion appended(const JointMotion& motion, const JointMotion& other, double gap_s) {
  if (!(gap_s > 0)) throw EditError("the pause between two motions must be > 0 s, got " + sim::number_text(gap_s));
  JointMotion both = motion;
  for (const sim::MotionPose& pose : other.poses)
    if (motion.find_pose(pose.name) == nullptr) both.poses.push_back(pose);
  add_units(both, other);
  // Joints of the first motion hold during the pause's start, and move to the other's first values within it.
  const double start_s = motion.end_s() + gap_s;
  std::vector<MotionTrack> tracks = part(motion, 0, motion.end_s());
  add_after(tracks, other.tracks(), start_s);
  for (sim::MotionChange change : other.changes) {
    change.at_s += start_s;
    both.changes.push_back(std::move(change));
  }
  add_sounds(both, other, start_s);
  return with_tracks(both, std::move(tracks), unchanged);
}

JointMotion merged(const JointMotion& motion, const JointMotion& other, bool replace) {
  std::vector<MotionTrack> tracks = motion.tracks();
  for (const MotionTrack& track : other.tracks()) {
    const auto same =
        std::find_if(tracks.begin(), tracks.end(), [&](const auto& one) { return one.joint == track.joint; });
    if (same == tracks.end())
      tracks.push_back(track);
    else if (replace)
      *same = track;
    else
      throw EditError("both motions have joint '" + track.joint + "'; --replace takes that of the second");
  }
  JointMotion both = with_tracks(motion, std::move(tracks), unchanged);
  add_units(both, other);
  // Both start at the same time.  A change that both have, such as of two parts of one recording, happens once.
  for (const sim::MotionChange& change : other.changes)
    if (std::none_of(motion.changes.begin(), motion.changes.end(), [&](const sim::MotionChange& one) {
          return std::abs(one.at_s - change.at_s) < same_time_s &&
                 sim::to_flow_yaml(one.action) == sim::to_flow_yaml(change.action);
        }))
      both.changes.push_back(change);
  std::stable_sort(both.changes.begin(), both.changes.end(),
                   [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
  for (const sim::MotionSound& sound : other.sounds)
    if (std::none_of(motion.sounds.begin(), motion.sounds.end(), [&](const sim::MotionSound& one) {
          return std::abs(one.at_s - sound.at_s) < same_time_s && one.sound == sound.sound;
        }))
      both.sounds.push_back(sound);
  return both;
}

JointMotion mirrored(const JointMotion& motion, const MirrorRule& rule) {
  JointMotion changed = copy_to_change(motion);
  const auto sign = [&](const std::string& joint) {
    return std::find(rule.negate.begin(), rule.negate.end(), joint) != rule.negate.end() ? -1.0 : 1.0;
  };
  const auto mirror = [&](sim::JointValues& values) {
    for (auto& [joint, value] : values) {
      value *= sign(joint);
      joint = mirrored_name(joint, rule);
    }
  };
  for (std::string& light : changed.lights) light = mirrored_name(light, rule);
  for (sim::MotionPose& pose : changed.poses) mirror(pose.joints);
  for (sim::MotionKey& key : changed.keys) mirror(key.joints);
  for (MotionTrack& track : changed.frames) {
    for (TrackKey& key : track.keys) key.value *= sign(track.joint);
    track.joint = mirrored_name(track.joint, rule);
  }
  return changed;
}

JointMotion with_mirrored_half(const JointMotion& motion, const MirrorRule& rule) {
  const JointMotion other = mirrored(motion, rule);
  const double half_s = motion.end_s();
  std::vector<MotionTrack> tracks = part(motion, 0, half_s);
  const std::vector<MotionTrack> second = part(other, 0, half_s);
  // Joints that only one half moves rest in the other one.
  for (const MotionTrack& track : second)
    if (std::none_of(tracks.begin(), tracks.end(), [&](const auto& one) { return one.joint == track.joint; }))
      tracks.push_back({track.joint, {{0, track.keys.front().value, Easing::linear}}});
  tracks = joined(std::move(tracks), second, half_s, motion.frame_s);
  add_after(tracks, second, half_s);
  JointMotion both = motion;
  add_units(both, other);
  add_sounds(both, other, half_s);
  return with_tracks(both, std::move(tracks), unchanged);
}

JointMotion shifted(const JointMotion& motion, double by_s, const std::vector<std::string>& joints) {
  std::vector<MotionTrack> tracks = motion.tracks();
  for (const std::string& joint : joints)
    if (std::none_of(tracks.begin(), tracks.end(), [&](const auto& one) { return one.joint == joint; }))
      throw EditError("the motion has no joint '" + joint + "'");
  for (MotionTrack& track : tracks) {
    if (!joints.empty() && std::find(joints.begin(), joints.end(), track.joint) == joints.end()) continue;
    for (TrackKey& key : track.keys) key.at_s += by_s;
    if (track.keys.front().at_s < 0)
      throw EditError("joint '" + track.joint + "' would start at " + sim::number_text(track.keys.front().at_s) +
                      " s, before 0");
  }
  JointMotion moved =
      with_tracks(motion, std::move(tracks), [=](double t_s) { return joints.empty() ? t_s + by_s : t_s; });
  if (!joints.empty()) return moved;
  // What happened before the new start now happens at the start.
  for (sim::MotionChange& change : moved.changes) change.at_s = std::max(0.0, change.at_s + by_s);
  move_sounds(moved, [=](double t_s) { return std::max(0.0, t_s + by_s); });
  return moved;
}

JointMotion stretched(const JointMotion& motion, double factor) {
  if (!(factor > 0)) throw EditError("the factor must be > 0, got " + sim::number_text(factor));
  std::vector<MotionTrack> tracks = motion.tracks();
  for (MotionTrack& track : tracks)
    for (TrackKey& key : track.keys) key.at_s *= factor;
  JointMotion changed = with_tracks(motion, std::move(tracks), [=](double t_s) { return t_s * factor; });
  for (sim::MotionChange& change : changed.changes) change.at_s *= factor;
  move_sounds(changed, [=](double t_s) { return t_s * factor; });
  return changed;
}

JointMotion retimed(const JointMotion& motion, double at_s, double to_s) {
  JointMotion changed = copy_to_change(motion);
  const auto is_there = [&](const sim::MotionKey& key) { return std::abs(key.at_s - at_s) < 1e-6; };
  const auto key = std::find_if(changed.keys.begin(), changed.keys.end(), is_there);
  if (key == changed.keys.end()) throw EditError("no key is at " + sim::number_text(at_s) + " s");
  const double after_s = key == changed.keys.begin() ? -1 : std::prev(key)->at_s;
  const bool is_last = std::next(key) == changed.keys.end();
  // Passing a neighbor would change the order of keys, and with it the path of every joint.
  if (to_s < 0 || to_s <= after_s || (!is_last && to_s >= std::next(key)->at_s))
    throw EditError("a key stays between its neighbors, at " + sim::number_text(std::max(after_s, 0.0)) + " s" +
                    (is_last ? "" : " and " + sim::number_text(std::next(key)->at_s) + " s") + ", got " +
                    sim::number_text(to_s));
  key->at_s = to_s;
  return changed;
}

JointMotion smoothed(const JointMotion& motion, double window_s) {
  if (!(window_s > 0)) throw EditError("the window must be > 0 s, got " + sim::number_text(window_s));
  const double values = motion.end_s() / motion.frame_s * static_cast<double>(motion.tracks().size());
  if (values > max_frame_values)
    throw EditError("its frames would have more than " + sim::number_text(max_frame_values) +
                    " values: " + sim::number_text(std::round(values)));
  std::vector<MotionTrack> tracks = sim::sampled(motion.tracks(), motion.end_s(), motion.frame_s);
  const auto half = static_cast<std::ptrdiff_t>(std::floor(window_s / motion.frame_s / 2));
  for (MotionTrack& track : tracks) {
    // Sums of the values before each frame, relative to the first one so that they stay small
    std::vector<double> sums(1, 0);
    const double first = track.keys.front().value;
    for (const TrackKey& key : track.keys) sums.push_back(sums.back() + key.value - first);
    const auto last = static_cast<std::ptrdiff_t>(track.keys.size()) - 1;
    for (std::ptrdiff_t i = 0; i <= last; ++i) {
      // Towards the ends the window shrinks on both sides, so that the ends stay.
      const std::ptrdiff_t reach = std::min({half, i, last - i});
      const double sum = sums[static_cast<std::size_t>(i + reach + 1)] - sums[static_cast<std::size_t>(i - reach)];
      if (reach > 0) track.keys[static_cast<std::size_t>(i)].value = first + sum / static_cast<double>(2 * reach + 1);
    }
  }
  return with_tracks(motion, std::move(tracks), unchanged);
}

JointMotion simplified(const JointMotion& motion, double tolerance) {
  if (!(tolerance > 0))
    throw EditError(fmt::format("the tolerance must be > 0 deg, got {:.6g}", tolerance * 180 / std::numbers::pi));
  std::vector<MotionTrack> tracks = motion.tracks();
  for (MotionTrack& track : tracks) {
    const auto is_curved = [](const TrackKey& key) { return key.ease != Easing::linear; };
    // Easing already describes a path with few keys.
    if (track.keys.size() < 3 || std::any_of(track.keys.begin() + 1, track.keys.end(), is_curved)) continue;
    std::vector<bool> kept(track.keys.size(), false);
    kept.front() = kept.back() = true;
    simplify(track.keys, 0, track.keys.size() - 1, tolerance, kept);
    std::vector<TrackKey> keys;
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (kept[i]) keys.push_back(track.keys[i]);
    track.keys = std::move(keys);
  }
  return with_tracks(motion, std::move(tracks), unchanged);
}

JointMotion with_values(const JointMotion& motion, double at_s, const sim::JointValues& values) {
  if (!(at_s >= 0 && at_s <= sim::max_motion_s))
    throw EditError("the time must be >= 0 and <= 86400 s, got " + sim::number_text(at_s));
  std::vector<MotionTrack> tracks = motion.tracks();
  for (const auto& [joint, value] : values) {
    const std::string& name = joint;
    auto track = std::find_if(tracks.begin(), tracks.end(), [&](const auto& one) { return one.joint == name; });
    if (track == tracks.end()) track = tracks.insert(tracks.end(), {name, {}});
    // Times of keys are compared with a tolerance, since they went through decimal text.
    const auto key = std::find_if(track->keys.begin(), track->keys.end(),
                                  [&](const TrackKey& one) { return one.at_s > at_s - same_time_s; });
    if (key != track->keys.end() && key->at_s < at_s + same_time_s)
      key->value = value;
    else
      track->keys.insert(key, {at_s, value, motion.ease});
  }
  return with_tracks(motion, std::move(tracks), unchanged);
}

JointMotion with_pose(const JointMotion& motion, const std::string& name, double at_s) {
  JointMotion changed = motion;
  sim::MotionPose pose{name, {}};
  for (const MotionTrack& track : motion.tracks()) pose.joints.emplace_back(track.joint, track.value_at(at_s));
  const auto same =
      std::find_if(changed.poses.begin(), changed.poses.end(), [&](const auto& one) { return one.name == name; });
  if (same == changed.poses.end())
    changed.poses.push_back(std::move(pose));
  else
    *same = std::move(pose);
  return changed;
}

}  // namespace motion
