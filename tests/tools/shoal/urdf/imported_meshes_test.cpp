// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/imported_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/urdf/urdf_texts.hpp"
#include "tools/shoal/urdf/mass_of_shapes.hpp"

namespace {

using sim::Vector3d;
using testing::HasSubstr;

// An L of two boxes, 2 x 2 x 1 without a quarter of 1 x 1 x 1: its convex hull has the volume 3.5.
const std::string l_shape =
    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
    "f 4 3 2\nf 4 2 1\nf 4 1 6\nf 4 6 5\nf 10 8 9\nf 10 7 8\nf 10 12 7\nf 10 11 12\n"
    "f 1 2 8\nf 1 8 7\nf 2 3 9\nf 2 9 8\nf 3 4 10\nf 3 10 9\nf 4 5 11\nf 4 11 10\nf 5 6 12\nf 5 12 11\nf 6 1 7\nf 6 7 "
    "12\n";

/// A robot in a folder with the mesh `meshes/l.obj`.
class MeshFolder : public test_support::ScratchFolder {
 public:
  MeshFolder() {
    std::filesystem::create_directories(file("robot/meshes"));
    std::ofstream(file("robot/meshes/l.obj")) << l_shape;
    std::ofstream(file("outside.obj")) << l_shape;
  }
  /// The robot's link has this shape; `kind` is collision or visual.
  tools::ImportedVehicle vehicle(const std::string& mesh, const std::string& kind = "collision") const {
    const std::string path = file("robot/r.urdf");
    const std::string shape = "<" + kind + "><origin xyz=\"10 0 0\"/><geometry>" + mesh + "</geometry></" + kind + ">";
    return tools::vehicle_of(tools::read_urdf(test::robot_text(test::link_text("a", shape)), path), path);
  }
  std::string error_of(const std::string& mesh, const tools::RobotMeshOptions& options = {}) const {
    tools::ImportedVehicle with_mesh = vehicle(mesh);
    try {
      tools::convert_meshes(with_mesh, options);
      return {};
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  }
};

const std::string l_mesh = "<mesh filename=\"meshes/l.obj\" scale=\"0.1 0.1 0.1\"/>";

TEST(ImportedMeshes, BecomeTheirConvexHull) {
  const MeshFolder folder;
  tools::ImportedVehicle vehicle = folder.vehicle(l_mesh);
  const std::vector<tools::MeshFile> files = tools::convert_meshes(vehicle, {.folder = "r_meshes"});
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(files[0].first, "r_meshes/l_hull.stl");
  EXPECT_EQ(vehicle.bodies[0].parts.at(0).shape.mesh, "r_meshes/l_hull.stl");
  EXPECT_TRUE(sim::is_closed(files[0].second));
  EXPECT_NEAR(sim::solid_of(files[0].second).volume_m3, 3.5e-3, 1e-9);  // single precision of the importer
}

TEST(ImportedMeshes, KeepTheirSurfaceWhenTheyAreOnlyVisual) {
  const MeshFolder folder;
  tools::ImportedVehicle vehicle = folder.vehicle(l_mesh, "visual");
  const std::vector<tools::MeshFile> files = tools::convert_meshes(vehicle, {});
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(files[0].first, "meshes/l.stl");
  EXPECT_NEAR(sim::solid_of(files[0].second).volume_m3, 3e-3, 1e-9);
}

TEST(ImportedMeshes, BecomeTheirBoundingBox) {
  const MeshFolder folder;
  tools::ImportedVehicle vehicle = folder.vehicle("<mesh filename=\"meshes/l.obj\" scale=\"1 -0.5 1\"/>");
  EXPECT_TRUE(tools::convert_meshes(vehicle, {.use = tools::MeshUse::box}).empty());
  const tools::ImportedPart& part = vehicle.bodies[0].parts.at(0);
  EXPECT_EQ(part.shape.shape, sim::PartShape::box);
  EXPECT_TRUE(part.shape.size_m.isApprox(Vector3d(2, 1, 1)));
  EXPECT_TRUE(part.X_BP.translation().isApprox(Vector3d(11, -0.5, 0.5)));
}

TEST(ImportedMeshes, AreLeftOutWithANote) {
  const MeshFolder folder;
  tools::ImportedVehicle vehicle = folder.vehicle(l_mesh);
  EXPECT_TRUE(tools::convert_meshes(vehicle, {.use = tools::MeshUse::none}).empty());
  EXPECT_TRUE(vehicle.bodies[0].parts.empty());
  EXPECT_THAT(test::notes_of(vehicle), HasSubstr("mesh 'meshes/l.obj' is not imported: --meshes none"));
}

TEST(ImportedMeshes, AreFoundInAPackage) {
  const MeshFolder folder;
  const std::string mesh = "<mesh filename=\"package://l_robot/meshes/l.obj\"/>";
  EXPECT_EQ(folder.error_of(mesh),
            folder.file("robot/r.urdf") + ":2: the folder of package 'l_robot' is unknown: give --package l_robot=DIR");
  EXPECT_EQ(folder.error_of(mesh, {.folders = {.packages = {{"l_robot", folder.file("robot")}}}}), "");
}

TEST(ImportedMeshes, MustBeInTheFolderOfTheUrdfOrOfAPackage) {
  const MeshFolder folder;
  const std::string rule = "must be below the folder of the file or a folder of --package NAME=DIR";
  EXPECT_THAT(folder.error_of("<mesh filename=\"../outside.obj\"/>"), HasSubstr("mesh '../outside.obj' " + rule));
  EXPECT_THAT(folder.error_of("<mesh filename=\"file://" + folder.file("outside.obj") + "\"/>"), HasSubstr(rule));
  EXPECT_THAT(folder.error_of("<mesh filename=\"package://p/../outside.obj\"/>",
                              {.folders = {.packages = {{"p", folder.file("robot/meshes")}}}}),
              testing::AnyOf(HasSubstr(rule), HasSubstr("does not exist")));
  std::filesystem::create_symlink(folder.file("outside.obj"), folder.file("robot/link.obj"));
  EXPECT_THAT(folder.error_of("<mesh filename=\"link.obj\"/>"), HasSubstr(rule));
  EXPECT_EQ(
      folder.error_of("<mesh filename=\"../outside.obj\"/>", {.folders = {.packages = {{"all", folder.file("")}}}}),
      "");
}

TEST(ImportedMeshes, NameTheLineOfAFileThatCannotBeRead) {
  const MeshFolder folder;
  EXPECT_EQ(folder.error_of("<mesh filename=\"gone.stl\"/>"),
            folder.file("robot/r.urdf") + ":2: mesh 'gone.stl' does not exist");
}

}  // namespace
