// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/node/node_types.hpp"

#include <openssl/evp.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>
#include <utility>

#include "bridges/base/bus_error.hpp"
#include "bridges/ros2/node/tick_exchange.hpp"
#include "bridges/ros2/ros2_names.hpp"
#include "bridges/ros2/ros2_schema.hpp"

namespace bridges::ros2 {
namespace {

/// Numbers of types in type_description_interfaces/msg/FieldType.
constexpr int nested_type = 1, array_of = 48, sequence_of = 144;
constexpr std::array<std::pair<std::string_view, int>, 13> numbered_types{{{"int8", 2},
                                                                           {"uint8", 3},
                                                                           {"int16", 4},
                                                                           {"uint16", 5},
                                                                           {"int32", 6},
                                                                           {"uint32", 7},
                                                                           {"int64", 8},
                                                                           {"uint64", 9},
                                                                           {"float32", 10},
                                                                           {"float64", 11},
                                                                           {"bool", 15},
                                                                           {"byte", 16},
                                                                           {"string", 17}}};

std::string full_name(std::string_view short_name) {
  const std::size_t slash = short_name.find('/');
  return std::string(short_name.substr(0, slash)) + "/msg" + std::string(short_name.substr(slash));
}

/// Description of a member of type `float64[9]`, `string[]` or `std_msgs/Header`.
std::string field_text(std::string_view type, std::string_view name) {
  const std::size_t bracket = type.find('[');
  const std::string_view element = type.substr(0, bracket);
  int id = nested_type;
  for (const auto& [known, number] : numbered_types)
    if (known == element) id = number;
  const std::string nested = id == nested_type ? full_name(element) : "";
  std::string capacity = "0";
  if (bracket != std::string_view::npos) {
    const std::string_view count = type.substr(bracket + 1, type.size() - bracket - 2);
    id += count.empty() ? sequence_of : array_of;
    if (!count.empty()) capacity = count;
  }
  return R"({"name": ")" + std::string(name) + R"(", "type": {"type_id": )" + std::to_string(id) + R"(, "capacity": )" +
         capacity + R"(, "string_capacity": 0, "nested_type_name": ")" + nested + "\"}}";
}

/// Description of a type, of the lines of its definition; constants are not part of it.
std::string type_text(std::string_view type, const std::string& definition) {
  std::string fields;
  std::istringstream lines{definition};
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    std::istringstream words(line);
    std::string member_type, name;
    if (!(words >> member_type >> name) || name.find('=') != std::string::npos) continue;
    fields += (fields.empty() ? "" : ", ") + field_text(member_type, name);
  }
  return R"({"type_name": ")" + std::string(type) + R"(", "fields": [)" + fields + "]}";
}

std::string sha256(const std::string& text) {
  std::array<unsigned char, 32> digest{};
  EVP_Digest(text.data(), text.size(), digest.data(), nullptr, EVP_sha256(), nullptr);
  std::string hex;
  for (const unsigned char byte : digest) {
    constexpr std::string_view digits = "0123456789abcdef";
    hex += digits[byte >> 4];
    hex += digits[byte & 15];
  }
  return hex;
}

}  // namespace

std::string type_hash(std::string_view type, std::string_view schema) {
  std::map<std::string, std::string> used;  // in the order of the names
  std::string own;
  std::string* definition = &own;
  std::istringstream lines{std::string(schema)};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("MSG: "))
      definition = &used[full_name(line.substr(5))];
    else if (line != schema_separator.substr(0, line.size()) || line.empty())
      *definition += line + "\n";
  }
  std::string text = R"({"type_description": )" + type_text(type, own) + R"(, "referenced_type_descriptions": [)";
  const char* separator = "";
  for (const auto& [name, lines_of_it] : used) {
    text += separator + type_text(name, lines_of_it);
    separator = ", ";
  }
  return "RIHS01_" + sha256(text + "]}");
}

namespace {

namespace fs = std::filesystem;

constexpr std::string_view package = "shoal_interfaces";
constexpr std::string_view package_xml = R"(<?xml version="1.0"?>
<package format="3">
  <name>shoal_interfaces</name>
  <version>0.2.0</version>
  <description>Messages of the simulator Shoal</description>
  <maintainer email="shoal@example.org">Shoal</maintainer>
  <license>BSD-3-Clause</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <depend>builtin_interfaces</depend>
  <exec_depend>rosidl_default_runtime</exec_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export><build_type>ament_cmake</build_type></export>
</package>
)";
constexpr std::string_view cmake_lists = R"(cmake_minimum_required(VERSION 3.8)
project(shoal_interfaces)
find_package(ament_cmake REQUIRED)
find_package(builtin_interfaces REQUIRED)
find_package(rosidl_default_generators REQUIRED)
file(GLOB messages RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} msg/*.msg)
rosidl_generate_interfaces(shoal_interfaces ${messages} DEPENDENCIES builtin_interfaces)
ament_package()
)";

void write(const fs::path& file, std::string_view text) {
  std::ofstream out(file, std::ios::binary);
  out << text << std::flush;
  if (!out) throw BusError("cannot write " + file.string());
}

}  // namespace

void write_message_package(const std::string& folder) {
  const fs::path root = fs::path(folder) / package;
  std::error_code error;
  if (fs::exists(root, error)) throw BusError(root.string() + " exists; remove it first, or name another folder");
  fs::create_directories(root / "msg", error);
  if (error) throw BusError("cannot make " + root.string() + ": " + error.message());
  write(root / "package.xml", package_xml);
  write(root / "CMakeLists.txt", cmake_lists);
  write(root / "msg/Tick.msg", Tick::definition);
  for (const auto& [name, schema] : shoal::embedded_types().all()) {
    const std::string type = short_type_name(name);  // shoal_interfaces/Dvl
    if (!type.starts_with(std::string(package) + "/")) continue;
    const std::string text = schema_text(schema);
    write(root / "msg" / (type.substr(package.size() + 1) + ".msg"), text.substr(0, text.find(schema_separator)));
  }
}

}  // namespace bridges::ros2
