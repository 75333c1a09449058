// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/yaml_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>

#include "motion/formats/pose_table.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"

namespace motion {

namespace {

constexpr std::size_t max_yaml_bytes = 16'000'000;

/// Returns whether a reader may take the word as something else than text.
bool is_reserved(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const char* word : {"true", "false", "yes", "no", "on", "off", "y", "n", "null", "nan", "inf"})
    if (text == word) return true;
  return false;
}

}  // namespace

std::string yaml_word(const std::string& text) {
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  if (!text.empty() && !std::isdigit(static_cast<unsigned char>(text[0])) &&
      std::all_of(text.begin(), text.end(), in_word) && !is_reserved(text))
    return text;
  sim::ConfigNode node;
  node.kind = sim::ConfigNode::Kind::scalar;
  node.scalar = text;
  node.quoted = true;
  return sim::to_flow_yaml(node);
}

std::string yaml_double(double value) {
  std::string text = fmt::format("{:.9f}", value);
  while (text.ends_with('0') && !text.ends_with(".0")) text.pop_back();
  return text == "-0.0" ? "0.0" : text;
}

sim::ConfigNode parse_yaml_document(const MotionSource& source, sim::Diagnostics& diagnostics) {
  const sim::SourcePlace place{sim::intern_file_name(source.file), 0, 0};
  if (source.bytes.size() > max_yaml_bytes)
    sim::throw_config_error(place, "",
                            "the file must have at most 16 MB, got " + std::to_string(source.bytes.size()) + " bytes");
  std::string text(source.bytes);
  // ros2 topic echo ends each message so.
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  if (text.ends_with("\n---")) text.resize(text.size() - 4);
  sim::ConfigNode root = sim::parse_config_text(text, source.file, diagnostics);
  diagnostics.throw_if_any();
  if (root.kind != sim::ConfigNode::Kind::map)
    sim::throw_config_error({place.file, 1, 1}, "", "the file must be a map");
  return root;
}

std::vector<std::string> joints_called(const MotionSource& source, const char* list,
                                       const std::vector<std::string>& foreign, const sim::SourcePlace& place) {
  std::vector<std::string> joints;
  for (const std::string& name : foreign) {
    const std::string joint = joint_called(source, list, name, place);
    if (joint.empty() || std::find(joints.begin(), joints.end(), joint) != joints.end())
      sim::throw_config_error(place, "",
                              "must name each joint once, got '" + sim::shortened(sim::printable(name)) + "'");
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace motion
