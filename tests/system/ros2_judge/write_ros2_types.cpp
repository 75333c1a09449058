// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "bridges/ros2/node/tick_exchange.hpp"
#include "bridges/ros2/ros2_schema.hpp"

// write_ros2_types FOLDER TYPE...: writes types such as sensor_msgs/msg/Imu, and those that they use, as
// FOLDER/PKG/msg/ NAME.msg, as Shoal has them; prints their names without /msg/, each after those that it uses.

namespace {

void write(const std::filesystem::path& root, const std::string& name, const std::string& definition) {
  const auto slash = name.find('/');
  const auto folder = root / name.substr(0, slash) / "msg";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / (name.substr(slash + 1) + ".msg")) << definition;
  std::cout << name << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 2; i < argc; ++i) {
    std::string name = argv[i];
    using bridges::ros2::Tick;
    std::istringstream lines(name == Tick::type ? Tick::schema() : bridges::ros2::standard_schema_text(name));
    name.erase(name.find("/msg/"), 4);
    std::string definition;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("MSG: ")) {
        write(argv[1], name, definition);
        name = line.substr(5);
        definition.clear();
      } else if (!line.starts_with("====")) {
        definition += line + "\n";
      }
    }
    write(argv[1], name, definition);
  }
}
