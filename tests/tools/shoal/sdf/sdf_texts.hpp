// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include "sim/base/number.hpp"
#include "tests/tools/shoal/urdf/urdf_texts.hpp"
#include "tools/shoal/sdf/sdf_import.hpp"

namespace test {

/// A model, with its content from line 2 on.
inline std::string sdf_text(const std::string& content, const std::string& version = "1.9") {
  return "<sdf version=\"" + version + "\"><model name=\"m\">\n" + content + "</model></sdf>\n";
}

inline std::string sdf_mass(double mass_kg, const std::string& moments = "1 1 1", const std::string& pose = "") {
  std::string text = "<inertial>" + (pose.empty() ? "" : "<pose>" + pose + "</pose>") + "<mass>" +
                     sim::shortest_text(mass_kg) + "</mass><inertia>";
  std::size_t at = 0;
  for (const std::string name : {"ixx", "iyy", "izz"}) {
    const std::size_t end = moments.find(' ', at);
    text += "<" + name + ">" + moments.substr(at, end - at) + "</" + name + ">";
    at = end + 1;
  }
  return text + "</inertia></inertial>";
}

/// A link of 1 kg on one line.
inline std::string sdf_link(const std::string& name, const std::string& more = "", double mass_kg = 1) {
  return "<link name=\"" + name + "\">" + sdf_mass(mass_kg) + more + "</link>\n";
}

/// A joint from `a` to `b` on one line.
inline std::string sdf_joint(const std::string& type, const std::string& more = "",
                             const std::string& ends = "<parent>a</parent><child>b</child>") {
  return "<joint name=\"j\" type=\"" + type + "\">" + ends + more + "</joint>\n";
}

inline std::string sdf_box(const std::string& size) {
  return "<collision name=\"c\"><geometry><box><size>" + size + "</size></box></geometry></collision>";
}

inline std::string sdf_plugin(const std::string& name, const std::string& content) {
  return "<plugin filename=\"x\" name=\"gz::sim::systems::" + name + "\">" + content + "</plugin>\n";
}

inline tools::RobotImport imported_sdf(const std::string& text, const tools::RobotImportOptions& options = {},
                                       const std::string& model = "") {
  tools::SdfFiles files("m.sdf", options.meshes.folders);
  files.add("m.sdf", text);
  return tools::import_sdf(files, "m.sdf", model, options);
}

/// The error of an import; empty: none.
inline std::string sdf_error(const std::string& text) {
  try {
    imported_sdf(text);
    return {};
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
}

/// Value of a key of a device; empty: it has none.
inline std::string key_of(const tools::YamlEntries& entries, const std::string& key) {
  for (const auto& [name, value] : entries)
    if (name == key) return value;
  return {};
}

inline const tools::ImportedDevice& device_of(const tools::RobotImport& import, const std::string& name) {
  for (const tools::ImportedDevice& device : import.vehicle.devices)
    if (device.name == name) return device;
  throw std::out_of_range("no device " + name);
}

}  // namespace test
