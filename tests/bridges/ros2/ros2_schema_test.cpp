// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/ros2_schema.hpp"

#include <gmock/gmock.h>

#include <regex>
#include <sstream>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/ros2_names.hpp"

namespace {

using namespace bridges::ros2;

shoal::MessageTypes types_of(const std::string& lcm) {
  const shoal::LcmSource source{"a.lcm", lcm};
  return shoal::MessageTypes(std::span(&source, 1));
}

TEST(Ros2Schema, HasTheUsedTypesBehindTheType) {
  const auto types = types_of(
      "package p; struct b_t { double x; /// in m\n } "
      "struct a_t { int32_t n; b_t list[n]; boolean flag[2][3]; string names[n]; byte raw; }");
  EXPECT_EQ(schema_text(*types.find("p.a_t")),
            "int32 n\np_interfaces/B[] list\nbool[6] flag\nstring[] names\nuint8 raw\n" + schema_separator +
                "MSG: p_interfaces/B\nfloat64 x  # in m\n");
}

TEST(Ros2Schema, ATypeWithoutMembersHasOne) {
  const auto types = types_of("package p; struct a_t { }");
  EXPECT_EQ(schema_text(*types.find("p.a_t")), "uint8 structure_needs_at_least_one_member\n");
}

TEST(Ros2Schema, EveryMemberOfEveryTypeHasAValidName) {
  const std::regex valid(
      "(bool|u?int(8|16|32|64)|float(32|64)|string|[a-z_]+/[A-Z][A-Za-z0-9]*)(\\[[0-9]*\\])? "
      "[a-z](_?[a-z0-9])*(  # .*)?");
  for (const auto& [name, schema] : shoal::embedded_types().all()) {
    std::istringstream lines(schema_text(schema));
    for (std::string line; std::getline(lines, line);) {
      if (line == schema_separator.substr(0, 80) || line.starts_with("MSG: ")) continue;
      EXPECT_TRUE(std::regex_match(line, valid)) << name << ": " << line;
    }
  }
}

TEST(Ros2Schema, EveryConverterHasASchemaWithAllTypesThatItUses) {
  EXPECT_GE(ConverterTable::instance().all().size(), 20u);
  for (const Converter* converter : ConverterTable::instance().all()) {
    const std::string text = standard_schema_text(converter->ros_type);
    EXPECT_NE(shoal::embedded_types().find(converter->lcm_type), nullptr) << converter->lcm_type;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const std::string type = line.substr(0, line.find_first_of(" ["));
      if (type.find('/') == std::string::npos) continue;
      EXPECT_NE(text.find("MSG: " + type + "\n"), std::string::npos) << converter->ros_type << ": " << type;
    }
  }
  EXPECT_THROW(standard_schema_text("nav_msgs/msg/GridCells"), std::out_of_range);
}

}  // namespace
