// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/tekkotsu_outputs.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "motion/formats/motion_format.hpp"
#include "sim/config/message_text.hpp"

namespace motion {

namespace {

constexpr std::int64_t max_ms = static_cast<std::int64_t>(sim::max_motion_s) * 1000;
constexpr int max_depth = 4;
constexpr std::int64_t first_ms = 1;  // of Tekkotsu while it reads keys
constexpr double rad_of_degree = std::numbers::pi / 180;

bool is_word(const experiment::Word& word, std::initializer_list<std::string_view> names) {
  std::string lower;
  for (const char c : word.text) lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return std::find(names.begin(), names.end(), lower) != names.end();
}

/// Reader of one file.
class TekkotsuReader {
 public:
  TekkotsuReader(const MotionSource& source, std::int64_t start_ms, int depth, TekkotsuOutputs& outputs,
                 TekkotsuKeys& keys, Losses& losses)
      : source_(source),
        lines_(source.bytes, source.file),
        start_ms_(start_ms),
        depth_(depth),
        outputs_(outputs),
        keys_(keys),
        losses_(losses) {}

  std::int64_t read() {
    if (!lines_.next()) lines_.fail(1, "must start with '#MSq' or '#POS'");
    is_posture_ = lines_.line().starts_with("#POS");
    if (!is_posture_ && !lines_.line().starts_with("#MSq")) lines_.fail(1, "must start with '#MSq' or '#POS'");
    time_ms_ = is_posture_ ? 0 : first_ms;
    while (lines_.next()) {
      if (lines_.line().starts_with("#END")) return is_posture_ ? 0 : end_ms_;
      const std::vector<experiment::Word> words = words_of_line();
      if (!words.empty()) read_line(words);
    }
    lines_.fail(1, "must end with the line '#END'");
  }

 private:
  std::vector<experiment::Word> words_of_line() const {
    std::vector<experiment::Word> words = lines_.split_at_spaces();
    const auto remark = std::find_if(words.begin(), words.end(),
                                     [](const experiment::Word& word) { return word.text.starts_with('#'); });
    words.erase(remark, words.end());
    if (is_posture_) std::erase_if(words, [](const experiment::Word& word) { return word.text == "="; });
    return words;
  }

  void read_line(const std::vector<experiment::Word>& words) {
    for (std::size_t i = 0; i < words.size(); ++i)
      if (words[i].text.size() > (i == 0 ? max_tekkotsu_name : max_tekkotsu_word))
        lines_.fail(words[i], "a word must have at most " +
                                  std::to_string(i == 0 ? max_tekkotsu_name : max_tekkotsu_word) + " bytes");
    if (is_posture_ ? read_section(words) : read_command(words)) return;
    read_value(words);
  }

  /// Parts of a posture that are not outputs.
  bool read_section(const std::vector<experiment::Word>& words) {
    const std::string_view first = words[0].text;
    if (first.starts_with('<') && first.ends_with('>')) {
      const bool ends = first.starts_with("</");
      is_other_section_ = !ends && first != "<outputs>";
      return true;
    }
    if (is_word(words[0], {"condensed", "specialize"}))
      lines_.fail(words[0], "postures for a single robot model are not supported: must be a name of an output");
    return is_other_section_ || first == "verbose";
  }

  bool read_command(const std::vector<experiment::Word>& words) {
    const experiment::Word& first = words[0];
    if (is_word(first, {"radians"})) return unit_ = 1, true;
    if (is_word(first, {"degrees"})) return unit_ = rad_of_degree, true;
    if (is_word(first, {"advancetime", "delay"}))
      return time_ms_ += time_of(words, max_ms - start_ms_ - time_ms_), true;
    if (is_word(first, {"settime"})) return time_ms_ = time_of(words, max_ms - start_ms_), true;
    if (!is_word(first, {"load", "overlay", "loadexplicit"})) return false;
    read_other_file(words);
    return true;
  }

  std::int64_t time_of(const std::vector<experiment::Word>& words, std::int64_t max) const {
    if (words.size() != 2) lines_.fail(words[0].column, "must have a command and a time in ms");
    return lines_.whole_of(words[1], 0, std::max<std::int64_t>(max, 0), "the time in ms");
  }

  void read_other_file(const std::vector<experiment::Word>& words) {
    if (words.size() != 2) lines_.fail(words[0].column, "must have a command and a file");
    const std::string name(words[1].text);
    if (!source_.read_other) lines_.fail(words[1], "other files cannot be loaded here");
    // A file that loads itself would not end.
    if (depth_ >= max_depth) lines_.fail(words[1], "files must load each other at most 4 deep");
    // A motion may come from someone else: it reads no file outside of its folder.
    if (name.starts_with('/') || name.find("..") != std::string::npos)
      lines_.fail(words[1], "the file must be in the folder of this one");
    std::string bytes;
    try {
      bytes = source_.read_other(name);
    } catch (const std::runtime_error& error) {
      lines_.fail(words[1].column, "file " + experiment::text_in_quotes(name) + " " + error.what());
    }
    const MotionSource other{bytes, name, source_.names, source_.options, source_.read_other};
    time_ms_ += read_tekkotsu(other, start_ms_ + time_ms_, depth_ + 1, outputs_, keys_, losses_);
    end_ms_ = std::max(end_ms_, time_ms_);
  }

