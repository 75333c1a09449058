// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/node/node_types.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "bridges/base/bus_error.hpp"
#include "bridges/ros2/ros2_schema.hpp"
#include "shoal/message_schema.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;
using namespace bridges::ros2;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(MessagePackage, HasAFileForEachTypeAndIsNotOverwritten) {
  const test_support::ScratchFolder folder;
  bridges::ros2::write_message_package(folder.file("src"));
  const std::filesystem::path root = folder.file("src/shoal_interfaces");
  EXPECT_THAT(text_of(root / "msg/Dvl.msg"), AllOf(HasSubstr("int64 utime"), HasSubstr("float64[3] velocity_mps")));
  EXPECT_THAT(text_of(root / "msg/Image.msg"), HasSubstr("shoal_interfaces/ImageMetadata"));
  EXPECT_THAT(text_of(root / "msg/Image.msg"), testing::Not(HasSubstr("MSG:")));
  EXPECT_THAT(text_of(root / "package.xml"), HasSubstr("<name>shoal_interfaces</name>"));
  std::size_t types = 0;
  for (const auto& [name, schema] : shoal::embedded_types().all()) types += name.starts_with("shoal.") ? 1 : 0;
  const std::filesystem::directory_iterator files(root / "msg");
  EXPECT_EQ(static_cast<std::size_t>(std::distance(begin(files), end(files))), types + 1);  // and Tick
  EXPECT_THAT([&] { bridges::ros2::write_message_package(folder.file("src")); },
              testing::ThrowsMessage<bridges::BusError>(HasSubstr("shoal_interfaces exists; remove it first")));
}

// The hashes that nodes of ROS 2 Jazzy publish.
TEST(TypeHash, IsThatOfRos2) {
  EXPECT_EQ(type_hash("std_msgs/msg/String", "string data\n"),
            "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18");
  EXPECT_EQ(type_hash("sensor_msgs/msg/Imu", standard_schema_text("sensor_msgs/msg/Imu")),
            "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b");
  EXPECT_EQ(type_hash("sensor_msgs/msg/MagneticField", standard_schema_text("sensor_msgs/msg/MagneticField")),
            "RIHS01_e80f32f56a20486c9923008fc1a1db07bbb273cbbf6a5b3bfa00835ee00e4dff");
}

TEST(TypeHash, DependsOnMembersAndNotOnConstantsOrComments) {
  EXPECT_EQ(type_hash("a/msg/B", "uint8 ONE=1\nuint8 value  # of something\n"), type_hash("a/msg/B", "uint8 value\n"));
  EXPECT_NE(type_hash("a/msg/B", "uint8[3] value\n"), type_hash("a/msg/B", "uint8[4] value\n"));
  EXPECT_NE(type_hash("a/msg/B", "uint8[] value\n"), type_hash("a/msg/B", "uint8 value\n"));
}

}  // namespace
