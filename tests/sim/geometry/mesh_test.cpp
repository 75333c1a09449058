// SPDX-License-Identifier: BSD-3-Clause
#include "sim/geometry/mesh.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "tests/scratch_folder.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;
using sim::Mesh;
using sim::MeshError;

/// A box with its center at `c`.
Mesh box_mesh(const Vector3d& size, const Vector3d& c) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_m.push_back(c + 0.5 * size.cwiseProduct(Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

std::string obj_of(const Mesh& mesh) {
  std::string text = "# a box\no box\n";
  for (const Vector3d& p : mesh.vertices_m)
    text += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  for (const auto& t : mesh.triangles)
    text +=
        "f " + std::to_string(t[0] + 1) + "/1/1 " + std::to_string(t[1] + 1) + "//1 " + std::to_string(t[2] + 1) + "\n";
  return text;
}

std::string ascii_stl_of(const Mesh& mesh) {
  std::string text = "solid a box\n";
  for (const auto& t : mesh.triangles) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const auto corner : t) {
      const Vector3d& p = mesh.vertices_m[corner];
      text += "   vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid a box\n";
}

std::string binary_stl_of(const Mesh& mesh) {
  std::string bytes(80, ' ');
  const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) put(0.0f);
    for (const auto corner : t)
      for (int i = 0; i < 3; ++i) put(static_cast<float>(mesh.vertices_m[corner][i]));
    put(std::uint16_t{0});
  }
  return bytes;
}

template <typename Action>
std::string error_of(Action&& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

/// A file that is removed again.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& bytes) : path_(folder_.file(name)) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  const std::string& path() const { return path_; }

 private:
  test_support::ScratchFolder folder_;
  std::string path_;
};

TEST(Mesh, IsReadFromEachFormat) {
  const Mesh box = box_mesh({1, 2, 3}, {0.5, 0, 0});
  for (const Mesh& read :
       {sim::parse_obj(obj_of(box)), sim::parse_stl(ascii_stl_of(box)), sim::parse_stl(binary_stl_of(box))}) {
    EXPECT_EQ(read.triangles.size(), 12u);
    EXPECT_EQ(read.vertices_m.size(), 8u);
    EXPECT_TRUE(sim::is_closed(read));
    EXPECT_NEAR(sim::solid_of(read).volume_m3, 6, 1e-12);
  }
}

TEST(Mesh, BinaryStlMayBeginWithSolid) {
  std::string bytes = binary_stl_of(box_mesh({1, 1, 1}, {0, 0, 0}));
  bytes.replace(0, 5, "solid");
  EXPECT_EQ(sim::parse_stl(bytes).triangles.size(), 12u);
}

/// Replaces every `from`.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

TEST(Mesh, ReadsAsciiStlHoweverItIsWritten) {
  const std::string plain = ascii_stl_of(box_mesh({1, 2, 3}, {0, 0, 0}));
  std::string capitals = plain;
  for (char& c : capitals) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  const std::string two = plain + "\n" + plain;
  for (const std::string& text :
       {capitals, "\n  \r\n" + plain, "\xef\xbb\xbf" + plain, replaced(plain, "\n", "\r\n"),
        replaced(plain, "\n", "\r"), replaced(plain, "\n", " "), replaced(plain, "\n", "\t\n"),
        replaced(plain, "normal 0 0 0", ""), replaced(plain, "normal 0 0 0\n", "normal -nan(ind) 0 1.#QNAN "),
        replaced(plain, "a box", "C:\\facet vertex"), replaced(plain, "vertex 0", "vertex +0"),
        replaced(plain, " a box", ""), two}) {
    const Mesh read = sim::parse_stl(text);
    EXPECT_NEAR(sim::solid_of(read).volume_m3, text == two ? 12 : 6, 1e-12) << text.substr(0, 200);
    EXPECT_EQ(read.vertices_m.size(), 8u);
  }
}

