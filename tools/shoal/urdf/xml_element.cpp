// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/xml_element.hpp"

#include <spdlog/fmt/fmt.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"

namespace tools {

namespace {

constexpr double max_number = 1e9;  // of any length, mass, angle or limit

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// Splits a text at blanks.
std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < text.size();) {
    if (is_blank(text[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && !is_blank(text[end])) ++end;
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

/// Parses a number; std::nullopt for any other text.
std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto value = sim::exact_number<double>(word);
  return value && !std::isnan(*value) ? value : std::nullopt;
}

/// Numbers of a text; none when one of its words is not a finite number of at most 1e9.
std::vector<double> finite_numbers(std::string_view text) {
  std::vector<double> parsed;
  for (const std::string_view word : words_of(text)) {
    const std::optional<double> number = parse_number(word);
    if (!number || std::abs(*number) > max_number) return {};
    parsed.push_back(*number);
  }
  return parsed;
}

std::string shown_text(std::string_view text) {
  return "'" + sim::shortened(sim::printable(text)) + "'";
}

}  // namespace

XmlElement::XmlElement(const tinyxml2::XMLElement& element, const std::string* file, std::string who)
    : element_(&element), file_(file), who_(std::move(who)) {}

std::string_view XmlElement::name() const {
  return element_->Name();
}

sim::SourcePlace XmlElement::place() const {
  return {file_, element_->GetLineNum(), 0};
}

void XmlElement::refuse(const std::string& text) const {
  sim::throw_config_error(place(), who_, text);
}

std::vector<XmlElement> XmlElement::children() const {
  std::vector<XmlElement> found;
  for (const auto* child = element_->FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    found.emplace_back(*child, file_, who_);
  return found;
}

std::vector<XmlElement> XmlElement::children(std::string_view name) const {
  std::vector<XmlElement> found;
  for (const XmlElement& child : children())
    if (child.name() == name) found.push_back(child);
  return found;
}

std::optional<XmlElement> XmlElement::child(std::string_view name) const {
  const std::vector<XmlElement> found = children(name);
  if (found.size() > 1) found[1].refuse(fmt::format("has more than one <{}>", name));
  if (found.empty()) return std::nullopt;
  return found.front();
}

XmlElement XmlElement::required_child(std::string_view name) const {
  const std::optional<XmlElement> found = child(name);
  if (!found) refuse(fmt::format("<{}> needs a <{}>", this->name(), name));
  return *found;
}

void XmlElement::note_others(std::initializer_list<std::string_view> known, std::vector<ImportNote>& notes) const {
  const std::string of = who_.empty() ? "" : who_ + ": ";
  for (const XmlElement& child : children()) {
    if (std::find(known.begin(), known.end(), child.name()) != known.end()) {
      child.note_other_attributes(of, notes);
      continue;
    }
    notes.push_back({child.place(), fmt::format("{}<{}> is not imported", of, child.name())});
  }
}

void XmlElement::note_other_attributes(const std::string& of, std::vector<ImportNote>& notes) const {
  // Elements that mean the same everywhere.
  static const std::map<std::string_view, std::set<std::string_view>> known_of = {
      {"origin", {"xyz", "rpy", "quat_xyzw"}},
      {"axis", {"xyz"}},
      {"limit", {"lower", "upper", "effort", "velocity"}},
      {"dynamics", {"damping", "friction"}},
      {"mimic", {"joint", "multiplier", "offset"}},
      {"mass", {"value"}},
      {"inertia", {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}}};
  const auto known = known_of.find(name());
  if (known == known_of.end()) return;
  for (const tinyxml2::XMLAttribute* each = element_->FirstAttribute(); each != nullptr; each = each->Next())
    if (!known->second.contains(each->Name()))
      notes.push_back({place(), fmt::format("{}'{}' of <{}> is not imported", of,
                                            sim::shortened(sim::printable(each->Name())), name())});
}

bool XmlElement::has(const char* attribute) const {
  return element_->Attribute(attribute) != nullptr;
}

std::string XmlElement::text(const char* attribute) const {
  if (!has(attribute)) refuse(fmt::format("<{}> needs the attribute '{}'", name(), attribute));
  const std::string value = element_->Attribute(attribute);
  if (value.find("${") != std::string::npos || value.find("$(") != std::string::npos)
    refuse(fmt::format("'{}' is a xacro expression, {}: run `xacro FILE > robot.urdf` first", attribute,
                       shown_text(value)));
  return value;
}

std::string XmlElement::text(const char* attribute, const std::string& initial) const {
  return has(attribute) ? text(attribute) : initial;
}

std::vector<double> XmlElement::any_numbers(const char* attribute) const {
  return finite_numbers(text(attribute));
}

std::vector<double> XmlElement::checked_numbers(const std::string& what, const std::string& text,
                                                std::size_t count) const {
  const std::vector<double> parsed = finite_numbers(text);
  if (parsed.size() != count)
    refuse(fmt::format("{} must be {} between -1e9 and 1e9, got {}", what,
                       count == 1 ? "a number" : fmt::format("{} numbers", count), shown_text(text)));
  return parsed;
}

std::vector<double> XmlElement::numbers(const char* attribute, std::size_t count) const {
  return checked_numbers(fmt::format("'{}'", attribute), text(attribute), count);
}

double XmlElement::number(const char* attribute) const {
  return numbers(attribute, 1).front();
}

std::optional<double> XmlElement::optional_number(const char* attribute) const {
  if (!has(attribute)) return std::nullopt;
  return number(attribute);
}

double XmlElement::limited_number(const char* attribute) const {
  return limited_number(fmt::format("'{}'", attribute), text(attribute));
}

double XmlElement::limited_number(const std::string& what, const std::string& text) const {
  const std::vector<std::string_view> words = words_of(text);
  const std::optional<double> parsed = words.size() == 1 ? parse_number(words[0]) : std::nullopt;
  if (!parsed) refuse(fmt::format("{} must be a number, got {}", what, shown_text(text)));
  return std::clamp(*parsed, -max_number, max_number);
}

sim::Vector3d XmlElement::vector(const char* attribute, const sim::Vector3d& initial) const {
  if (!has(attribute)) return initial;
  const std::vector<double> xyz = numbers(attribute, 3);
  return {xyz[0], xyz[1], xyz[2]};
}

std::string XmlElement::content() const {
  const char* const text = element_->GetText();
  const std::string_view all = text == nullptr ? "" : text;
  const std::size_t first = all.find_first_not_of(" \t\r\n");
  return first == all.npos ? "" : std::string(all.substr(first, all.find_last_not_of(" \t\r\n") + 1 - first));
}

std::vector<double> XmlElement::content_numbers(std::size_t count) const {
  return checked_numbers(fmt::format("<{}>", name()), content(), count);
}

std::vector<double> XmlElement::any_content_numbers() const {
  return finite_numbers(content());
}

std::optional<double> XmlElement::child_number(std::string_view name) const {
  const std::optional<XmlElement> found = child(name);
  return found ? std::optional(found->content_numbers(1).front()) : std::nullopt;
}

std::optional<double> XmlElement::limited_child_number(std::string_view name) const {
  const std::optional<XmlElement> found = child(name);
  if (!found) return std::nullopt;
  return found->limited_number(fmt::format("<{}>", name), found->content());
}

std::string XmlElement::child_text(std::string_view name, const std::string& initial) const {
  const std::optional<XmlElement> found = child(name);
  return found ? found->content() : initial;
}

bool XmlElement::child_flag(std::string_view name, bool initial) const {
  std::string text = child_text(name);
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  if (text == "true" || text == "1") return true;
  return text == "false" || text == "0" ? false : initial;
}

sim::Vector3d XmlElement::child_vector(std::string_view name, const sim::Vector3d& initial) const {
  const std::optional<XmlElement> found = child(name);
  if (!found) return initial;
  const std::vector<double> xyz = found->content_numbers(3);
  return {xyz[0], xyz[1], xyz[2]};
}

sim::Pose XmlElement::origin() const {
  const std::optional<XmlElement> origin = child("origin");
  if (!origin) return sim::Pose::Identity();
  const sim::Vector3d xyz = origin->vector("xyz", sim::Vector3d::Zero());
  if (!origin->has("quat_xyzw")) return sim::make_pose(xyz, origin->vector("rpy", sim::Vector3d::Zero()));
  if (origin->has("rpy")) origin->refuse("has 'rpy' and 'quat_xyzw', of which one is enough");
  return pose_of_quaternion(*origin, "'quat_xyzw'", xyz, origin->numbers("quat_xyzw", 4));
}

sim::Pose pose_of_quaternion(const XmlElement& element, const std::string& what, const sim::Vector3d& position_m,
                             const std::vector<double>& xyzw) {
  const sim::Quaterniond turn(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  if (!(std::abs(turn.norm() - 1) < 0.01))
    element.refuse(what + " must have the length 1, got " + sim::number_text(turn.norm()));
  sim::Pose pose = sim::Pose::Identity();
  pose.linear() = turn.normalized().toRotationMatrix();
  pose.translation() = position_m;
  return pose;
}

}  // namespace tools
