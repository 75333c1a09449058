// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/skill_array.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include "experiment/files/line_reader.hpp"
#include "sim/config/message_text.hpp"

namespace motion {

namespace {

constexpr std::size_t max_bytes = 16'000'000;
constexpr std::size_t max_numbers = 7 + 128 * 20;
constexpr int behavior_columns = skill_joints + 4;

struct Number {
  int value = 0;
  experiment::Word word;
  int line = 1;
};

/// Array as written.
struct NumberList {
  std::string name;
  int line = 1, column = 1;
  std::vector<Number> numbers;
};

/// Reader of the arrays in a C text, or of numbers alone.
class ArrayReader {
 public:
  ArrayReader(std::string_view text, const std::string& file)
      : lines_(text, file), has_braces_(text.find('{') != std::string_view::npos) {}

  std::vector<NumberList> read() {
    if (!has_braces_) lists_.emplace_back();
    while (lines_.next()) read_line();
    if (has_braces_ && is_inside_) lines_.fail(1, "the array must end with '}'");
    return std::move(lists_);
  }

 private:
  bool takes_numbers() const { return is_inside_ || !has_braces_; }

  void read_line() {
    const std::string_view line = lines_.line();
    if (line.starts_with('#') && !is_remark_) return;
    for (std::size_t i = 0; i < line.size();) i = read_token(line, i);
  }

  /// Reads what starts at this byte; returns where it ends.
  std::size_t read_token(std::string_view line, std::size_t i) {
    const char c = line[i];
    const std::string_view rest = line.substr(i);
    if (is_remark_) {
      const std::size_t end = rest.find("*/");
      is_remark_ = end == std::string_view::npos;
      return is_remark_ ? line.size() : i + end + 2;
    }
    if (rest.starts_with("//")) return line.size();
    if (rest.starts_with("/*")) return is_remark_ = true, i + 2;
    if (std::isspace(static_cast<unsigned char>(c))) return i + 1;
    if (is_other_list_) return is_other_list_ = c != '}', i + 1;
    if (c == '{') return begin_list(i);
    if (c == '}') return end_list(i);
    if (std::isalpha(static_cast<unsigned char>(c)) || c == '_') return read_name(line, i);
    if (!takes_numbers()) return read_declaration(c), i + 1;
    if (c == ',' || ((c == '[' || c == ']') && !has_braces_)) return i + 1;
    return read_number(line, i);
  }

  std::size_t begin_list(std::size_t i) {
    const experiment::Word word{"{", static_cast<int>(i) + 1};
    if (is_inside_) lines_.fail(word, "must be a number");
    if (type_ == Type::other) return is_other_list_ = true, i + 1;
    is_inside_ = true;
    lists_.push_back({name_, lines_.number(), word.column, {}});
    return i + 1;
  }

  std::size_t end_list(std::size_t i) {
    if (!is_inside_) lines_.fail(static_cast<int>(i) + 1, "'}' must follow '{'");
    is_inside_ = false;
    name_.clear();
    type_ = Type::unknown;
    return i + 1;
  }

  std::size_t read_name(std::string_view line, std::size_t i) {
    std::size_t end = i;
    while (end < line.size() && (std::isalnum(static_cast<unsigned char>(line[end])) || line[end] == '_')) ++end;
    const experiment::Word word{line.substr(i, end - i), static_cast<int>(i) + 1};
    if (takes_numbers()) lines_.fail(word, "must be a number");
    if (end < line.size() && line[end] == '[') name_ = word.text;
    // Lists of names and of pointers may stand beside the skills.
    if (word.text == "int8_t" || word.text == "char") type_ = Type::skill;
    if (type_ == Type::unknown) type_ = Type::other;
    return end;
  }

  void read_declaration(char c) {
    if (c == ';') type_ = Type::unknown;
    if (c == '*' && type_ == Type::skill) type_ = Type::other;
  }