  void read_value(const std::vector<experiment::Word>& words) {
    if (words.size() < 2)
      lines_.fail(words[0].column, "needs a value after the name " + experiment::text_in_quotes(words[0].text));
    if (words.size() > 3) lines_.fail(words[3], "must end after name, value and weight");
    TekkotsuValue value;
    value.value = lines_.number_of(words[1], -1e6, 1e6, "the value") * unit_;
    if (words.size() > 2) value.weight = lines_.number_of(words[2], 0, 1e6, "the weight");
    if (value.weight > 0 && value.weight != 1 && !has_weights_) {
      has_weights_ = true;
      losses_.push_back("weights other than 0 and 1 are not kept, such as in line " + std::to_string(lines_.number()));
    }
    for (const std::string& joint : outputs_.joints_of(lines_, words[0])) {
      if (keys_.size == sim::max_motion_keys) lines_.fail(1, "must have at most 1000000 values");
      keys_.set(joint, start_ms_ + time_ms_, value);
      if (keys_.order.size() > sim::max_motion_joints) lines_.fail(1, "must have at most 200 outputs");
    }
    end_ms_ = std::max(end_ms_, time_ms_);
  }

  const MotionSource& source_;
  experiment::LineReader lines_;
  std::int64_t start_ms_;                  ///< of this file in the first one
  std::int64_t time_ms_ = 0, end_ms_ = 0;  ///< from its start
  int depth_;
  TekkotsuOutputs& outputs_;
  TekkotsuKeys& keys_;
  Losses& losses_;
  bool is_posture_ = false, is_other_section_ = false, has_weights_ = false;
  double unit_ = 1;
};

}  // namespace

void TekkotsuKeys::set(const std::string& joint, std::int64_t time_ms, const TekkotsuValue& value) {
  const auto [place, is_new] = by_joint.try_emplace(joint);
  if (is_new) order.push_back(joint);
  place->second[time_ms] = value;
  ++size;
}

std::vector<std::string> TekkotsuOutputs::matches(const std::string& name) const {
  std::vector<std::string> found;
  for (std::string known : source_.names.foreign_names("tekkotsu")) {
    while (known.ends_with('~')) known.pop_back();
    if (known == name) return {known};
    if (!name.empty() && known.starts_with(name)) found.push_back(known);
  }
  return found;
}

std::vector<std::string> TekkotsuOutputs::joints_of(const experiment::LineReader& lines, const experiment::Word& word) {
  std::string name(word.text);
  // Tekkotsu ignores '~' at the end of a name.
  while (name.ends_with('~')) name.pop_back();
  if (name.empty()) lines.fail(word, "must be the name of an output");
  check_joint_name(name, lines.place(word.column));
  if (source_.names.empty()) return {name};
  std::vector<std::string> found = matches(name);
  if (found.empty()) {
    // A name without a side means both sides.
    const std::vector<std::string> left = matches("L" + name), right = matches("R" + name);
    if (left.size() == 1 && right.size() == 1) found = {left[0], right[0]};
  } else if (found.size() > 1) {
    lines.fail(word, "must name one output, and may mean " + sim::list_text(found));
  }
  std::vector<std::string> joints;
  for (const std::string& one : found)
    if (const auto joint = source_.names.joint_of("tekkotsu", one); joint && source_.names.find(*joint) != nullptr)
      joints.push_back(*joint);
  if (joints.empty() && std::find(unknown_.begin(), unknown_.end(), name) == unknown_.end() && unknown_.size() < 1000)
    unknown_.push_back(name);
  return joints;
}

void TekkotsuOutputs::list_unknown() {
  if (unknown_.empty()) return;
  std::vector<std::string> names;
  for (const std::string& name : unknown_) names.push_back(sim::shortened(sim::printable(name)));
  losses_.push_back("outputs that vehicle '" + source_.names.vehicle() +
                    "' does not have are left out: " + sim::list_text(names));
}

std::int64_t read_tekkotsu(const MotionSource& source, std::int64_t start_ms, int depth, TekkotsuOutputs& outputs,
                           TekkotsuKeys& keys, Losses& losses) {
  return TekkotsuReader(source, start_ms, depth, outputs, keys, losses).read();
}

}  // namespace motion
