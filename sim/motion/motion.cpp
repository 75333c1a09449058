// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/motion.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "sim/config/common_keys.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"
#include "sim/motion/motion_frames.hpp"

namespace sim {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;
constexpr double max_joint_value = 1e6;

/// `joints:` as written.
struct JointReader {
  ConfigNode map;
  std::string who;

  void read(ParamReader& in, const char* meaning) {
    who = in.who();
    in.read_raw("joints", map, meaning);
  }

  /// Converts values in degrees, except those of sliders and lights.
  JointValues values(const JointMotion& motion, Diagnostics& diagnostics) const {
    JointValues values;
    for (const ConfigNode::Entry& entry : map.entries) {
      if (const std::string error = joint_name_error(entry.key); !error.empty()) {
        diagnostics.error(entry.place, who, error);
        continue;
      }
      double value = 0;
      const ConfigNode one = map_node(entry.key, entry.value);
      ParamReader reader(one, who, diagnostics);
      reader.read(entry.key.c_str(), value, between(-max_joint_value, max_joint_value), "");
      values.emplace_back(entry.key, value * motion.unit_of(entry.key));
    }
    if (values.size() > max_motion_joints)
      diagnostics.error(map.place, who, "'joints' must name at most " + std::to_string(max_motion_joints) + " joints");
    return values;
  }
};

/// Pose or key as written, with values in the unit of the file.
struct PoseReader {
  MotionPose pose;
  JointReader joints;

  void read(ParamReader& in) {
    in.require("name");
    in.read_name("name", pose.name, "name of the pose");
    in.require("joints");
    joints.read(in, "name or alias of a joint, or a light: its value");
  }
};

struct KeyReader {
  MotionKey key;
  JointReader joints;

  void read(ParamReader& in) {
    if (in.node() != nullptr) key.place = in.node()->place;
    in.require("at_s");
    in.read("at_s", key.at_s, between(0, max_motion_s), "time from the start; times of keys increase");
    in.read_reference("pose", key.pose, "pose", "pose whose joints are all set");
    joints.read(in, "name or alias of a joint, or a light: its value, instead of that of the pose");
    Easing ease = Easing::linear;
    in.read_choice("ease", ease, easing_words, "path from the key before of each joint; unset: that of the motion");
    if (in.has("ease")) key.ease = ease;
    in.read("note", key.note, "remark");
    if (!in.describing() && key.pose.empty() && !in.has("joints")) in.error("needs a 'pose' or 'joints'");
  }
};

struct ChangeReader {
  MotionChange change;

  void read(ParamReader& in) {
    in.require("at_s");
    in.read("at_s", change.at_s, between(0, max_motion_s), "time from the start");
    in.require("do");
    in.read_raw("do", change.action, "action, as in 'events' of a world");
  }
};

void check_times(ParamReader& in, const std::vector<MotionKey>& keys) {
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (!(keys[i].at_s > keys[i - 1].at_s))
      in.diagnostics().error(keys[i].place, in.who(),
                             "key " + std::to_string(i + 1) + ": 'at_s' must be above that of the key before, " +
                                 number_text(keys[i - 1].at_s) + ", got " + number_text(keys[i].at_s));
}

std::string path_beside(const ConfigNode* node, const std::string& file) {
  const std::filesystem::path folder =
      node != nullptr && node->place.file != nullptr ? std::filesystem::path(*node->place.file).parent_path() : "";
  return (folder / file).string();
}

}  // namespace

JointMotion::JointMotion() = default;
JointMotion::JointMotion(const JointMotion&) = default;
JointMotion::JointMotion(JointMotion&&) noexcept = default;
JointMotion& JointMotion::operator=(const JointMotion&) = default;
JointMotion& JointMotion::operator=(JointMotion&&) noexcept = default;
JointMotion::~JointMotion() = default;

double JointMotion::unit_of(const std::string& joint) const {
  const bool is_slider = std::find(sliders.begin(), sliders.end(), joint) != sliders.end();
  return angles == AngleUnit::deg && !is_slider && !is_light(joint) ? rad_per_deg : 1.0;
}

bool JointMotion::is_light(const std::string& joint) const {
  return std::find(lights.begin(), lights.end(), joint) != lights.end();
}

void MotionSound::read(ParamReader& in) {
  in.require("at_s");
  in.read("at_s", at_s, between(0, max_motion_s), "time from the start, within the motion");
  in.require("sound");
  in.read_name("sound", sound, "sound of a speaker of the vehicle");
  in.read("volume", volume, between(1e-6, 1), "share of its greatest sound pressure");
}

void MotionStart::read(ParamReader& in) {
  in.read("max_velocity", max_velocity, between(0.001, 1000), "velocity of the fastest joint on the way, rad/s or m/s");
  in.read("min_s", min_s, between(0, 600), "least time for the way");
}

void MotionOrigin::read(ParamReader& in) {
  in.read("world", world, "name of the world");
  in.read("vehicle", vehicle, "name of the vehicle in the world");
  in.read("seed", seed, between(0, 9007199254740992.0), "seed of the run");
  in.read("set", set, "changes of the world, as with --set");
  in.read("state_hash", state_hash, "state hash at the end of the recording");
  in.read_raw("embedded_world", embedded_world, "the world itself, in which it is played when no other one is named");
}

void JointMotion::read(ParamReader& in) {
  int version = 1;
  read_version(in, "shoal", version);
  in.require("motion");
  read_keys(in);
}

