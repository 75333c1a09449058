// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/imported_meshes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <tuple>

#include "sim/config/message_text.hpp"
#include "tools/shoal/mesh/mesh_import.hpp"
#include "tools/shoal/urdf/mass_of_shapes.hpp"
#include "tools/shoal/urdf/shoal_names.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

std::string shown_path(const std::string& path) {
  return "mesh '" + sim::shortened(sim::printable(path), 200) + "'";
}

struct Bounds {
  sim::Vector3d low, high;
};

Bounds bounds_of(const sim::Mesh& mesh) {
  Bounds bounds{mesh.vertices_m.front(), mesh.vertices_m.front()};
  for (const sim::Vector3d& p : mesh.vertices_m) {
    bounds.low = bounds.low.cwiseMin(p);
    bounds.high = bounds.high.cwiseMax(p);
  }
  return bounds;
}

void scale_mesh(const sim::Vector3d& scale, sim::Mesh& mesh) {
  for (sim::Vector3d& p : mesh.vertices_m) p = p.cwiseProduct(scale).eval();
  if (scale.prod() < 0) sim::turn_inside_out(mesh);
}

void become_box(const sim::Mesh& mesh, ImportedPart& part) {
  constexpr double min_length_m = 1e-6;
  const auto [low, high] = bounds_of(mesh);
  part.shape.shape = sim::PartShape::box;
  part.shape.size_m = (high - low).cwiseMax(min_length_m);
  part.X_BP = part.X_BP * sim::Pose(Eigen::Translation3d((low + high) / 2));
}

/// Converts meshes, each file once.
class MeshConversion {
 public:
  MeshConversion(ImportedVehicle& vehicle, const RobotMeshOptions& options)
      : vehicle_(vehicle), options_(options), folders_(vehicle.source, options.folders), names_("mesh", {}) {}

  /// Converts a part.  Returns false, and adds a note, for one that is left out: a mesh file without triangles, and one
  /// that is only visual and cannot be read.  Too many triangles refuse the vehicle.
  bool convert_or_note(ImportedPart& part) {
    const auto leave_out = [&](const std::string& text) {
      vehicle_.notes.push_back({part.shape.place, text});
      return false;
    };
    try {
      if (is_empty_file(part.shape)) return leave_out(shown_path(part.shape.mesh) + " has no triangles: not imported");
      convert(part);
      return true;
    } catch (const sim::ConfigError& error) {
      if (!part.only_visual || triangles_ > max_triangles) throw;
      const std::string text = error.what();  // with its place, `FILE:LINE: `
      return leave_out(text.substr(text.find(": ", part.shape.place.file->size()) + 2) +
                       ": this <visual> is not imported");
    }
  }
  void convert(ImportedPart& part) {
    const sim::Mesh& mesh = read(part.shape);
    if (options_.use == MeshUse::box) return become_box(mesh, part);
    std::optional<std::string>& file = written_[{key_of(part.shape), part.only_visual}];
    if (!file) {
      std::optional<sim::Mesh> solid = part.only_visual ? mesh : convex_hull(outermost_points(mesh.vertices_m));
      if (!solid) {
        vehicle_.notes.push_back(
            {part.shape.place, shown_path(part.shape.mesh) + " is flat: its bounding box replaces its convex hull"});
        return become_box(mesh, part);
      }
      std::vector<ImportNote> ignored;
      const std::string stem =
          std::filesystem::path(part.shape.mesh).stem().string() + (part.only_visual ? "" : "_hull");
      // A name is looked up by its original, which here is not unique.
      const std::string name = names_.add(plain_name(stem), part.shape.place, ignored);
      file = options_.folder + "/" + name + ".stl";
      files_.emplace_back(*file, std::move(*solid));
    }
    part.shape.mesh = *file;
  }
  std::vector<MeshFile> take_files() { return std::move(files_); }

 private:
  using Key = std::tuple<std::string, double, double, double>;

  std::string path_of(const RobotShape& shape) const {
    return folders_.find(shape.mesh, shown_path(shape.mesh), shape.place);
  }
  Key key_of(const RobotShape& shape) const {
    return {path_of(shape), shape.scale.x(), shape.scale.y(), shape.scale.z()};
  }
  /// Returns whether a file exists and is a mesh without triangles, as programs write it: nothing but blanks, or an STL
  /// of only its head.
  bool is_empty_file(const RobotShape& shape) const {
    constexpr std::uintmax_t max_bytes = 1024;
    const std::string path = path_of(shape);
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(path, error);
    if (error || bytes > max_bytes) return false;
    std::string text(bytes, ' ');
    if (!std::ifstream(path, std::ios::binary).read(text.data(), static_cast<std::streamsize>(bytes))) return false;
    text.erase(0, text.find_first_not_of(" \t\r\n"));
    if (text.empty()) return true;
    const std::string extension = fs::path(shape.mesh).extension().string();
    if (extension != ".stl" && extension != ".STL") return false;
    constexpr std::uintmax_t header = 80;  // of binary STL; behind it the number of triangles
    if (bytes == header || (bytes == header + 4 && text.ends_with(std::string(4, '\0')))) return true;
    return text.starts_with("solid") && text.find("facet") == std::string::npos && text.find('\0') == std::string::npos;
  }
  const sim::Mesh& read(const RobotShape& shape) {
    const Key key = key_of(shape);
    const auto known = meshes_.find(key);
    if (known != meshes_.end()) return known->second;
    // A file that cannot be read may take a minute: it is tried once.
    std::string& failure = failures_[std::get<0>(key)];
    if (failure.empty()) {
      try {
        // Like other readers of URDF, coordinates are taken as in the file, whatever axis points up in it.
        sim::Mesh mesh = import_mesh(std::get<0>(key), {.scale = 1, .up = 'z'});
        triangles_ += mesh.triangles.size();
        if (triangles_ > max_triangles) throw sim::MeshError("is one too many: all have more than 8 million triangles");
        scale_mesh(shape.scale, mesh);
        return meshes_.emplace(key, std::move(mesh)).first->second;
      } catch (const sim::MeshError& error) {
        failure = error.what();
      }
    }
    sim::throw_config_error(shape.place, "", shown_path(shape.mesh) + ' ' + failure);
  }

  ImportedVehicle& vehicle_;
  const RobotMeshOptions& options_;
  RobotFolders folders_;
  ShoalNames names_;
  static constexpr std::size_t max_triangles = 2 * sim::max_mesh_triangles;
  std::size_t triangles_ = 0;
  std::map<Key, sim::Mesh> meshes_;
  std::map<std::string, std::string> failures_;  ///< why a file could not be read; empty: it could
  std::map<std::pair<Key, bool>, std::optional<std::string>> written_;
  std::vector<MeshFile> files_;
};

}  // namespace

std::vector<MeshFile> convert_meshes(ImportedVehicle& vehicle, const RobotMeshOptions& options) {
  MeshConversion conversion(vehicle, options);
  for (ImportedBody& body : vehicle.bodies) {
    if (options.use == MeshUse::none) {
      std::erase_if(body.parts, [&](const ImportedPart& part) {
        if (part.shape.shape != sim::PartShape::mesh) return false;
        vehicle.notes.push_back({part.shape.place, shown_path(part.shape.mesh) + " is not imported: --meshes none"});
        return true;
      });
      continue;
    }
    std::vector<ImportedPart> kept;
    for (ImportedPart& part : body.parts)
      if (part.shape.shape != sim::PartShape::mesh || conversion.convert_or_note(part)) kept.push_back(std::move(part));
    body.parts = std::move(kept);
  }
  return conversion.take_files();
}

}  // namespace tools