TEST(Mesh, ReadsBinaryStlWithOddHeaderCountOrEnd) {
  const std::string plain = binary_stl_of(box_mesh({1, 2, 3}, {0, 0, 0}));
  std::string solid = plain, no_count = plain, all_ones = plain;
  solid.replace(0, 20, "solid facet endsolid");
  no_count.replace(80, 4, 4, '\0');
  all_ones.replace(80, 4, 4, '\xff');
  for (const std::string& bytes : {solid, solid + "\n", solid + std::string(17, 'x'), plain + std::string(3, '\0'),
                                   no_count, all_ones, "\xef\xbb\xbf" + plain.substr(3)})
    EXPECT_NEAR(sim::solid_of(sim::parse_stl(bytes)).volume_m3, 6, 1e-12);
  EXPECT_EQ(error_of([&] { sim::parse_stl(no_count + "x"); }), "has no triangles");
}

TEST(Mesh, ReadsObjHoweverItIsWritten) {
  const std::string plain = obj_of(box_mesh({1, 2, 3}, {0, 0, 0}));
  const std::size_t faces = plain.find("f ");
  const std::string with_all = "mtllib not_there.mtl\nvt 0 0\nvn 0 0 1\ng a b\ns off\nusemtl red\nl 1 2\n" +
                               replaced(plain, "\nf", "\nl 1 2\nf");
  for (const std::string& text :
       {with_all, replaced(plain, "\n", "\r\n"), replaced(plain, "\n", "\r"), "\xef\xbb\xbf" + plain,
        replaced(plain, "/1/1", "/1"), replaced(plain, "/1/1", ""), replaced(plain, "\n", " # text\n"),
        replaced(plain, "//1", "//1 \\\n"), replaced(plain, "/1/1 ", "/1/1\\\r\n "), replaced(plain, "f ", "f\t "),
        plain.substr(0, faces - 1) + " 0.5 0.5 0.5\n" + plain.substr(faces),  // a color behind the last vertex
        plain.substr(faces) + plain.substr(0, faces)}) {                      // faces first
    const Mesh read = sim::parse_obj(text);
    EXPECT_NEAR(sim::solid_of(read).volume_m3, 6, 1e-12) << text.substr(0, 200);
    EXPECT_EQ(read.triangles.size(), 12u);
  }
  // A continued line counts as those of the file.
  EXPECT_EQ(error_of([] { sim::parse_obj("v 0 0 \\\n0\nf 1 \\\n 2 3\n"); }),
            "is not a mesh: line 4: must have numbers of the 1 vertices");
  EXPECT_EQ(error_of([] { sim::parse_obj("v 0 0 0\nf -2 -1 1\n"); }),
            "is not a mesh: line 2: must have numbers of the 1 vertices");
}

TEST(Mesh, ObjHasPolygonsAndIndicesFromTheEnd) {
  const Mesh mesh = sim::parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\r\nv 0 1 0\nf -4 -3 -2 -1\n");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_FALSE(sim::is_closed(mesh));
}

TEST(Mesh, SolidHasTheMomentsOfABoxWhereverItIs) {
  for (const Vector3d& c : {Vector3d(0, 0, 0), Vector3d(1000, -2000, 500)}) {
    const sim::MeshSolid solid = sim::solid_of(box_mesh({1, 2, 3}, c));
    EXPECT_NEAR(solid.volume_m3, 6, 1e-12);
    EXPECT_TRUE(solid.centroid_m.isApprox(c, 1e-14) || (solid.centroid_m - c).norm() < 1e-12);
    const sim::Matrix3d expected = Vector3d(6 * 13.0 / 12, 6 * 10.0 / 12, 6 * 5.0 / 12).asDiagonal();
    EXPECT_TRUE(solid.inertia.isApprox(expected, 1e-12)) << solid.inertia;
  }
}

TEST(Mesh, TurnedInsideOutHasNegativeVolume) {
  Mesh mesh = box_mesh({1, 1, 1}, {0, 0, 0});
  sim::turn_inside_out(mesh);
  EXPECT_TRUE(sim::is_closed(mesh));
  EXPECT_NEAR(sim::solid_of(mesh).volume_m3, -1, 1e-14);
}