void JointMotion::read_keys(ParamReader& in) {
  in.read_name("motion", name, "name of the motion");
  in.read("description", description, "description in one sentence");
  in.read("vehicle", vehicle, "name of the vehicle model for which it was made");
  // Units.
  in.read_choice("angles", angles, {{"deg", AngleUnit::deg}, {"rad", AngleUnit::rad}}, "unit of the values of joints");
  in.read("sliders", sliders, "joints whose values are in m");
  in.read("lights", lights, "names in `joints` that are lights of the vehicle, with values from 0, off, to 1");
  // How it is played.
  in.read_choice("ease", ease, easing_words, "path between keys that do not say otherwise");
  in.read("loop", loop, "it is repeated until it is stopped");
  in.read("frame_s", frame_s, between(0.001, 1), "time between two set points");
  in.read("start", start, "how the joints reach the first values");
  // Poses and keys.
  std::vector<PoseReader> pose_readers;
  in.read_list("poses", pose_readers, "pose", "poses that keys name");
  for (PoseReader& reader : pose_readers) {
    in.declare("pose", reader.pose.name);
    reader.pose.joints = reader.joints.values(*this, in.diagnostics());
    poses.push_back(std::move(reader.pose));
  }
  std::vector<KeyReader> key_readers;
  in.read_list("keys", key_readers, "key", "instants of the motion, and the values of joints at them");
  for (KeyReader& reader : key_readers) {
    reader.key.joints = reader.joints.values(*this, in.diagnostics());
    keys.push_back(std::move(reader.key));
  }
  const bool may_read = in.read_path("frames", frames_file, PathUse::read,
                                     "CSV file of sampled values in rad or m, relative to this file: t_s, then joints");
  in.read_list("sounds", sounds, "sound", "sounds that a speaker of the vehicle plays");
  std::vector<ChangeReader> change_readers;
  in.read_list("changes", change_readers, "change", "changes of the world during the motion");
  for (ChangeReader& reader : change_readers) changes.push_back(std::move(reader.change));
  in.read("recorded", recorded, "run in which it was recorded");
  if (in.describing()) return;
  check_times(in, keys);
  if (!frames_file.empty() && may_read) frames = read_motion_frames(path_beside(in.node(), frames_file), in, "frames");
  if (in.diagnostics().ok() && tracks().empty()) in.error("needs 'keys' or 'frames'");
}

const MotionPose* JointMotion::find_pose(const std::string& pose) const {
  const auto found = std::find_if(poses.begin(), poses.end(), [&](const MotionPose& one) { return one.name == pose; });
  return found == poses.end() ? nullptr : &*found;
}

JointValues JointMotion::values_of(const MotionKey& key) const {
  JointValues values;
  // A key sets all joints of its pose, and then its own values.
  if (const MotionPose* pose = find_pose(key.pose)) values = pose->joints;
  for (const auto& [joint, value] : key.joints) {
    const auto same =
        std::find_if(values.begin(), values.end(), [&name = joint](const auto& one) { return one.first == name; });
    if (same == values.end())
      values.emplace_back(joint, value);
    else
      same->second = value;
  }
  return values;
}

std::vector<MotionTrack> JointMotion::tracks() const {
  std::vector<MotionTrack> all = frames;
  std::map<std::string, std::size_t> number_of;
  for (std::size_t i = 0; i < all.size(); ++i) number_of[all[i].joint] = i;
  std::vector<bool> has_frames(all.size(), true);  // until its first key
  for (const MotionKey& key : keys)
    for (const auto& [joint, value] : values_of(key)) {
      const auto [place, is_new] = number_of.try_emplace(joint, all.size());
      if (is_new) all.push_back({joint, {}});
      MotionTrack& track = all[place->second];
      // Keys take the place of the frames of a joint.
      if (place->second < has_frames.size() && has_frames[place->second]) {
        has_frames[place->second] = false;
        track.keys.clear();
      }
      track.keys.push_back({key.at_s, value, key.ease.value_or(ease)});
    }
  return all;
}

double JointMotion::end_s() const {
  double end_s = keys.empty() ? 0 : keys.back().at_s;
  for (const MotionTrack& track : frames) end_s = std::max(end_s, track.keys.back().at_s);
  return end_s;
}

JointMotion load_motion(const std::string& path, Diagnostics& diagnostics) {
  JointMotion motion;
  const ConfigNode root = load_config_file(path, diagnostics);
  if (!diagnostics.ok()) return motion;
  ParamReader in(root, "", diagnostics);
  motion.read(in);
  in.finish();
  return motion;
}

JointMotion load_motion(const std::string& path) {
  Diagnostics diagnostics;
  JointMotion motion = load_motion(path, diagnostics);
  diagnostics.throw_if_any();
  return motion;
}

std::string joint_name_error(std::string_view name) {
  bool is_good = !name.empty() && name.size() <= max_joint_name;
  for (std::size_t i = 0; is_good && i < name.size();) {
    const auto c = static_cast<unsigned char>(name[i]);
    const std::size_t length = utf8_length(name, i);
    is_good = length > 0 && c >= 0x20 && c != 0x7f;
    i += length;
  }
  if (is_good) return "";
  return "the name of a joint must be UTF-8 text of 1 to " + std::to_string(max_joint_name) +
         " bytes without control characters, got '" + shortened(printable(in_utf8(name.substr(0, 1000)))) + "'";
}

}  // namespace sim
