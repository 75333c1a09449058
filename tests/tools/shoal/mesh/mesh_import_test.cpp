// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/mesh/mesh_import.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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
  const sim::Mesh mesh = tools::import_mesh(file("t.ply", ply), {.scale = 2});
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
  const sim::Mesh mesh = tools::import_mesh(file("t.ply", ply), {.up = 'y'});
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
  EXPECT_EQ(error_of([&] { tools::import_mesh("/nowhere/hull.dae", {}); }), "does not exist");
  EXPECT_THAT(error_of([&] { tools::import_mesh(file("text.txt", "hello"), {}); }),
              testing::StartsWith("is not a readable mesh: "));
  EXPECT_EQ(error_of([&] { tools::import_mesh(file("cut.ply", ply.substr(0, ply.size() - 30)), {}); }),
            "has no triangles");
  EXPECT_EQ(error_of([&] { tools::save_mesh({}, (folder_ / "hull.dae").string()); }), "must end in .stl or .obj");
  EXPECT_EQ(error_of([&] { tools::save_mesh({}, "/nowhere/hull.stl"); }), "cannot be written");
}

TEST_F(MeshImport, FilesThatCrashTheImporterAreErrors) {
  EXPECT_EQ(error_of([&] { tools::import_mesh(file("cut.off", "OFF\n4 2 0\n"), {.timeout_s = 20}); }),
            "cannot be read: the importer failed on this file");
  const std::string wrong_index = ply.substr(0, ply.size() - 2) + "9999999\n";
  EXPECT_THAT(
      error_of([&] { tools::import_mesh(file("index.ply", wrong_index), {.timeout_s = 20}); }),
      testing::AnyOf("cannot be read: the importer failed on this file", "has a face with a vertex that does not exist",
                     testing::StartsWith("is not a readable mesh: ")));
}

TEST_F(MeshImport, AFileThatTakesTooLongIsAnError) {
  // Assimp 5.2 looks for the end of this header forever.
  EXPECT_EQ(error_of([&] { tools::import_mesh(file("cut.PLY", ply.substr(0, 150)), {.timeout_s = 0.3}); }),
            "cannot be read: the importer took longer than 0.3 s");
}

TEST_F(MeshImport, StlOfNumbersThatFloatCannotHoldIsAnError) {
  const sim::Mesh mesh = tools::import_mesh(file("t.ply", ply), {.scale = 1e39});
  const std::string out = (folder_ / "t.stl").string();
  EXPECT_EQ(error_of([&] { tools::save_mesh(mesh, out); }), "cannot hold numbers this large; scale it, or write .obj");
  EXPECT_FALSE(fs::exists(out));
}

std::string collada(const std::string& asset) {
  return "<?xml version=\"1.0\"?><COLLADA version=\"1.4.1\"><asset>" + asset +
         "</asset><library_geometries><geometry id=\"m\"><mesh><source id=\"p\"><float_array id=\"pa\" count=\"9\">"
         "0 0 0 1 0 0 0 2 3</float_array><technique_common><accessor source=\"#pa\" count=\"3\" stride=\"3\">"
         "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>"
         "</accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/>"
         "</vertices><triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p>"
         "</triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node>"
         "<instance_geometry url=\"#m\"/></node></visual_scene></library_visual_scenes><scene>"
         "<instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

// One triangle, (0, 0, 0), (1, 0, 0), (0, 2, 3).
const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 2 3\nf 1 2 3\n";
const std::string gltf =
    R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "buffers": [{"byteLength": 42, "uri":
 "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAEBAAAABAAIA"}],
 "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 2, 3]},
 {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}]})";

TEST_F(MeshImport, UpIsWhereTheFormatSays) {
  const auto third_corner = [&](const std::string& name, const std::string& text, std::optional<char> up) {
    const sim::Mesh mesh = tools::import_mesh(file(name, text), {.up = up});
    const auto it = std::find_if(mesh.vertices_m.begin(), mesh.vertices_m.end(),
                                 [](const sim::Vector3d& p) { return p.z() != 0 || p.y() != 0; });
    return it == mesh.vertices_m.end() ? sim::Vector3d(sim::Vector3d::Zero()) : *it;
  };
  const auto near = [](double x, double y, double z) {
    return testing::Truly([=](const sim::Vector3d& p) { return (p - sim::Vector3d(x, y, z)).norm() < 1e-6; });
  };
  EXPECT_THAT(third_corner("t.obj", obj, {}), near(0, 2, 3));
  EXPECT_THAT(third_corner("t.obj", obj, 'y'), near(0, -3, 2));
  EXPECT_THAT(third_corner("t.gltf", gltf, {}), near(0, -3, 2));
  EXPECT_THAT(third_corner("t.gltf", gltf, 'z'), near(0, 2, 3));
  const std::string z_up = collada("<unit name=\"cm\" meter=\"0.01\"/><up_axis>Z_UP</up_axis>");
  EXPECT_THAT(third_corner("z.dae", z_up, {}), near(0, 0.02, 0.03));
  EXPECT_THAT(third_corner("y.dae", collada("<up_axis>Y_UP</up_axis>"), {}), near(0, -3, 2));
  EXPECT_THAT(third_corner("y.dae", collada("<up_axis>Y_UP</up_axis>"), 'z'), near(0, 2, 3));
}

}  // namespace
