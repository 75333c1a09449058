#include "tools/shoal/mesh_import.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <spdlog/fmt/fmt.h>

#include <array>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <fstream>
#include <map>

namespace tools {

namespace {

constexpr std::uintmax_t max_file_bytes = 1u << 30;

/// The triangles of one of Assimp's meshes; vertices at one place are one vertex.
void add_triangles(const aiMesh& from, double scale, bool y_up, sim::Mesh& mesh,
                   std::map<std::array<double, 3>, std::uint32_t>& numbers) {
  std::vector<std::uint32_t> number_of;
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    const aiVector3D& v = from.mVertices[i];
    sim::Vector3d p = y_up ? sim::Vector3d(v.x, -v.z, v.y) : sim::Vector3d(v.x, v.y, v.z);
    p = p * scale + sim::Vector3d::Zero();
    if (!p.allFinite()) throw sim::MeshError("has a vertex that is not finite");
    const auto [at, added] =
        numbers.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(mesh.vertices_m.size()));
    if (added) mesh.vertices_m.push_back(p);
    number_of.push_back(at->second);
  }
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines
    const std::uint32_t a = number_of[face.mIndices[0]], b = number_of[face.mIndices[1]],
                        c = number_of[face.mIndices[2]];
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
  }
  if (mesh.triangles.size() > sim::max_mesh_triangles) throw sim::MeshError("has more than 4 million triangles");
}

/// Assimp 5.2 never returns from a PLY file whose header is cut off.
void check_ply_header(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  if (extension != ".ply") return;
  std::string head(1 << 16, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (head.find("end_header") == std::string::npos) throw sim::MeshError("is cut off: its header has no end");
}

std::string binary_stl(const sim::Mesh& mesh) {
  std::string bytes(80, ' ');
  const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    const sim::Vector3d &a = mesh.vertices_m[t[0]], &b = mesh.vertices_m[t[1]], &c = mesh.vertices_m[t[2]];
    const sim::Vector3d normal = (b - a).cross(c - a).stableNormalized();
    for (const sim::Vector3d& v : {normal, a, b, c})
      for (int i = 0; i < 3; ++i) put(static_cast<float>(v[i]));
    put(std::uint16_t{0});
  }
  return bytes;
}

std::string obj_text(const sim::Mesh& mesh) {
  std::string text;
  for (const sim::Vector3d& p : mesh.vertices_m) text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
  for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

}  // namespace

sim::Mesh import_mesh(const std::string& path, double scale, bool y_up) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw sim::MeshError("does not exist");
  if (std::filesystem::file_size(path, error) > max_file_bytes) throw sim::MeshError("is larger than 1 GB");
  check_ply_header(path);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_PreTransformVertices);
  if (scene == nullptr) throw sim::MeshError(fmt::format("is no mesh that can be read: {}", importer.GetErrorString()));
  sim::Mesh mesh;
  std::map<std::array<double, 3>, std::uint32_t> numbers;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) add_triangles(*scene->mMeshes[i], scale, y_up, mesh, numbers);
  if (mesh.triangles.empty()) throw sim::MeshError("has no triangles");
  return mesh;
}

void save_mesh(const sim::Mesh& mesh, const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension != ".stl" && extension != ".obj") throw sim::MeshError("must end in .stl or .obj");
  std::ofstream file(path, std::ios::binary);
  file << (extension == ".stl" ? binary_stl(mesh) : obj_text(mesh));
  if (!file.flush()) throw sim::MeshError("cannot be written");
}

}  // namespace tools
