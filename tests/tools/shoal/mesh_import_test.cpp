#include "tools/shoal/mesh_import.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace {

namespace fs = std::filesystem;

/// A folder that is removed again.
class MeshImport : public testing::Test {
 protected:
  MeshImport()
      : folder_(fs::temp_directory_path() /
                ("shoal_mesh_import_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    fs::create_directories(folder_);
  }
  ~MeshImport() override { fs::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  template <typename Action>
  static std::string error_of(Action&& action) {
    try {
      action();
    } catch (const sim::MeshError& error) {
      return error.what();
    }
    return "no error";
  }
  fs::path folder_;
};

// A tetrahedron with corners at 0 and at 1, 2 and 3 along the axes: volume 1.
const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

TEST_F(MeshImport, ReadsAFormatTheSimulatorDoesNotAndWritesThoseItDoes) {
  const sim::Mesh mesh = tools::import_mesh(file("t.ply", ply), 2, false);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_TRUE(sim::is_closed(mesh));
  EXPECT_NEAR(sim::solid_of(mesh).volume_m3, 8, 1e-6);
  for (const char* name : {"t.stl", "t.obj"}) {
    const std::string out = (folder_ / name).string();
    tools::save_mesh(mesh, out);
    const sim::Mesh again = sim::load_mesh(out, 1);
    EXPECT_EQ(again.triangles.size(), 4u);
    EXPECT_TRUE(sim::is_closed(again));
    EXPECT_NEAR(sim::solid_of(again).volume_m3, 8, 1e-6);
  }
}

TEST_F(MeshImport, YCanBeUp) {
  const sim::Mesh mesh = tools::import_mesh(file("t.ply", ply), 1, true);
  sim::Vector3d low = sim::Vector3d::Zero(), high = low;
  for (const sim::Vector3d& p : mesh.vertices_m) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  EXPECT_EQ(high, sim::Vector3d(1, 0, 2));
  EXPECT_EQ(low, sim::Vector3d(0, -3, 0));
  EXPECT_NEAR(sim::solid_of(mesh).volume_m3, 1, 1e-6);
}

TEST_F(MeshImport, ErrorsSayWhatIsWrong) {
  EXPECT_EQ(error_of([&] { tools::import_mesh("/nowhere/hull.dae", 1, false); }), "does not exist");
  EXPECT_THAT(error_of([&] { tools::import_mesh(file("text.txt", "hello"), 1, false); }),
              testing::StartsWith("is no mesh that can be read: "));
  EXPECT_EQ(error_of([&] { tools::import_mesh(file("cut.ply", ply.substr(0, ply.size() - 30)), 1, false); }),
            "has no triangles");
  // Assimp 5.2 would look for the end of this header for ever.
  EXPECT_EQ(error_of([&] { tools::import_mesh(file("cut.PLY", ply.substr(0, 150)), 1, false); }),
            "is cut off: its header has no end");
  EXPECT_EQ(error_of([&] { tools::save_mesh({}, (folder_ / "hull.dae").string()); }), "must end in .stl or .obj");
  EXPECT_EQ(error_of([&] { tools::save_mesh({}, "/nowhere/hull.stl"); }), "cannot be written");
}

}  // namespace
