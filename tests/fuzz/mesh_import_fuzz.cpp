#include <array>

#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tools/shoal/mesh_import.hpp"

// Meshes that `shoal mesh` has Assimp read.  Assimp works in a child process and may crash there; we may not.

SHOAL_FUZZ_TARGET(mesh_import) {
  constexpr std::array endings{"dae", "gltf", "glb", "ply", "3ds", "off", "obj", "stl", "x3d", "fbx"};
  fuzz::Reader reader(input);
  const std::string name = std::string("mesh.") + endings[reader.below(endings.size())];
  const std::string path = fuzz::write_scratch(name, reader.rest());
  tools::MeshImportOptions options;
  options.timeout_s = 1;
  fuzz::allow<sim::MeshError>([&] {
    const sim::Mesh mesh = tools::import_mesh(path, options);
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t corner : triangle)
        fuzz::require(corner < mesh.vertices_m.size(), "triangles name vertices that are there");
  });
}
