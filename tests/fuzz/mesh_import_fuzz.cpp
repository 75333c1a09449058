// SPDX-License-Identifier: BSD-3-Clause
#include <pthread.h>
#include <signal.h>

#include <array>

#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tools/shoal/mesh/mesh_import.hpp"

// Meshes that `shoal mesh` has Assimp read.  Assimp works in a child process and may crash there; we may not.

// Of the sanitizers, where there are any.
extern "C" __attribute__((weak)) void __sanitizer_set_death_callback(void (*callback)());

namespace {

/// A crash of the child is none of ours: libFuzzer must not keep its input.
void remove_handlers() {
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) signal(number, SIG_DFL);
  if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(nullptr);
}

}  // namespace

SHOAL_FUZZ_TARGET(mesh_import) {
  [[maybe_unused]] static const int registered = pthread_atfork(nullptr, nullptr, remove_handlers);
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