  std::size_t read_number(std::string_view line, std::size_t i) {
    std::size_t end = i;
    while (end < line.size() && line[end] != ',' && line[end] != '}' && line[end] != ']' && line[end] != '/' &&
           !std::isspace(static_cast<unsigned char>(line[end])))
      ++end;
    const experiment::Word word{line.substr(i, std::max(end - i, std::size_t{1})), static_cast<int>(i) + 1};
    // Values of the array are int8_t in C.
    const auto value = static_cast<int>(lines_.whole_of(word, -128, 127, "a number of a skill"));
    std::vector<Number>& numbers = lists_.back().numbers;
    if (numbers.size() == max_numbers) lines_.fail(word, "a skill must have at most 128 rows");
    numbers.push_back({value, word, lines_.number()});
    return end;
  }

  experiment::LineReader lines_;
  bool has_braces_;
  bool is_inside_ = false, is_remark_ = false;
  bool is_other_list_ = false;                                      ///< in braces of something else than a skill
  enum class Type { unknown, skill, other } type_ = Type::unknown;  ///< of the declaration
  std::string name_;
  std::vector<NumberList> lists_;
};

/// Converts numbers to a skill.
class SkillReader {
 public:
  SkillReader(const NumberList& list, const std::string& file) : list_(list), file_(sim::intern_file_name(file)) {}

  SkillArray read() {
    SkillArray skill;
    skill.name = list_.name;
    skill.period = at(0, "the number of rows");
    if (skill.period == 0) fail(0, "the number of rows must not be 0");
    skill.roll_deg = at(1, "the roll");
    skill.pitch_deg = at(2, "the pitch");
    ratio_ = at(3, "the ratio of angles");
    if (ratio_ != 1 && ratio_ != 2) fail(3, "the ratio of angles must be 1 or 2, got " + std::to_string(ratio_));
    // The number of rows tells the kind: 1 is a posture, more is a gait, and a negative number a behavior, whose head
    // also has a loop.
    const int rows = std::abs(skill.period);
    if (skill.period < 0) read_loop(skill, rows);
    const std::size_t head = skill.period < 0 ? 7 : 4;
    const std::size_t columns = columns_of(skill.period, list_.numbers.size() - std::min(head, list_.numbers.size()));
    const std::size_t needed = head + static_cast<std::size_t>(rows) * columns;
    if (list_.numbers.size() != needed)
      fail(std::min(needed, list_.numbers.size()), std::to_string(rows) + " rows need " + std::to_string(needed) +
                                                       " numbers, got " + std::to_string(list_.numbers.size()));
    skill.first_joint = skill.period > 1 ? skill_joints - static_cast<int>(columns) : 0;
    for (std::size_t i = head; i < needed; i += columns) read_row(skill, i, columns);
    return skill;
  }

 private:
  [[noreturn]] void fail(std::size_t i, const std::string& text) const {
    const bool has = i < list_.numbers.size();
    const int line = has ? list_.numbers[i].line : list_.line,
              column = has ? list_.numbers[i].word.column : list_.column;
    sim::throw_config_error({file_, line, column}, list_.name.empty() ? "" : "skill '" + list_.name + "'", text);
  }

  int at(std::size_t i, const char* what) const {
    if (i >= list_.numbers.size()) fail(i, std::string("ends before ") + what);
    return list_.numbers[i].value;
  }

  void read_loop(SkillArray& skill, int rows) const {
    skill.loop_first = at(4, "the first row of the loop");
    skill.loop_last = at(5, "the last row of the loop");
    skill.loop_count = at(6, "the number of repetitions");
    for (const auto& [i, row] : {std::pair{4, skill.loop_first}, std::pair{5, skill.loop_last}})
      if (row < 0 || row >= rows)
        fail(static_cast<std::size_t>(i),
             "a row of the loop must be from 0 to " + std::to_string(rows - 1) + ", got " + std::to_string(row));
    if (skill.loop_first > skill.loop_last) fail(4, "the first row of the loop must not be after its last one");
  }

