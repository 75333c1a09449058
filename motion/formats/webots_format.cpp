// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "experiment/files/line_reader.hpp"
#include "motion/formats/motion_format.hpp"
#include "motion/formats/pose_table.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"

// The player commands at each control step of h the poses at `elapsed`, linear between two lines, then adds h.  A loop
// goes back to 0 in the step after its end, so that it lasts h longer than the file.

namespace motion {

namespace {

constexpr std::size_t max_line = 4095;  // of the player, with its line feed
constexpr double ms_of_webots = 0.001;
constexpr double jump_s = 1e-6;

std::string name_of_pose(const std::string& note, std::size_t number) {
  std::string name;
  for (const char c : note)
    if (c != ',' && static_cast<unsigned char>(c) >= ' ') name += c;
  while (name.starts_with(' ')) name.erase(0, 1);
  while (name.ends_with(' ')) name.pop_back();
  return name.empty() ? "Pose" + std::to_string(number) : name;
}

/// Leaves out the last pose of a loop: the player goes from the one before it to the first one in a step.
void end_loop_early(const sim::JointMotion& motion, PoseTable& table, double step_s, Losses& losses) {
  const double steps = table.end_s() / step_s;
  if (std::abs(steps - std::round(steps)) > 1e-6 || steps < 1.5)
    refuse_motion(motion, "a loop must last two or more whole control steps of " + sim::number_text(step_s * 1000) +
                              " ms (--loop-step-ms), got " + sim::number_text(table.end_s()) + " s");
  const double last_s = (std::round(steps) - 1) * step_s;
  const std::vector<sim::MotionTrack> tracks = table.tracks();
  double seam = 0;
  for (std::size_t j = 0; j < tracks.size(); ++j)
    seam = std::max(seam, std::abs(table.rows.back()[j] - table.rows[0][j]));
  if (seam > 1e-6)
    losses.push_back("the last pose of the loop, up to " + sim::number_text(seam) +
                     " rad from the first one, is left out: the first one takes its place");
  while (table.end_s() > last_s - 1e-9) {
    table.times_s.pop_back();
    table.rows.pop_back();
    table.notes.pop_back();
  }
  std::vector<double>& row = table.rows.emplace_back();
  for (const sim::MotionTrack& track : tracks) row.push_back(track.value_at(last_s));
  table.times_s.push_back(last_s);
  table.notes.emplace_back();
}

std::string write_webots(const sim::JointMotion& motion, const JointNames& names, const FormatOptions& options,
                         Losses& losses) {
  const bool closes = motion.loop && options.loop_step_s > 0;
  list_losses(motion, {.notes = true, .loop = closes}, losses);
  TableRules rules{.tick_s = ms_of_webots, .keeps_notes = true};
  PoseTable table = pose_table(motion, names, webots_format(), rules, losses);
  if (closes) end_loop_early(motion, table, options.loop_step_s, losses);
  // Head.
  std::string text = "#WEBOTS_MOTION,V1.0";
  for (const TableJoint& joint : table.joints) {
    if (joint.foreign.empty() || joint.foreign.find_first_of(",\r\n") != std::string::npos)
      refuse_motion(motion, "joint '" + joint.foreign + "' must have no comma in a .motion file");
    text += "," + joint.foreign;
  }
  if (text.size() >= max_line)
    refuse_motion(motion, "a line of a .motion file has at most 4094 bytes: too many joints");
  text += "\n";
  // Poses.
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto time_ms = static_cast<long long>(std::llround(table.times_s[i] / ms_of_webots));
    std::string line = fmt::format("{:02}:{:02}:{:03},{}", time_ms / 60000, time_ms / 1000 % 60, time_ms % 1000,
                                   sim::shortened(name_of_pose(table.notes[i], i + 1), 200));
    for (const double value : table.rows[i]) line += fmt::format(",{:.6f}", value);
    if (line.size() >= max_line)
      refuse_motion(motion, "a line of a .motion file has at most 4094 bytes: too many joints");
    text += line + "\n";
  }
  return text;
}

/// Reader of a file.
class WebotsReader {
 public:
  WebotsReader(const MotionSource& source, Losses& losses)
      : source_(source), losses_(losses), lines_(source.bytes, source.file) {}

  sim::JointMotion read() {
    read_head();
    while (next_pose()) read_pose();
    if (times_s_.empty()) lines_.fail(1, "needs a line with a pose after the names of devices");
    if (lines_.line().empty() && lines_.next())
      losses_.push_back("line " + std::to_string(lines_.number()) +
                        " and all after it are not read: an empty line ends a .motion file");
    return to_motion();
  }

 private:
  struct Cell {
    bool is_driven = false;
    double value = 0;
  };

  void check_length() const {
    if (lines_.line().size() >= max_line)
      lines_.fail(static_cast<int>(max_line), "a line must have at most 4094 bytes");
  }

  void read_head() {
    if (!lines_.next()) lines_.fail(1, "must start with '#WEBOTS_MOTION,V1.0'");
    check_length();
    const std::vector<experiment::Word> words = lines_.split_at_commas();
    if (words[0].text != "#WEBOTS_MOTION") lines_.fail(words[0], "must start with '#WEBOTS_MOTION'");
    if (words.size() < 2) lines_.fail(1, "needs the version 'V1.0'");
    if (words[1].text != "V1.0") lines_.fail(words[1], "the version must be 'V1.0'");
    if (words.size() < 3) lines_.fail(1, "needs the name of a device");
    if (words.size() - 2 > sim::max_motion_joints) lines_.fail(1, "must have at most 200 devices");
    std::set<std::string> known;
    for (std::size_t i = 2; i < words.size(); ++i) {
      // The player skips an empty name, and so moves all others.
      if (words[i].text.empty()) lines_.fail(words[i].column, "needs the name of a device");
      joints_.push_back(joint_called(source_, "webots", std::string(words[i].text), lines_.place(words[i].column)));
      if (!known.insert(joints_.back()).second) lines_.fail(words[i], "names a device twice");
    }
  }

