// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/project_paths.hpp"

// Every folder of sources is a room; the CMakeLists.txt of its top-level folder says which rooms it uses, from the
// bottom up (cmake/Rooms.cmake).  Here includes are held to that; the linker does the same with symbols (target
// room_links).

namespace {

namespace fs = std::filesystem;

/// `sim/physics`: the rooms that it may include, itself among them.  In the order of the CMakeLists.txt.
struct Rooms {
  std::vector<std::string> order;
  std::map<std::string, std::set<std::string>> uses;
};

/// Top-level folders, and what their rooms may use at all.
const std::map<std::string, std::set<std::string>> layers = {
    {"sim", {"sim"}},
    {"messages", {"messages", "sim"}},
    {"devices", {"devices", "messages", "sim"}},
    {"bridges", {"bridges", "messages", "sim"}},
    {"experiment", {"experiment", "bridges", "devices", "messages", "sim"}},
    {"autonomy", {"autonomy", "experiment", "bridges", "devices", "messages", "sim"}},
    {"viewer", {"viewer", "experiment", "bridges", "devices", "messages", "sim"}},
    {"motion", {"motion", "viewer", "experiment", "bridges", "devices", "messages", "sim"}},
    {"verification", {"verification", "motion", "autonomy", "experiment", "bridges", "devices", "messages", "sim"}},
    {"tools",
     {"tools", "verification", "motion", "viewer", "autonomy", "experiment", "bridges", "devices", "messages", "sim"}},
    {"python", {"python", "experiment", "bridges", "devices", "messages", "sim"}},
};

std::string top_of(const std::string& path) {
  return path.substr(0, path.find('/'));
}

/// The lines `room: used used ...` that CMake writes.
Rooms parse_rooms(std::istream& text) {
  Rooms rooms;
  std::string line;
  while (std::getline(text, line)) {
    const std::size_t colon = line.find(':');
    const std::string room = line.substr(0, colon);
    std::istringstream used(line.substr(colon + 1));
    std::set<std::string>& uses = rooms.uses[room] = {room};
    for (std::string each; used >> each;) uses.insert(each);
    rooms.order.push_back(room);
  }
  return rooms;
}

Rooms rooms_of_the_build() {
  std::ifstream text(test_support::built_path("rooms.txt"));
  return parse_rooms(text);
}

/// The room that an include lies in; empty: it is not an include of the project.
std::string room_of_include(const std::string& include) {
  static const std::set<std::string> client_headers = {"shoal/client.hpp"};
  if (client_headers.contains(include)) return "bridges/client";
  const std::string top = top_of(include);
  if (top == "shoal") return "messages/shoal";  // generated from the types, or what knows them
  if (top == "tests" || top == "lcm") return top;
  return layers.contains(top) ? include.substr(0, include.rfind('/')) : "";
}

/// LCM itself is called in the rooms that carry bytes, nowhere else.
bool may_call_lcm(const std::string& room) {
  return room == "bridges/lcm" || room == "bridges/bus" || room == "bridges/log" || top_of(room) == "tools";
}

/// `path`: from the top of the source tree.  One line for each include that points up, or to a room that is not said to
/// be used.
std::vector<std::string> offenders_in(const std::string& path, std::istream& text, const Rooms& rooms) {
  static const std::regex include(R"(\s*#\s*include\s*[<"](?:\.\./)*([^>"]+/[^>"]+)[>"].*)");
  const std::string room =
      path.substr(0, path.rfind('/')) == "bridges/client/shoal" ? "bridges/client" : path.substr(0, path.rfind('/'));
  std::vector<std::string> offenders;
  const auto offends = [&](int line, const std::string& what) {
    offenders.push_back(path + ":" + std::to_string(line) + ": " + what);
  };
  if (!rooms.uses.contains(room)) {
    offends(0, room + " is no room: no shoal_room() makes it");
    return offenders;
  }
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    std::smatch match;
    if (!std::regex_match(line, match, include)) continue;
    const std::string target = room_of_include(match[1]);
    if (target.empty() || rooms.uses.at(room).contains(target)) continue;
    if (target == "lcm" && may_call_lcm(room)) continue;
    offends(number, room + " does not use " + target);
  }
  return offenders;
}

bool is_source(const fs::path& path) {
  return path.extension() == ".hpp" || path.extension() == ".cpp" || path.extension() == ".h" ||
         path.extension() == ".c";
}

