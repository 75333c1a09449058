// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <iostream>
#include <memory>

#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/mesh/mesh_import.hpp"

namespace tools {

namespace {

struct MeshOptions {
  std::string file;
  std::string out;
  std::string up;
  MeshImportOptions import;
};

std::string list_text_of(const sim::Vector3d& v) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x(), v.y(), v.z());
}

void print(const std::string& file, const sim::Mesh& mesh) {
  sim::Vector3d low = mesh.vertices_m.front(), high = low;
  for (const sim::Vector3d& p : mesh.vertices_m) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  std::cout << fmt::format("{}: {} triangles, {} vertices\n", file, mesh.triangles.size(), mesh.vertices_m.size())
            << fmt::format("bounds: {} to {} m, size {} m\n", list_text_of(low), list_text_of(high),
                           list_text_of(high - low));
  if (!sim::is_closed(mesh)) {
    std::cout << "surface: open; it can be used in a world, but has no mass\n";
    return;
  }
  const sim::MeshSolid solid = sim::solid_of(mesh);
  std::cout << fmt::format("surface: closed, volume {:.6g} m3, centroid {} m{}\n", std::abs(solid.volume_m3),
                           list_text_of(solid.centroid_m),
                           solid.volume_m3 < 0 ? "; inside out, which Shoal corrects" : "");
}

int describe_and_convert(const MeshOptions& options) {
  std::string about = options.file;
  MeshImportOptions import = options.import;
  if (!options.up.empty()) import.up = options.up[0];
  try {
    const sim::Mesh mesh = import_mesh(options.file, import);
    print(options.file, mesh);
    about = options.out;
    if (!options.out.empty()) save_mesh(mesh, options.out);
  } catch (const sim::MeshError& error) {
    std::cerr << fmt::format("mesh '{}' {}\n", about, error.what());
    return exit_usage;
  }
  return exit_ok;
}

}  // namespace

static void add_mesh_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("mesh");
  const auto options = std::make_shared<MeshOptions>();
  add_log_level_option(*command);
  // Options.
  command->add_option("FILE", options->file, "mesh of any format that Assimp reads: DAE, FBX, GLB, OBJ, PLY, STL, ...")
      ->required();
  command->add_option("--out", options->out, "output file, .stl (binary) or .obj")->type_name("FILE");
  command
      ->add_option("--scale", options->import.scale,
                   "factor from the units of the file to meters; Collada's own unit is applied")
      ->type_name("FACTOR")
      ->check(number_from(1e-9, 1e9))
      ->capture_default_str();
  command
      ->add_option(
          "--up", options->up,
          "axis of the file that points up, y or z; default: y in glTF, what the file says in Collada, z in others")
      ->type_name("AXIS")
      ->check(one_of({"y", "z"}).description(""));
  command->add_option("--timeout", options->import.timeout_s, "time limit for reading the file, s")
      ->type_name("S")
      ->check(number_from(0.01, 86400))
      ->capture_default_str();
  // End of the help and action.
  command_line::set_help_end(*command,
                             {{"shoal mesh hull.stl", "shoal mesh hull.glb --out hull.stl",
                               "shoal mesh rock_mm.fbx --scale 0.001 --out rock.obj"},
                              {{0, "success"}, {2, "wrong usage, or the mesh cannot be read, used or written"}},
                              {"Worlds and vehicles read STL and OBJ.  A mesh with mass must be closed."}});
  command->callback([options, &exit_code] { exit_code = describe_and_convert(*options); });
}

SHOAL_COMMAND(make, "mesh", "Describe a mesh file, and convert it for worlds and vehicles", add_mesh_command);

}  // namespace tools