  bool next_pose() { return lines_.next() && !lines_.line().empty(); }

  double time_of(const experiment::Word& word) const {
    std::size_t begin = 0;
    std::vector<std::int64_t> parts;
    for (;;) {
      const std::size_t end = std::min(word.text.find(':', begin), word.text.size());
      const std::string_view part = word.text.substr(begin, end - begin);
      const bool is_number =
          !part.empty() && part.size() <= 9 && part.find_first_not_of("0123456789") == std::string_view::npos;
      if (!is_number || parts.size() == 3) lines_.fail(word, "the time must be [[minutes:]seconds:]milliseconds");
      parts.push_back(std::stoll(std::string(part)));
      if (end == word.text.size()) break;
      begin = end + 1;
    }
    std::int64_t time_ms = parts.back();
    if (parts.size() > 1) time_ms += 1000 * parts[parts.size() - 2];
    if (parts.size() > 2) time_ms += 60000 * parts[0];
    const double time_s = static_cast<double>(time_ms) / 1000;
    if (time_s > sim::max_motion_s) lines_.fail(word, "the time must be at most 86400 s");
    return time_s;
  }

  void read_pose() {
    check_length();
    const std::vector<experiment::Word> words = lines_.split_at_commas();
    const double time_s = time_of(words[0]);
    if (!times_s_.empty() && time_s <= times_s_.back()) lines_.fail(words[0], "times must increase");
    if (words.size() < 2 || words[1].text.empty())
      lines_.fail(words[std::min(words.size() - 1, std::size_t{1})].column, "needs the name of the pose");
    if (words.size() != joints_.size() + 2)
      lines_.fail(1, "must have a time, a name and " + std::to_string(joints_.size()) + " values, got " +
                         std::to_string(words.size()) + " words");
    if (times_s_.size() == sim::max_motion_keys) lines_.fail(1, "must have at most 1000000 poses");
    times_s_.push_back(time_s);
    names_.push_back(sim::in_utf8(words[1].text));
    if (names_.back() != words[1].text) ++escaped_names_;
    std::vector<Cell>& row = cells_.emplace_back();
    for (std::size_t i = 2; i < words.size(); ++i) {
      Cell& cell = row.emplace_back();
      // '*' leaves the device to other controllers.
      cell.is_driven = words[i].text != "*";
      if (cell.is_driven) cell.value = lines_.number_of(words[i], -1e6, 1e6, "a position");
    }
  }

  /// A joint without a position in a pose holds its last one, and jumps to the next.
  sim::JointMotion to_motion() {
    sim::JointMotion motion;
    motion.angles = sim::AngleUnit::rad;
    std::vector<std::optional<double>> held(joints_.size());
    std::vector<bool> has_gap(joints_.size());
    for (std::size_t i = 0; i < times_s_.size(); ++i) {
      sim::JointValues values, before_jump;
      for (std::size_t j = 0; j < joints_.size(); ++j) {
        const Cell& cell = cells_[i][j];
        if (cell.is_driven && held[j] && !cells_[i - 1][j].is_driven) before_jump.emplace_back(joints_[j], *held[j]);
        if (cell.is_driven) held[j] = cell.value;
        has_gap[j] = has_gap[j] || !cell.is_driven;
        if (held[j]) values.emplace_back(joints_[j], *held[j]);
      }
      if (!before_jump.empty()) add_key(motion, times_s_[i] - jump_s, std::move(before_jump), "");
      const bool has_own_name = names_[i] != "Pose" + std::to_string(i + 1);
      if (!values.empty()) add_key(motion, times_s_[i], std::move(values), has_own_name ? names_[i] : "");
    }
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      if (!held[j])
        losses_.push_back("joint '" + joints_[j] + "' has no position: left out");
      else if (has_gap[j])
        losses_.push_back("joint '" + joints_[j] + "' holds its position where the file has '*'");
    }
    if (motion.keys.empty()) throw sim::ConfigError({source_.file + ": no device has a position"});
    if (escaped_names_ > 0)
      losses_.push_back("names of poses with bytes that are not UTF-8, which become '\\xe9': " +
                        std::to_string(escaped_names_));
    return motion;
  }

  static void add_key(sim::JointMotion& motion, double at_s, sim::JointValues values, const std::string& note) {
    sim::MotionKey& key = motion.keys.emplace_back();
    key.at_s = at_s;
    key.joints = std::move(values);
    key.note = note;
  }

  const MotionSource& source_;
  Losses& losses_;
  experiment::LineReader lines_;
  std::vector<std::string> joints_;
  std::vector<double> times_s_;
  std::vector<std::string> names_;
  std::size_t escaped_names_ = 0;
  std::vector<std::vector<Cell>> cells_;
};

sim::JointMotion read_webots(const MotionSource& source, Losses& losses) {
  return WebotsReader(source, losses).read();
}

}  // namespace

MotionFormat webots_format() {
  return {.name = "webots",
          .meaning = "motion file of Webots",
          .endings = {".motion"},
          .head = "#WEBOTS_MOTION",
          .list = "webots",
          .uses_aliases = true,
          .write = write_webots,
          .read = read_webots};
}

}  // namespace motion
