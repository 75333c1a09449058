// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/recorded_motion.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "motion/analysis/motion_edit.hpp"
#include "motion/analysis/motion_file.hpp"
#include "motion/record/take_journal.hpp"
#include "sim/base/whole_file.hpp"
#include "sim/motion/motion_frames.hpp"

namespace motion {

namespace {

namespace fs = std::filesystem;
using sim::Easing;
using sim::MotionTrack;
using sim::TrackKey;

constexpr double same_time_s = 1e-9;

double time_of(std::size_t frame, double frame_s) {
  return static_cast<double>(frame) * frame_s;
}

bool is_recorded(const Take& take, const std::string& joint) {
  return std::find(take.settings.joints.begin(), take.settings.joints.end(), joint) != take.settings.joints.end();
}

bool is_at_rest(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [&](double value) { return value == values.front(); });
}

MotionTrack frames_of(const Take& take, std::size_t joint, std::size_t from, std::size_t to) {
  MotionTrack track{take.settings.joints[joint], {}};
  for (std::size_t i = from; i <= to; ++i)
    track.keys.push_back({time_of(i, take.settings.frame_s), take.frames[joint][i], Easing::linear});
  return track;
}

/// Settings, changes and origin of the result.
sim::JointMotion common_of(const Take& take, const sim::JointMotion& base) {
  sim::JointMotion motion = base;
  if (motion.vehicle.empty()) motion.vehicle = take.settings.model;
  for (const std::string& joint : take.settings.sliders)
    if (std::find(motion.sliders.begin(), motion.sliders.end(), joint) == motion.sliders.end())
      motion.sliders.push_back(joint);
  motion.frame_s = take.settings.frame_s;
  for (const TakeChange& change : take.changes) motion.changes.push_back({change.at_s, change.action});
  std::stable_sort(motion.changes.begin(), motion.changes.end(),
                   [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
  motion.recorded =
      sim::MotionOrigin{take.settings.world, take.settings.vehicle, take.settings.seed, "", take.settings.set, {}};
  return motion;
}

/// Removes the recorded joints from the keys and frames of a motion.
void remove_joints(const Take& take, sim::JointMotion& motion) {
  const auto is_replaced = [&](const auto& value) { return is_recorded(take, value.first); };
  for (sim::MotionKey& key : motion.keys) {
    const sim::MotionPose* pose = motion.find_pose(key.pose);
    if (pose != nullptr && std::any_of(pose->joints.begin(), pose->joints.end(), is_replaced)) {
      key.joints = motion.values_of(key);
      key.pose.clear();
    }
    std::erase_if(key.joints, is_replaced);
  }
  std::erase_if(motion.keys, [](const sim::MotionKey& key) { return key.pose.empty() && key.joints.empty(); });
  std::erase_if(motion.frames, [&](const MotionTrack& track) { return is_recorded(take, track.joint); });
}

/// Appends frames of a track strictly between two times.
void add_frames(std::vector<TrackKey>& keys, const MotionTrack& track, double from_s, double to_s, double frame_s) {
  for (double frame = std::floor(from_s / frame_s) + 1; frame * frame_s < to_s - same_time_s; ++frame)
    if (frame * frame_s > from_s + same_time_s)
      keys.push_back({frame * frame_s, track.value_at(frame * frame_s), Easing::linear});
}

/// Returns the easing of the key of a motion at a time; linear: there is none, or it depends on other keys.
Easing easing_at(const sim::JointMotion& motion, double at_s) {
  for (const sim::MotionKey& key : motion.keys)
    if (const Easing ease = key.ease.value_or(motion.ease);
        std::abs(key.at_s - at_s) <= same_time_s && ease != Easing::spline)
      return ease;
  return Easing::linear;
}

/// Puts the keys of a part into a track, in place of what it has there.  Segments that are cut and not linear become
/// frames.  `ease`: of the keys of other joints at the start of the part; a joint that does not move up to it has it
/// too.
MotionTrack spliced(const MotionTrack& track, const std::vector<TrackKey>& part, double frame_s, Easing ease) {
  const double from_s = part.front().at_s, to_s = part.back().at_s;
  MotionTrack result{track.joint, {}};
  // Keys before the part.
  auto key = track.keys.begin();
  for (; key != track.keys.end() && key->at_s < from_s - same_time_s; ++key) result.keys.push_back(*key);
  const bool is_cut = key != track.keys.end() && key->at_s > from_s + same_time_s;
  if (is_cut && key != track.keys.begin() && key->ease != Easing::linear)
    add_frames(result.keys, track, result.keys.back().at_s, from_s, frame_s);
  // The part, then what follows.
  const auto first = result.keys.insert(result.keys.end(), part.begin(), part.end());
  if (!is_cut) first->ease = key != track.keys.end() ? key->ease : ease;
  while (key != track.keys.end() && key->at_s <= to_s + same_time_s) ++key;
  if (key == track.keys.end()) return result;
  TrackKey next = *key;
  if (key != track.keys.begin() && key->ease != Easing::linear) {
    add_frames(result.keys, track, to_s, key->at_s, frame_s);
    next.ease = Easing::linear;
  }
  result.keys.push_back(next);
  result.keys.insert(result.keys.end(), key + 1, track.keys.end());
  return result;
}

/// Returns whether keys of the recorded joints, which are linear, come at the times of keys of others that are not: a
/// key has one easing.
bool clashes(const Take& take, const sim::JointMotion& base, const std::vector<MotionTrack>& tracks) {
  std::vector<std::int64_t> curved;  // ns
  for (const MotionTrack& track : tracks)
    for (std::size_t i = 1; i < track.keys.size() && !is_recorded(take, track.joint); ++i)
      if (track.keys[i].ease != Easing::linear) curved.push_back(std::llround(track.keys[i].at_s * 1e9));
  std::sort(curved.begin(), curved.end());
  const auto clash = [&](const TrackKey& key) {
    return std::binary_search(curved.begin(), curved.end(), std::llround(key.at_s * 1e9));
  };
  return !base.keys.empty() && std::any_of(tracks.begin(), tracks.end(), [&](const MotionTrack& track) {
    return is_recorded(take, track.joint) && track.keys.size() > 1 &&
           std::any_of(track.keys.begin() + 1, track.keys.end(), clash);
  });
}

std::string text_beside(const std::string& path, const std::string& ending) {
  return (fs::path(path).parent_path() / (fs::path(path).stem().string() + ending)).string();
}

}  // namespace

sim::JointMotion exact_motion(const Take& take, const sim::JointMotion& base) {
  sim::JointMotion motion = common_of(take, base);
  motion.angles = sim::AngleUnit::rad;
  remove_joints(take, motion);
  const std::size_t last = take.frame_count() - 1;
  const double end_s = std::max(time_of(last, motion.frame_s), base.end_s());
  if (!motion.frames.empty()) motion.frames = sim::sampled(motion.frames, end_s, motion.frame_s);
  // Joints that move as frames, the others as one key.
  sim::JointValues at_rest;
  const bool any_moves = !std::all_of(take.frames.begin(), take.frames.end(), is_at_rest);
  for (std::size_t i = 0; i < take.frames.size(); ++i) {
    if (!is_at_rest(take.frames[i]) || (!any_moves && i == 0))
      motion.frames.push_back(sim::sampled({frames_of(take, i, 0, last)}, end_s, motion.frame_s).front());
    else
      at_rest.emplace_back(take.settings.joints[i], take.frames[i].front());
  }
  if (at_rest.empty()) return motion;
  if (motion.keys.empty() || motion.keys.front().at_s > 0) motion.keys.insert(motion.keys.begin(), sim::MotionKey{});
  sim::JointValues& first = motion.keys.front().joints;
  first.insert(first.end(), at_rest.begin(), at_rest.end());
  return motion;
}

sim::JointMotion keyed_motion(const Take& take, const sim::JointMotion& base, double tolerance) {
  const double frame_s = take.settings.frame_s;
  const std::size_t last = take.frame_count() - 1;
  const auto frame_at = [&](double at_s) {
    return std::min(last, static_cast<std::size_t>(std::max(0.0, std::round(at_s / frame_s))));
  };
  const std::size_t from = take.settings.from_s ? frame_at(*take.settings.from_s) : 0;
  const std::size_t to = take.settings.to_s ? std::max(from, frame_at(*take.settings.to_s)) : last;
  // The recorded part of each joint as keys.
  sim::JointMotion part;
  for (std::size_t i = 0; i < take.frames.size(); ++i) part.frames.push_back(frames_of(take, i, from, to));
  std::vector<MotionTrack> keyed = to > from + 1 ? simplified(part, tolerance).tracks() : part.tracks();
  const bool any_moves = !std::all_of(take.frames.begin(), take.frames.end(), is_at_rest);
  // Put them into the motion.
  std::vector<MotionTrack> tracks = base.tracks();
  const Easing ease = easing_at(base, time_of(from, frame_s));
  for (MotionTrack& track : keyed) {
    const auto same =
        std::find_if(tracks.begin(), tracks.end(), [&](const auto& one) { return one.joint == track.joint; });
    const bool is_whole = from == 0 && to == last;
    if (same != tracks.end() && !is_whole) {
      const auto is_spline = [](const TrackKey& key) { return key.ease == Easing::spline; };
      if (std::any_of(same->keys.begin(), same->keys.end(), is_spline))
        *same = sim::sampled({*same}, base.end_s(), frame_s).front();
      *same = spliced(*same, track.keys, frame_s, ease);
      continue;
    }
    const auto rests = [&](const TrackKey& key) { return key.value == track.keys.front().value; };
    if (any_moves && std::all_of(track.keys.begin(), track.keys.end(), rests)) track.keys.resize(1);
    // A joint holds after its last key.
    while (base.end_s() > 0 && track.keys.size() > 1 && track.keys.back().value == track.keys.rbegin()[1].value &&
           track.keys.back().at_s <= base.end_s() + same_time_s)
      track.keys.pop_back();
    if (same != tracks.end())
      *same = track;
    else
      tracks.push_back(track);
  }
  if (clashes(take, base, tracks)) {
    sim::JointMotion motion = exact_motion(take, base);
    motion.angles = base.angles;
    return motion;
  }
  return with_tracks(common_of(take, base), std::move(tracks), [](double t_s) { return t_s; });
}

std::string take_path(const std::string& path) {
  return text_beside(path, "_take.yaml");
}

std::string journal_path(const std::string& path) {
  return path + ".journal";
}

std::optional<RecoveredTake> read_journal(const std::string& path) {
  const std::string journal = journal_path(path);
  std::error_code error;
  const fs::file_type type = fs::status(journal, error).type();
  if (type == fs::file_type::not_found) return std::nullopt;
  if (type != fs::file_type::regular)
    throw sim::ConfigError({journal + ": must be a regular file, the journal of a recording"});
  if (is_recording(journal)) throw std::runtime_error("'" + path + "' is being recorded by another process");
  std::string text;
  try {
    text = sim::whole_file<std::runtime_error>(journal);
  } catch (const std::runtime_error& problem) {
    throw sim::ConfigError({journal + ": " + problem.what()});
  }
  // One that ended before its first frame holds nothing.
  const bool is_journal = std::string_view(take_head).starts_with(std::string_view(text).substr(0, take_head.size()));
  if (is_journal && std::count(text.begin(), text.end(), '\n') < 3) {
    fs::remove(journal);
    return std::nullopt;
  }
  RecoveredTake recovered;
  try {
    recovered.take = parse_take(text, journal, &recovered.damage);
  } catch (const sim::ConfigError& problem) {
    throw sim::ConfigError({problem.lines().front() + "; nothing of it can be recovered: rename or remove it"});
  }
  return recovered;
}

SavedTake save_take(const std::string& path, const RecoveredTake& recovered, const std::string& state_hash,
                    const std::string& operation) {
  const Take& take = recovered.take;
  sim::JointMotion base;
  base.name = motion_name_of(path);
  if (take.settings.over) base = sim::load_motion(path);
  sim::JointMotion exact = exact_motion(take, base);
  exact.recorded->state_hash = state_hash;
  SavedTake saved{keyed_motion(take, base), ""};
  write_motion(take_path(path), exact);
  if (fs::exists(path))
    MotionHistory(path).replace(saved.motion, operation);
  else
    write_motion(path, saved.motion);
  if (!recovered.damage) {
    fs::remove(journal_path(path));
    return saved;
  }
  // Under the first name that is free.
  const std::string bad = journal_path(path) + ".bad";
  saved.damaged_journal = bad;
  for (int number = 2; fs::exists(fs::symlink_status(saved.damaged_journal)); ++number)
    saved.damaged_journal = bad + std::to_string(number);
  fs::rename(journal_path(path), saved.damaged_journal);
  return saved;
}

}  // namespace motion