  /// A gait has the 8 or 12 last joints.
  static std::size_t columns_of(int period, std::size_t numbers) {
    if (period < 0) return behavior_columns;
    if (period == 1) return skill_joints;
    constexpr std::size_t of_legs = 8, with_shoulders = 12;
    return numbers == static_cast<std::size_t>(period) * with_shoulders ? with_shoulders : of_legs;
  }

  void read_row(SkillArray& skill, std::size_t begin, std::size_t columns) const {
    SkillRow& row = skill.rows.emplace_back();
    const std::size_t angles = std::min<std::size_t>(columns, skill_joints);
    for (std::size_t j = 0; j < angles; ++j)
      row.angles_deg[static_cast<std::size_t>(skill.first_joint) + j] = list_.numbers[begin + j].value * ratio_;
    if (columns != behavior_columns) return;
    row.speed = std::max(0, list_.numbers[begin + skill_joints].value);
    row.delay = std::abs(list_.numbers[begin + skill_joints + 1].value);
    row.trigger_axis = list_.numbers[begin + skill_joints + 2].value;
    row.trigger_angle_deg = list_.numbers[begin + skill_joints + 3].value;
  }

  const NumberList& list_;
  const std::string* file_;
  int ratio_ = 1;
};

}  // namespace

SkillArray parse_skill(std::string_view text, const std::string& file, const std::string& name) {
  const sim::SourcePlace place{sim::intern_file_name(file), 0, 0};
  if (text.size() > max_bytes) sim::throw_config_error(place, "", "the file must have at most 16 MB");
  const std::vector<NumberList> lists = ArrayReader(text, file).read();
  std::vector<std::string> known;
  const NumberList* chosen = nullptr;
  for (const NumberList& list : lists) {
    known.push_back(list.name);
    if (list.name == name || (name.empty() && lists.size() == 1)) chosen = &list;
  }
  if (chosen == nullptr && name.empty())
    sim::throw_config_error(place, "", "has several skills: choose one (--name) of " + sim::list_text(known));
  if (chosen == nullptr)
    sim::throw_config_error(place, "",
                            "there is no skill '" + sim::shortened(sim::printable(name)) + "'" +
                                sim::did_you_mean(name, known) + "; known: " + sim::list_text(known));
  return SkillReader(*chosen, file).read();
}

std::string skill_text(const SkillArray& skill) {
  int largest = 0;
  for (const SkillRow& row : skill.rows)
    for (const int angle : row.angles_deg) largest = std::max(largest, std::abs(angle));
  // Numbers of an array are int8_t, so larger angles are halved.
  const int ratio = largest > 127 ? 2 : 1;
  const char* const kind = skill.period == 1 ? "posture" : skill.period > 1 ? "gait" : "behavior";
  std::string text = "// " + std::string(kind) + " of OpenCat, " + std::to_string(std::abs(skill.period)) +
                     (std::abs(skill.period) == 1 ? " row" : " rows") + "\nconst int8_t " + skill.name +
                     "[] PROGMEM = {\n  " + std::to_string(skill.period) + ", " + std::to_string(skill.roll_deg) +
                     ", " + std::to_string(skill.pitch_deg) + ", " + std::to_string(ratio) + ",\n";
  if (skill.period < 0)
    text += "  " + std::to_string(skill.loop_first) + ", " + std::to_string(skill.loop_last) + ", " +
            std::to_string(skill.loop_count) + ",\n";
  for (const SkillRow& row : skill.rows) {
    text += "  ";
    for (std::size_t j = static_cast<std::size_t>(skill.first_joint); j < skill_joints; ++j) {
      const int angle = row.angles_deg[j];
      text += std::to_string(ratio == 1 ? angle : static_cast<int>(std::lround(angle / 2.0))) + ", ";
    }
    if (skill.period < 0)
      for (const int number : {row.speed, row.delay, row.trigger_axis, row.trigger_angle_deg})
        text += std::to_string(number) + ", ";
    text.back() = '\n';
  }
  return text + "};\n";
}

}  // namespace motion
