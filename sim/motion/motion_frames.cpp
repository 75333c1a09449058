// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/motion_frames.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "sim/base/number.hpp"
#include "sim/base/whole_file.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"
#include "sim/motion/motion.hpp"

namespace sim {

namespace {

constexpr std::uintmax_t max_frames_mb = 200;

/// Cell of a line, without spaces around it, and its column.
struct Cell {
  std::string_view text;
  int column;
};

std::vector<Cell> cells_of(std::string_view line) {
  std::vector<Cell> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::string_view text = line.substr(begin, end - begin);
    int column = static_cast<int>(begin) + 1;
    while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1), ++column;
    while (text.ends_with(' ') || text.ends_with('\t')) text.remove_suffix(1);
    cells.push_back({text, column});
    if (end == line.size()) return cells;
    begin = end + 1;
  }
}

class FramesParser {
 public:
  FramesParser(std::string_view text, FramesError& error) : text_(text), error_(error) {}

  std::vector<MotionTrack> parse() {
    std::string_view line;
    bool good = next_line(line) ? read_head(line) : fail(1, "must start with the line 't_s,JOINT,...'");
    while (good && next_line(line)) good = read_frame(line);
    if (good && tracks_.front().keys.empty()) good = fail(1, "needs a line of values after the names of joints");
    return good ? std::move(tracks_) : std::vector<MotionTrack>{};
  }

 private:
  /// Takes the next line that is neither empty nor a remark.
  bool next_line(std::string_view& line) {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      line = text_.substr(at_, end - at_);
      at_ = end + 1;
      ++line_number_;
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (!line.empty() && line[0] != '#') return true;
    }
    return false;
  }

  bool fail(int column, std::string text) {
    error_ = {std::max(line_number_, 1), column, std::move(text)};
    return false;
  }

  bool read_head(std::string_view line) {
    const std::vector<Cell> cells = cells_of(line);
    if (cells.front().text != "t_s")
      return fail(cells.front().column,
                  "the first column must be 't_s', got '" + shortened(printable(cells.front().text)) + "'");
    if (cells.size() < 2) return fail(1, "needs the name of a joint after 't_s'");
    if (cells.size() > max_motion_joints + 1)
      return fail(1, "must have at most " + std::to_string(max_motion_joints) + " joints");
    std::set<std::string_view> names;
    for (std::size_t i = 1; i < cells.size(); ++i) {
      if (cells[i].text.empty()) return fail(cells[i].column, "needs the name of a joint");
      if (std::string error = joint_name_error(cells[i].text); !error.empty())
        return fail(cells[i].column, std::move(error));
      if (!names.insert(cells[i].text).second)
        return fail(cells[i].column, "names joint '" + shortened(printable(cells[i].text)) + "' twice");
      tracks_.push_back({std::string(cells[i].text), {}});
    }
    return true;
  }

  bool read_number(const Cell& cell, double& value) {
    const std::optional<double> number = exact_number<double>(cell.text);
    value = number.value_or(0);
    if (number && std::isfinite(value) && std::abs(value) <= 1e6) return true;
    return fail(cell.column, "must be a number from -1e6 to 1e6, got '" + shortened(printable(cell.text)) + "'");
  }

  bool read_frame(std::string_view line) {
    const std::vector<Cell> cells = cells_of(line);
    if (cells.size() != tracks_.size() + 1)
      return fail(1,
                  "must have " + std::to_string(tracks_.size() + 1) + " values, got " + std::to_string(cells.size()));
    double t_s = 0;
    if (!read_number(cells[0], t_s)) return false;
    if (t_s < 0 || t_s > max_motion_s)
      return fail(cells[0].column, "'t_s' must be >= 0 and <= 86400, got " + number_text(t_s));
    // All tracks have the same times, so the first one tells whether time increases.
    const std::vector<TrackKey>& before = tracks_.front().keys;
    if (!before.empty() && !(t_s > before.back().at_s))
      return fail(cells[0].column,
                  "'t_s' must increase: " + number_text(t_s) + " comes after " + number_text(before.back().at_s));
    if (before.size() == max_motion_keys)
      return fail(1, "must have at most " + std::to_string(max_motion_keys) + " frames");
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      double value = 0;
      if (!read_number(cells[i + 1], value)) return false;
      tracks_[i].keys.push_back({t_s, value, Easing::linear});
    }
    return true;
  }

  std::string_view text_;
  FramesError& error_;
  std::size_t at_ = 0;
  int line_number_ = 0;
  std::vector<MotionTrack> tracks_;
};

}  // namespace

std::vector<MotionTrack> parse_motion_frames(std::string_view text, FramesError& error) {
  return FramesParser(without_byte_order_mark(text), error).parse();
}

std::vector<MotionTrack> read_motion_frames(const std::string& path, ParamReader& in, const char* key) {
  std::string text;
  try {
    text = whole_file<std::runtime_error>(path, max_frames_mb);
  } catch (const std::runtime_error& problem) {
    in.error(key, "'" + std::string(key) + "': file '" + shortened(printable(path)) + "' " + problem.what());
    return {};
  }
  FramesError error;
  std::vector<MotionTrack> tracks = parse_motion_frames(text, error);
  if (!error.text.empty())
    in.diagnostics().error({intern_file_name(path), error.line, error.column}, in.who(), error.text);
  return tracks;
}

std::string motion_frames_text(const std::vector<MotionTrack>& tracks) {
  std::string text = "t_s";
  for (const MotionTrack& track : tracks) text += "," + track.joint;
  text += "\n";
  for (std::size_t i = 0; i < tracks.front().keys.size(); ++i) {
    text += number_text(tracks.front().keys[i].at_s);
    for (const MotionTrack& track : tracks) text += "," + number_text(track.keys[i].value);
    text += "\n";
  }
  return text;
}

std::vector<MotionTrack> sampled(const std::vector<MotionTrack>& tracks, double end_s, double period_s) {
  std::vector<MotionTrack> samples;
  const auto count = static_cast<std::size_t>(std::floor(end_s / period_s + 1e-9)) + 1;
  for (const MotionTrack& track : tracks) {
    MotionTrack& of_joint = samples.emplace_back(MotionTrack{track.joint, {}});
    for (std::size_t i = 0; i < count; ++i) {
      const double t_s = static_cast<double>(i) * period_s;
      of_joint.keys.push_back({t_s, track.value_at(t_s), Easing::linear});
    }
  }
  return samples;
}

}  // namespace sim
