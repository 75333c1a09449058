// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/robot_folders.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/scratch_folder.hpp"

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// robot/model.sdf and models/arm/arm.stl.
class RobotFolder : public test_support::ScratchFolder {
 public:
  RobotFolder() {
    fs::create_directories(file("robot"));
    fs::create_directories(file("models/arm"));
    std::ofstream(file("robot/hull.stl")) << "x";
    std::ofstream(file("models/arm/arm.stl")) << "x";
  }
  /// Path that a name leads to, below the folder; or the error.
  std::string find(const std::string& uri, const tools::FolderOptions& options = {}) const {
    const tools::RobotFolders folders(file("robot/model.sdf"), options);
    const std::string* name = sim::intern_file_name(file("robot/model.sdf"));
    try {
      return fs::path(folders.find(uri, "mesh", {name, 7, 0})).lexically_relative(fs::canonical(file(""))).string();
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  }
};

TEST(RobotFolders, FindAFileOfTheRobotByItsPathOrItsModel) {
  const RobotFolder folder;
  EXPECT_EQ(folder.find("hull.stl"), "robot/hull.stl");
  EXPECT_EQ(folder.find("file://hull.stl"), "robot/hull.stl");
  EXPECT_EQ(folder.find("model://robot/hull.stl"), "robot/hull.stl");
}

TEST(RobotFolders, FindModelsInTheFoldersOfTheUser) {
  const RobotFolder folder;
  EXPECT_THAT(folder.find("model://arm/arm.stl"), HasSubstr("model.sdf:7: the folder of model 'arm' is unknown"));
  EXPECT_EQ(folder.find("model://arm/arm.stl", {.packages = {}, .models = {folder.file("models")}}),
            "models/arm/arm.stl");
  EXPECT_EQ(folder.find("arm/arm.stl", {.packages = {}, .models = {folder.file("models")}}), "models/arm/arm.stl");
  EXPECT_EQ(folder.find("package://p/arm.stl", {.packages = {{"p", folder.file("models/arm")}}, .models = {}}),
            "models/arm/arm.stl");
}

TEST(RobotFolders, LeadNowhereElse) {
  const RobotFolder folder;
  for (const std::string uri : {"../models/arm/arm.stl", "/etc/passwd", "model://robot/../models/arm/arm.stl"})
    EXPECT_THAT(folder.find(uri), HasSubstr("mesh must be below the folder of the file")) << uri;
  EXPECT_THAT(folder.find("https://example.org/hull.stl"), HasSubstr("mesh is a web address: nothing is downloaded"));
  EXPECT_THAT(folder.find("model://arm/../../x", {.packages = {}, .models = {folder.file("models")}}),
              HasSubstr("must be below"));
}

}  // namespace
