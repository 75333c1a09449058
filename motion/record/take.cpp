// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/take.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "motion/analysis/motion_edit.hpp"
#include "sim/base/number.hpp"
#include "sim/base/whole_file.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"
#include "sim/motion/motion.hpp"

namespace motion {

namespace {

constexpr double max_value = 1e6;

std::string quoted(const std::string& text) {
  sim::ConfigNode node;
  node.kind = sim::ConfigNode::Kind::scalar;
  node.scalar = text;
  node.quoted = true;
  return sim::to_flow_yaml(node);
}

std::string list(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& one : texts) all += (all.empty() ? "" : ", ") + quoted(one);
  return "[" + all + "]";
}

class TakeParser {
 public:
  TakeParser(std::string_view text, std::string file_name) : text_(text), file_name_(std::move(file_name)) {}

  Take parse(std::optional<TakeDamage>* damage) {
    std::string_view line;
    if (!next(line) || line != take_head.substr(0, take_head.size() - 1))
      fail("must start with the line 'shoal recording 1'");
    if (!next(line)) fail("needs a line of settings");
    read_settings(line);
    while (next(line)) {
      const std::size_t frames = take_.frame_count();
      try {
        read_line(line);
      } catch (const sim::ConfigError& error) {
        // A journal whose program was killed ends in the middle of a line. What comes before it is recovered, with
        // the same number of frames for each joint.
        if (damage == nullptr || frames == 0) throw;
        for (std::vector<double>& values : take_.frames) values.resize(frames);
        const auto left = std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_), text_.end(), '\n');
        *damage = {error.lines().front(), static_cast<std::size_t>(left) + 1};
        break;
      }
    }
    if (take_.frame_count() == 0) fail("has no frame");
    return std::move(take_);
  }

 private:
  /// Takes the next whole line.
  bool next(std::string_view& line) {
    const std::size_t end = text_.find('\n', at_);
    ++number_;
    if (end == std::string_view::npos) return false;
    line = text_.substr(at_, end - at_);
    at_ = end + 1;
    return true;
  }

  [[noreturn]] void fail(const std::string& text) const {
    throw sim::ConfigError({file_name_ + ":" + std::to_string(number_) + ": " + text});
  }

  double number(std::string_view text, double low, double high, const char* what) const {
    const auto value = sim::exact_number<double>(text);
    if (!value || !(*value >= low && *value <= high))
      fail(std::string(what) + " must be a number from " + sim::number_text(low) + " to " + sim::number_text(high) +
           ", got '" + sim::shortened(sim::printable(sim::in_utf8(text))) + "'");
    return *value;
  }

  std::size_t whole(std::string_view text, std::size_t end, const char* what) const {
    const auto value = sim::exact_number<std::size_t>(text);
    if (!value || *value >= end)
      fail(std::string(what) + " must be a whole number from 0 to " + std::to_string(end - 1) + ", got '" +
           sim::shortened(sim::printable(sim::in_utf8(text))) + "'");
    return *value;
  }

  sim::ConfigNode yaml(std::string_view text) const {
    sim::Diagnostics diagnostics;
    sim::ConfigNode node = sim::parse_config_text(std::string(text), place(), diagnostics);
    diagnostics.throw_if_any();
    return node;
  }
  std::string place() const { return file_name_ + ":" + std::to_string(number_); }

  void read_settings(std::string_view line) {
    const sim::ConfigNode node = yaml(line);
    sim::Diagnostics diagnostics;
    sim::ParamReader in(node, "", diagnostics);
    take_.settings.read(in);
    in.finish();
    diagnostics.throw_if_any();
    take_.frames.resize(take_.settings.joints.size());
  }

  void read_line(std::string_view line) {
    if (line == "f" || line.starts_with("f ")) return read_frame(line.substr(1));
    if (line.starts_with("c ")) return read_change(line.substr(2));
    if (!line.starts_with("b ")) fail("must be a frame, a change or a return: 'f', 'c' or 'b'");
    if (take_.frame_count() == 0) fail("a return must come after a frame");
    const std::size_t frame = whole(line.substr(2), take_.frame_count(), "the frame");
    for (std::vector<double>& values : take_.frames) values.resize(frame + 1);
    const double at_s = static_cast<double>(frame) * take_.settings.frame_s;
    std::erase_if(take_.changes, [&](const TakeChange& one) { return one.at_s > at_s + 1e-9; });
  }

  void read_frame(std::string_view rest) {
    if (take_.frame_count() >= max_take_frames(take_.frames.size()))
      fail("must have at most " + std::to_string(max_take_frames(take_.frames.size())) + " frames");
    const bool is_first = take_.frame_count() == 0;
    // A line holds only what changed.
    for (std::vector<double>& values : take_.frames) values.push_back(is_first ? std::nan("") : values.back());
    while (!rest.empty()) {
      rest.remove_prefix(1);
      const std::string_view cell = rest.substr(0, rest.find(' '));
      rest.remove_prefix(cell.size());
      const std::size_t equals = cell.find('=');
      if (equals == std::string_view::npos) fail("must have values as JOINT=VALUE");
      const std::size_t joint = whole(cell.substr(0, equals), take_.frames.size(), "the number of a joint");
      take_.frames[joint].back() = number(cell.substr(equals + 1), -max_value, max_value, "a value");
    }
    for (const std::vector<double>& values : take_.frames)
      if (std::isnan(values.back())) fail("the first frame needs a value of each joint");
  }

  void read_change(std::string_view rest) {
    const std::size_t space = rest.find(' ');
    if (space == std::string_view::npos) fail("a change needs a time and an action");
    const double at_s = number(rest.substr(0, space), 0, sim::max_motion_s, "the time of a change");
    if (take_.changes.size() == max_take_changes)
      fail("must have at most " + std::to_string(max_take_changes) + " changes");
    take_.changes.push_back({at_s, yaml(rest.substr(space + 1))});
  }

  std::string_view text_;
  std::string file_name_;
  std::size_t at_ = 0;
  int number_ = 0;
  Take take_;
};

}  // namespace