/// Calls `visit` with the path of every source below the layers.
template <typename Visit>
void for_each_source(const Visit& visit) {
  const fs::path root = test_support::source_path("");
  for (const auto& [folder, allowed] : layers)
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file() && is_source(entry.path())) visit(entry.path().lexically_relative(root).string());
}

/// Made once, of the types or of the headers: no room of its own.
bool is_generator(const std::string& path) {
  return path == "messages/generate_type_tables.cpp";
}

TEST(IncludeDirection, EveryIncludeStaysInItsRoomOrGoesToOneThatItUses) {
  const Rooms rooms = rooms_of_the_build();
  ASSERT_GT(rooms.order.size(), 40u);
  const bool has_python = rooms.uses.contains("python/world");
  int files = 0;
  for_each_source([&](const std::string& path) {
    if (is_generator(path)) return;
    // A build with sanitizers, or for programs only, has no package for Python.
    if (top_of(path) == "python" && !has_python) return;
    ++files;
    std::ifstream text(test_support::source_path(path));
    for (const std::string& offender : offenders_in(path, text, rooms)) ADD_FAILURE() << offender;
  });
  EXPECT_GT(files, 500);  // the folders were found
}

TEST(IncludeDirection, RoomsUseOnlyRoomsBelowThem) {
  const Rooms rooms = rooms_of_the_build();
  std::set<std::string> below;
  for (const std::string& room : rooms.order) {
    for (const std::string& used : rooms.uses.at(room)) {
      EXPECT_TRUE(used == room || below.contains(used)) << room << " uses " << used << ", which is not below it";
      EXPECT_TRUE(layers.at(top_of(room)).contains(top_of(used))) << room << " uses " << used;
    }
    below.insert(room);
  }
}

TEST(IncludeDirection, EveryRoomIsSmallEnoughToKnow) {
  std::map<std::string, int> files;
  for_each_source([&](const std::string& path) { ++files[path.substr(0, path.rfind('/'))]; });
  for (const auto& [room, count] : files) EXPECT_LE(count, 36) << room;
}

const Rooms& small_house() {
  static std::istringstream text(
      "sim/base:\nsim/bus: sim/base\nmessages/shoal:\ndevices/ranging: sim/bus messages/shoal\n");
  static const Rooms rooms = parse_rooms(text);
  return rooms;
}

std::vector<std::string> offenders_in_text(const std::string& path, const std::string& text) {
  std::istringstream stream(text);
  return offenders_in(path, stream, small_house());
}

TEST(IncludeDirection, NamesAnOffender) {
  EXPECT_THAT(offenders_in_text("sim/base/a.cpp", "#include \"sim/base/a.hpp\"\n#include \"sim/bus/bus.hpp\"\n"),
              testing::ElementsAre("sim/base/a.cpp:2: sim/base does not use sim/bus"));
  EXPECT_THAT(offenders_in_text("devices/ranging/lidar.cpp", "\n#  include <lcm/lcm.h>\n"),
              testing::ElementsAre("devices/ranging/lidar.cpp:2: devices/ranging does not use lcm"));
  EXPECT_THAT(offenders_in_text("sim/bus/bus.hpp", "#include \"shoal/pose_t.hpp\"\n"),
              testing::ElementsAre("sim/bus/bus.hpp:1: sim/bus does not use messages/shoal"));
  EXPECT_THAT(offenders_in_text("sim/attic/a.cpp", ""),
              testing::ElementsAre("sim/attic/a.cpp:0: sim/attic is no room: no shoal_room() makes it"));
  EXPECT_EQ(offenders_in_text("sim/bus/a.cpp", "#include \"../../tools/b/a.hpp\"\n#include \"tests/b.hpp\"\n").size(),
            2u);
}

TEST(IncludeDirection, LetsPassWhatIsAllowed) {
  EXPECT_TRUE(offenders_in_text("devices/ranging/a.cpp",
                                "#include \"devices/ranging/a.hpp\"\n#include \"sim/bus/bus.hpp\"\n"
                                "#include \"shoal/pose_t.hpp\"\n")
                  .empty());
  EXPECT_TRUE(offenders_in_text("sim/base/a.cpp",
                                "#include <sys/stat.h>\n#include <Eigen/Core>\n"
                                "// #include \"tools/x/a.hpp\"\n")
                  .empty());
}

}  // namespace