TEST(Mesh, ErrorsSayWhatIsWrong) {
  EXPECT_EQ(error_of([] { sim::parse_stl("hello"); }), "is not a mesh: too short for an STL file");
  EXPECT_EQ(error_of([] { sim::parse_stl(std::string(200, '\xff')); }),
            "says it has 4294967295 triangles, but there is room for 2");
  EXPECT_EQ(error_of([] { sim::parse_stl(std::string(84, '\0')); }), "has no triangles");
  EXPECT_EQ(error_of([] { sim::parse_stl("solid x\nendsolid x\n"); }), "has no triangles");
  EXPECT_EQ(error_of([] { sim::parse_stl("solid gold\nis heavy\n"); }), "is not a mesh: line 2: unknown word");
  EXPECT_EQ(error_of([] { sim::parse_stl("solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2 pi\n"); }),
            "is not a mesh: line 4: must have a number here");
  EXPECT_EQ(error_of([] { sim::parse_stl("solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2 nan\n"); }),
            "has a vertex that is not finite");
  EXPECT_EQ(error_of([] { sim::parse_stl("solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\n"); }),
            "ends inside a facet");
  EXPECT_EQ(error_of([] { sim::parse_stl("solid x\nfacet normal 0 0 1\n"); }),
            "is truncated: it ends without 'endsolid'");
  EXPECT_EQ(error_of([] {
              const std::string whole = ascii_stl_of(box_mesh({1, 1, 1}, {0, 0, 0}));
              sim::parse_stl(whole.substr(0, whole.rfind("endsolid")));
            }),
            "is truncated: it ends without 'endsolid'");
  EXPECT_EQ(error_of([] {
              const std::string whole = binary_stl_of(box_mesh({1, 1, 1}, {0, 0, 0}));
              sim::parse_stl(whole.substr(0, whole.size() - 20));
            }),
            "says it has 12 triangles, but there is room for 11");
  EXPECT_EQ(error_of([] { sim::parse_obj("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"); }), "has no triangle with an area");
  EXPECT_EQ(error_of([] { sim::parse_obj("v 0 0\n"); }), "is not a mesh: line 1: must have a number here");
  EXPECT_EQ(error_of([] { sim::parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"); }),
            "is not a mesh: line 4: must have numbers of the 3 vertices");
  EXPECT_EQ(error_of([] { sim::parse_obj("v 0 0 0\nf 0 1 1\n"); }),
            "is not a mesh: line 2: must have numbers of the 1 vertices");
  EXPECT_EQ(error_of([] { sim::parse_obj("v 0 0 0\nf 1e99 1 1\n"); }),
            "is not a mesh: line 2: must have numbers of the 1 vertices");
  EXPECT_EQ(error_of([] { sim::parse_obj("v 0 0 inf\n"); }), "has a vertex that is not finite");
  EXPECT_EQ(error_of([] { sim::parse_obj("v 0 0 0\n"); }), "has no triangles");
  EXPECT_EQ(error_of([] { sim::parse_obj(""); }), "has no triangles");
  EXPECT_EQ(error_of([] { sim::load_mesh("/nowhere/hull.stl", 1); }), "does not exist");
  EXPECT_EQ(error_of([] { sim::load_mesh("/tmp", 1); }), "must end in .stl or .obj");
  std::string nan_stl = binary_stl_of(box_mesh({1, 1, 1}, {0, 0, 0}));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(nan_stl.data() + 84 + 12, &nan, 4);
  EXPECT_EQ(error_of([&] { sim::parse_stl(nan_stl); }), "has a vertex that is not finite");
}

PartConfig mesh_part(const std::string& path, double density_kgpm3) {
  PartConfig part;
  part.shape = PartShape::mesh;
  part.mesh = path;
  part.place = {sim::intern_file_name("boat.yaml"), 7, 3};
  if (density_kgpm3 > 0) part.density_kgpm3 = density_kgpm3;
  return part;
}

TEST(Mesh, MoreThanFourMillionTrianglesAreRefusedWhereverTheyAreCounted) {
  // All alike, so that they take little memory.
  std::string stl(84 + 50 * (sim::max_mesh_triangles + 1), '\0');
  for (const std::uint32_t count : {static_cast<std::uint32_t>(sim::max_mesh_triangles + 1), 0u, 0xffffffffu}) {
    std::memcpy(stl.data() + 80, &count, sizeof count);
    EXPECT_EQ(error_of([&] { sim::parse_stl(stl); }),
              "has more than 4 million triangles: make a coarser one for collision");
  }
  std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (std::size_t i = 0; i <= sim::max_mesh_triangles; ++i) obj += "f 1 2 3\n";
  EXPECT_EQ(error_of([&] { sim::parse_obj(obj); }),
            "has more than 4 million triangles: make a coarser one for collision");
}

TEST(Mesh, TrianglesWithoutAreaStayOutOrDoNoHarm) {
  // Two corners alike: left out.
  EXPECT_EQ(sim::parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n").triangles.size(), 1u);
  // Three in a row: stays, and what falls on it stays finite.
  const TemporaryFile file("sliver.obj",
                           "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 0 0\nf 1 2 3\nf 1 3 4\nf 1 5 3\n");
  PartConfig part;
  part.shape = PartShape::mesh;
  part.mesh = file.path();
  const auto world = make_world();
  add(*world, body("table", {part}), Pose::Identity(), Motion::fixed);
  const sim::Body& ball = add(*world, body("ball", {sphere(0.2, 1)}), translation(0, 0, 0.3));
  for (int step = 0; step < 200; ++step) world->step(step);
  EXPECT_NEAR(ball.X_WB().translation().z(), 0.2, 2e-3);
}

TEST(MeshPart, HasTheMassOfTheSameBoxAndRestsLikeIt) {
  // Inside out: the loader turns it round.  Scale 0.1: written in decimeters.
  Mesh box = box_mesh({10, 20, 4}, {1, 0, 0});
  sim::turn_inside_out(box);
  const TemporaryFile file("box.stl", binary_stl_of(box));
  PartConfig part = mesh_part(file.path(), 500);
  part.scale = 0.1;
  const auto world = make_world();
  add_ground(*world);
  const sim::Body& hull = add(*world, body("hull", {part}), translation(0, 0, 0.25));
  EXPECT_NEAR(hull.mass_kg(), 500 * 1 * 2 * 0.4, 1e-4);  // STL holds floats
  EXPECT_TRUE(hull.p_BC().isApprox(Vector3d(0.1, 0, 0), 1e-6));
  for (int i = 0; i < 200; ++i) world->step(i);
  EXPECT_NEAR(hull.X_WB().translation().z(), 0.2 - 0.0005, 3e-4);
}

TEST(MeshPart, OpenSurfaceCannotGiveMassButCanStandFixed) {
  const TemporaryFile file("square.obj", "v -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\nf 1 2 3 4\n");
  const auto world = make_world();
  const int group = world->add_group("boat");
  const std::string error =
      error_of([&] { world->add_body(group, body("hull", {mesh_part(file.path(), 500)}), Pose::Identity()); });
  EXPECT_NE(error.find("boat.yaml:7:3: body 'boat/hull': part 1: mesh '"), std::string::npos) << error;
  EXPECT_NE(error.find("has an open surface"), std::string::npos) << error;
  add(*world, body("deck", {mesh_part(file.path(), 0)}), Pose::Identity(), Motion::fixed);
  const sim::Body& ball = add(*world, body("ball", {sphere(0.2, 1)}), translation(1, 0.5, 0.25));
  for (int i = 0; i < 200; ++i) world->step(i);
  EXPECT_NEAR(ball.X_WB().translation().z(), 0.2 - 0.0005, 3e-4);
}

TEST(MeshPart, MissingFileIsAConfigErrorAtThePart) {
  const auto world = make_world();
  const int group = world->add_group("boat");
  PartConfig part = mesh_part("hull.stl", 0);
  part.directory = "/nowhere";
  part.name = "shell";
  EXPECT_EQ(error_of([&] { world->add_body(group, body("hull", {part}), Pose::Identity(), Motion::fixed); }),
            "boat.yaml:7:3: body 'boat/hull': part 'shell': mesh '/nowhere/hull.stl' does not exist");
  EXPECT_TRUE(world->bodies().empty());
  EXPECT_TRUE(world->parts().empty());
}

}  // namespace