void TakeSettings::read(sim::ParamReader& in) {
  in.read("world", world, "name of the world");
  in.read("vehicle", vehicle, "name of the vehicle in the world");
  in.read("model", model, "name of the vehicle model");
  // 2^53: YAML numbers pass through a double.
  in.read("seed", seed, sim::between(0, 9007199254740992.0), "seed of the run");
  in.read("set", set, "changes of the world, as with --set");
  in.read("frame_s", frame_s, sim::between(0.001, 1), "duration of a frame");
  in.require("joints");
  in.read("joints", joints, "joints that are recorded");
  in.read("sliders", sliders, "joints whose values are in m");
  in.read("over", over, "it is recorded over the motion that the file has");
  in.read("from_s", from_s, sim::between(0, sim::max_motion_s), "start of the part that is recorded");
  in.read("to_s", to_s, sim::between(0, sim::max_motion_s), "end of the part that is recorded");
  if (in.describing()) return;
  if (joints.size() > sim::max_motion_joints)
    in.error("joints", "'joints' must name at most " + std::to_string(sim::max_motion_joints) + " joints");
  if (in.has("joints") && joints.empty()) in.error("joints", "'joints' must name a joint");
  std::set<std::string> known;
  for (const std::string& joint : joints) {
    if (const std::string error = sim::joint_name_error(joint); !error.empty()) in.error("joints", error);
    if (!known.insert(joint).second)
      in.error("joints", "'joints' names joint '" + sim::shortened(sim::printable(joint)) + "' twice");
  }
}

std::string TakeSettings::text() const {
  std::string text = "{world: " + quoted(world) + ", vehicle: " + quoted(vehicle) + ", model: " + quoted(model) +
                     ", seed: " + std::to_string(seed) + ", set: " + list(set) +
                     ", frame_s: " + sim::number_text(frame_s) + ", joints: " + list(joints) +
                     ", sliders: " + list(sliders) + ", over: " + (over ? "true" : "false");
  if (from_s) text += ", from_s: " + sim::number_text(*from_s);
  if (to_s) text += ", to_s: " + sim::number_text(*to_s);
  return text + "}";
}

std::size_t max_take_frames(std::size_t joints) {
  return std::min(sim::max_motion_keys, static_cast<std::size_t>(max_frame_values) / std::max<std::size_t>(joints, 1));
}

Take parse_take(std::string_view text, const std::string& file_name, std::optional<TakeDamage>* damage) {
  return TakeParser(text, file_name).parse(damage);
}

Take read_take(const std::string& path, std::optional<TakeDamage>* damage) {
  std::string text;
  try {
    text = sim::whole_file<std::runtime_error>(path);
  } catch (const std::runtime_error& error) {
    throw sim::ConfigError({path + ": " + error.what()});
  }
  return parse_take(text, path, damage);
}

}  // namespace motion
