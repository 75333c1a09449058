// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/diagnostics.hpp"
#include "tools/shoal/urdf/robot_description.hpp"

namespace tinyxml2 {
class XMLElement;
}

namespace tools {

/// Element of a URDF or SDF file.  Errors are sim::ConfigError of one line: `FILE:LINE: who: rule, value`.
class XmlElement {
 public:
  /// `who`: the link or joint that contains it, for errors.
  XmlElement(const tinyxml2::XMLElement& element, const std::string* file, std::string who);

  const std::string& who() const { return who_; }
  void set_who(std::string who) { who_ = std::move(who); }
  std::string_view name() const;
  sim::SourcePlace place() const;
  [[noreturn]] void refuse(const std::string& text) const;

  /// Child elements, in the order of the file.
  std::vector<XmlElement> children() const;
  std::vector<XmlElement> children(std::string_view name) const;
  /// The only child of this name; refuses a second one.
  std::optional<XmlElement> child(std::string_view name) const;
  /// The only child of this name; refuses none.
  XmlElement required_child(std::string_view name) const;
  /// Adds a note for each child whose name is none of these, and for each attribute of the others that is not imported.
  void note_others(std::initializer_list<std::string_view> known, std::vector<ImportNote>& notes) const;

  bool has(const char* attribute) const;
  /// Attributes; the first form refuses a missing one.
  std::string text(const char* attribute) const;
  std::string text(const char* attribute, const std::string& initial) const;
  double number(const char* attribute) const;
  std::optional<double> optional_number(const char* attribute) const;
  /// A number of any size, also infinite, limited to -1e9 and 1e9.
  double limited_number(const char* attribute) const;
  /// Finite numbers, separated by blanks; empty when one of the words is not a finite number.
  std::vector<double> any_numbers(const char* attribute) const;
  /// `count` finite numbers, separated by blanks.
  std::vector<double> numbers(const char* attribute, std::size_t count) const;
  sim::Vector3d vector(const char* attribute, const sim::Vector3d& initial) const;

  /// Text between its tags, without blanks around it.
  std::string content() const;
  /// `count` finite numbers of the content, separated by blanks.
  std::vector<double> content_numbers(std::size_t count) const;
  /// Finite numbers of the content; empty when one of the words is not a finite number.
  std::vector<double> any_content_numbers() const;
  /// Content of the only child of a name; nothing or `initial` without it.
  std::optional<double> child_number(std::string_view name) const;
  std::optional<double> limited_child_number(std::string_view name) const;
  std::string child_text(std::string_view name, const std::string& initial = "") const;
  bool child_flag(std::string_view name, bool initial) const;
  sim::Vector3d child_vector(std::string_view name, const sim::Vector3d& initial) const;

  /// `xyz` and `rpy` or `quat_xyzw` of its child `<origin>`; the identity without it.
  sim::Pose origin() const;

 private:
  void note_other_attributes(const std::string& of, std::vector<ImportNote>& notes) const;
  std::vector<double> checked_numbers(const std::string& what, const std::string& text, std::size_t count) const;
  double limited_number(const std::string& what, const std::string& text) const;

  const tinyxml2::XMLElement* element_;
  const std::string* file_;
  std::string who_;
};

/// Pose of a position and the quaternion x, y, z, w, which must have the length 1.
sim::Pose pose_of_quaternion(const XmlElement& element, const std::string& what, const sim::Vector3d& position_m,
                             const std::vector<double>& xyzw);

}  // namespace tools
