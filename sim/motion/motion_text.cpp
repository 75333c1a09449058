// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>

#include "sim/base/number.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"
#include "sim/motion/motion.hpp"

namespace sim {

namespace {

/// Returns whether YAML readers may take the word as something else than text.
bool is_reserved(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  static const char* const words[] = {"true", "false", "yes", "no", "on", "off", "y", "n", "null", "nan", "inf"};
  return std::find(std::begin(words), std::end(words), text) != std::end(words);
}

/// Text in quotes, unless it is a plain word.
std::string quoted(const std::string& text) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::scalar;
  node.scalar = text;
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ' '; };
  const bool is_word = !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) &&
                       std::all_of(text.begin(), text.end(), in_word);
  node.quoted = !is_word || is_reserved(text);
  return to_flow_yaml(node);
}

/// Rounded to 12 digits: conversions between rad and deg do not add digits.
double rounded(double value) {
  return rounded_to(value, 12);
}

class MotionWriter {
 public:
  explicit MotionWriter(const JointMotion& motion) : motion_(motion) {}

  std::string text() {
    line("shoal: 1");
    line("motion: " + quoted(motion_.name));
    if (!motion_.description.empty()) line("description: " + quoted(motion_.description));
    if (!motion_.vehicle.empty()) line("vehicle: " + quoted(motion_.vehicle));
    line(motion_.angles == AngleUnit::deg ? "angles: deg" : "angles: rad");
    if (!motion_.sliders.empty()) line("sliders: " + list(motion_.sliders));
    if (!motion_.lights.empty()) line("lights: " + list(motion_.lights));
    if (motion_.ease != Easing::linear) line("ease: " + word(motion_.ease));
    if (motion_.loop) line("loop: true");
    line("frame_s: " + number_text(motion_.frame_s));
    line("start: {max_velocity: " + number_text(motion_.start.max_velocity) +
         ", min_s: " + number_text(motion_.start.min_s) + "}");
    write_poses();
    write_keys();
    if (!motion_.frames_file.empty()) line("frames: " + quoted(motion_.frames_file));
    write_rest();
    return std::move(text_);
  }

 private:
  void line(const std::string& text) { text_ += text + "\n"; }
  static std::string word(Easing ease) { return std::string(word_of(easing_words, ease)); }

  static std::string list(const std::vector<std::string>& texts) {
    std::string all;
    for (const std::string& one : texts) all += (all.empty() ? "" : ", ") + quoted(one);
    return "[" + all + "]";
  }

  std::string map(const JointValues& values) const {
    std::string all;
    for (const auto& [joint, value] : values) {
      const double unit = motion_.unit_of(joint);
      all += (all.empty() ? "" : ", ") + quoted(joint) + ": " + number_text(unit == 1 ? value : rounded(value / unit));
    }
    return "{" + all + "}";
  }

  void write_poses() {
    if (!motion_.poses.empty()) line("poses:");
    for (const MotionPose& pose : motion_.poses)
      line("  - {name: " + quoted(pose.name) + ", joints: " + map(pose.joints) + "}");
  }

  void write_keys() {
    if (!motion_.keys.empty()) line("keys:");
    for (const MotionKey& key : motion_.keys) {
      std::string text = "  - {at_s: " + number_text(key.at_s);
      if (!key.pose.empty()) text += ", pose: " + quoted(key.pose);
      if (!key.joints.empty()) text += ", joints: " + map(key.joints);
      if (key.ease) text += ", ease: " + word(*key.ease);
      if (!key.note.empty()) text += ", note: " + quoted(key.note);
      line(text + "}");
    }
  }

  void write_rest() {
    if (!motion_.sounds.empty()) line("sounds:");
    for (const MotionSound& sound : motion_.sounds)
      line("  - {at_s: " + number_text(sound.at_s) + ", sound: " + quoted(sound.sound) +
           (sound.volume == 1 ? "" : ", volume: " + number_text(sound.volume)) + "}");
    if (!motion_.changes.empty()) line("changes:");
    for (const MotionChange& change : motion_.changes)
      line("  - {at_s: " + number_text(change.at_s) + ", do: " + to_flow_yaml(change.action) + "}");
    if (!motion_.recorded) return;
    const MotionOrigin& from = *motion_.recorded;
    line("recorded:");
    line("  world: " + quoted(from.world));
    line("  vehicle: " + quoted(from.vehicle));
    line("  seed: " + std::to_string(from.seed));
    if (!from.set.empty()) line("  set: " + list(from.set));
    if (!from.state_hash.empty()) line("  state_hash: " + quoted(from.state_hash));
    if (from.embedded_world.kind == ConfigNode::Kind::null) return;
    line("  embedded_world:");
    std::istringstream world(to_yaml(from.embedded_world));
    for (std::string text; std::getline(world, text);) line("    " + text);
  }

  const JointMotion& motion_;
  std::string text_;
};

}  // namespace

std::string motion_text(const JointMotion& motion) {
  return MotionWriter(motion).text();
}

}  // namespace sim
