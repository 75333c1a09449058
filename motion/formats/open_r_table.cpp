// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/open_r_table.hpp"

#include <cctype>
#include <cmath>

#include "sim/config/message_text.hpp"
#include "sim/motion/motion_frames.hpp"

namespace motion {

namespace {

constexpr double open_r_frame_s = 0.008;
constexpr std::size_t frames_per_package = 4;
constexpr std::size_t max_frames = 1'000'000;
constexpr double max_set_points = 10'000'000;

std::string c_text(const sim::JointMotion& motion, const std::string& text) {
  for (const char c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == '"' || c == '\\' || c == '?')
      refuse_motion(motion, "joint '" + sim::printable(text) + "' must be a plain text for a C table");
  return "\"" + text + "\"";
}

}  // namespace

OpenRTable open_r_table(const sim::JointMotion& motion, const JointNames& names, const FormatOptions& options,
                        Losses& losses) {
  list_losses(motion, {}, losses);
  // Set points at whole frames.
  const TableRules rules{.tick_s = open_r_frame_s, .max_rows = max_frames, .max_value = 2147, .holds_sliders = false};
  const PoseTable table = pose_table(motion, names, open_r_table_format(), rules, losses);
  if (table.end_s() / open_r_frame_s * static_cast<double>(table.joints.size()) > max_set_points)
    refuse_motion(motion, "a C table has at most 10000000 values, one of each joint every 8 ms");
  const std::vector<sim::MotionTrack> frames = sim::sampled(table.tracks(), table.end_s(), open_r_frame_s);
  const std::size_t count = frames.front().keys.size();
  const std::size_t packages = (count + frames_per_package - 1) / frames_per_package;
  // Names in C.
  std::string lower = motion_name(options.name.empty() ? motion.name : options.name), upper;
  for (char& c : lower) {
    c = c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  if (std::isdigit(static_cast<unsigned char>(lower[0]))) lower.insert(0, "motion_"), upper.insert(0, "MOTION_");
  // Text.
  std::string text =
      "/* Motion " + lower + ", " + sim::number_text(table.end_s()) +
      " s: set points of joints every 8 ms, in 1e-6 rad, for OCommandVectorData of OPEN-R with 4 frames.\n"
      "   The last frame fills up the last package. */\n";
  const auto define = [&](const char* what, std::size_t value) {
    text += "#define " + upper + "_" + what + " " + std::to_string(value) + "\n";
  };
  define("JOINTS", table.joints.size());
  define("FRAMES", count);
  define("PACKAGES", packages);
  text += "\nstatic const char* const " + lower + "_locators[" + upper + "_JOINTS] = {\n";
  for (const TableJoint& joint : table.joints) text += "    " + c_text(motion, joint.foreign) + ",\n";
  text += "};\n\nstatic const int " + lower + "_frames[" + upper + "_PACKAGES][4][" + upper + "_JOINTS] = {\n";
  for (std::size_t package = 0; package < packages; ++package) {
    for (std::size_t i = 0; i < frames_per_package; ++i) {
      text += i == 0 ? "    {{" : "     {";
      const std::size_t frame = std::min(package * frames_per_package + i, count - 1);
      for (std::size_t j = 0; j < frames.size(); ++j)
        text += (j == 0 ? "" : ", ") + std::to_string(std::lround(frames[j].keys[frame].value * 1e6));
      text += i + 1 == frames_per_package ? "}},\n" : "},\n";
    }
  }
  return {lower, upper, table.joints, text + "};\n"};
}

MotionFormat open_r_table_format() {
  return {.name = "openr-c",
          .meaning = "C table of frames of 8 ms for an object of OPEN-R",
          .endings = {".h", ".c"},
          .head = "",
          .list = "open-r",
          .uses_aliases = true,
          .write = [](const sim::JointMotion& motion, const JointNames& names, const FormatOptions& options,
                      Losses& losses) { return open_r_table(motion, names, options, losses).text; },
          .read = nullptr};
}

}  // namespace motion
