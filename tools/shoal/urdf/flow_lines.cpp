// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/flow_lines.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "sim/base/number.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"

namespace tools {

namespace {

constexpr std::size_t max_width = 120;

}  // namespace

std::string short_number(double value) {
  if (std::abs(value) < 1e-12) return "0";
  return sim::number_text(sim::rounded_to(value, 10));
}

std::string short_list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + short_number(value);
  return "[" + text + "]";
}

std::string yaml_scalar(const std::string& text) {
  sim::ConfigNode node;
  node.kind = sim::ConfigNode::Kind::scalar;
  node.scalar = text;
  return sim::to_flow_yaml(node);
}

void FlowMap::add_text(const std::string& key, const std::string& text) {
  add(key, yaml_scalar(text));
}

void FlowMap::add(const std::string& key, double value) {
  add(key, short_number(value));
}

void FlowMap::add(const std::string& key, const sim::Vector3d& value) {
  add(key, short_list({value.x(), value.y(), value.z()}));
}

void FlowMap::add_unless_zero(const std::string& key, const sim::Vector3d& value) {
  if (value.cwiseAbs().maxCoeff() >= 1e-12) add(key, value);
}

std::string FlowMap::lines(const std::string& prefix) const {
  std::string text, line = prefix + "{";
  const std::string indent(line.size(), ' ');
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::string entry = entries_[i].first + ": " + entries_[i].second + (i + 1 < entries_.size() ? "," : "}");
    if (i > 0 && line.size() + 1 + entry.size() > max_width) {
      text += line + "\n";
      line = indent + entry;
    } else {
      line += (i > 0 ? " " : "") + entry;
    }
  }
  return text + line + "\n";
}

}  // namespace tools
