// SPDX-License-Identifier: BSD-3-Clause
#include "sim/geometry/mesh.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Meshes that the simulator reads itself: STL and OBJ.

SHOAL_FUZZ_TARGET(mesh) {
  fuzz::Reader reader(input);
  const bool is_stl = reader.below(2) == 0;
  const std::string_view bytes = fuzz::text_of(reader.rest());
  fuzz::allow<sim::MeshError>([&] {
    sim::Mesh mesh = is_stl ? sim::parse_stl(bytes) : sim::parse_obj(bytes);
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t corner : triangle)
        fuzz::require(corner < mesh.vertices_m.size(), "triangles name vertices that are there");
    if (!sim::is_closed(mesh)) return;
    sim::solid_of(mesh);
    sim::turn_inside_out(mesh);
    fuzz::require(sim::is_closed(mesh), "a closed mesh stays closed when it is turned over");
  });
}
