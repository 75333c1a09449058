// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/mesh/mesh_import.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <signal.h>
#include <spdlog/fmt/fmt.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "bridges/base/forked_work.hpp"

namespace tools {
namespace {

constexpr std::uintmax_t max_file_bytes = 1u << 30;

/// Adds the triangles of one of Assimp's meshes; vertices at the same position are merged.
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
    for (unsigned k = 0; k < 3; ++k)
      if (face.mIndices[k] >= number_of.size()) throw sim::MeshError("has a face with a vertex that does not exist");
    const std::uint32_t a = number_of[face.mIndices[0]], b = number_of[face.mIndices[1]],
                        c = number_of[face.mIndices[2]];
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
  }
  if (mesh.triangles.size() > sim::max_mesh_triangles) throw sim::MeshError("has more than 4 million triangles");
}

std::string lower_case_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return extension;
}

sim::Mesh read_with_assimp(const std::string& path, const MeshImportOptions& options) {
  const std::string extension = lower_case_extension(path);
  // Assimp rotates a Collada file so that y is up, regardless of the axis in the file.
  const bool y_up = options.up
                        ? *options.up == 'y'
                        : extension == ".dae" || extension == ".zae" || extension == ".gltf" || extension == ".glb";
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, options.up.has_value());
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_PreTransformVertices);
  if (scene == nullptr) throw sim::MeshError(fmt::format("is not a readable mesh: {}", importer.GetErrorString()));
  sim::Mesh mesh;
  std::map<std::array<double, 3>, std::uint32_t> numbers;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i)
    add_triangles(*scene->mMeshes[i], options.scale, y_up, mesh, numbers);
  if (mesh.triangles.empty()) throw sim::MeshError("has no triangles");
  return mesh;
}

// Result of the child: `m`, the number of vertices, the vertices and the triangles; or `e` and the error.
constexpr std::size_t vertex_bytes = sizeof(sim::Vector3d), triangle_bytes = 3 * sizeof(std::uint32_t);

std::string packed(const sim::Mesh& mesh) {
  const std::uint64_t vertices = mesh.vertices_m.size();
  std::string bytes = "m";
  bytes.append(reinterpret_cast<const char*>(&vertices), sizeof vertices);
  bytes.append(reinterpret_cast<const char*>(mesh.vertices_m.data()), vertices * vertex_bytes);
  bytes.append(reinterpret_cast<const char*>(mesh.triangles.data()), mesh.triangles.size() * triangle_bytes);
  return bytes;
}

sim::Mesh unpacked(const std::string& bytes) {
  std::uint64_t vertices = 0;
  constexpr std::size_t head = 1 + sizeof vertices;
  if (bytes.size() < head || bytes[0] != 'm')
    throw sim::MeshError(bytes.substr(std::min<std::size_t>(1, bytes.size())));
  std::memcpy(&vertices, bytes.data() + 1, sizeof vertices);
  if (vertices > (bytes.size() - head) / vertex_bytes) throw ChildError("failed on this file");
  sim::Mesh mesh;
  mesh.vertices_m.resize(vertices);
  mesh.triangles.resize((bytes.size() - head - vertices * vertex_bytes) / triangle_bytes);
  static_assert(sizeof(sim::Vector3d) == 3 * sizeof(double));
  std::memcpy(static_cast<void*>(mesh.vertices_m.data()), bytes.data() + head, vertices * vertex_bytes);
  std::memcpy(mesh.triangles.data(), bytes.data() + head + vertices * vertex_bytes,
              mesh.triangles.size() * triangle_bytes);
  // A damaged file may have made the child write arbitrary bytes.
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      if (corner >= vertices) throw ChildError("failed on this file");
  return mesh;
}

std::string binary_stl(const sim::Mesh& mesh) {
  // Binary STL: 80 bytes of head, a count, and 50 bytes for each triangle, little-endian.
  std::string bytes(80, ' ');
  const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    const sim::Vector3d &a = mesh.vertices_m[t[0]], &b = mesh.vertices_m[t[1]], &c = mesh.vertices_m[t[2]];
    const sim::Vector3d normal = (b - a).cross(c - a).stableNormalized();
    for (const sim::Vector3d& v : {normal, a, b, c})
      for (int i = 0; i < 3; ++i) {
        const auto value = static_cast<float>(v[i]);
        if (!std::isfinite(value)) throw sim::MeshError("cannot hold numbers this large; scale it, or write .obj");
        put(value);
      }
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

sim::Mesh import_mesh(const std::string& path, const MeshImportOptions& options) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw sim::MeshError("is a folder, not a file");
  if (!std::filesystem::is_regular_file(path, error)) throw sim::MeshError("does not exist");
  if (std::filesystem::file_size(path, error) > max_file_bytes) throw sim::MeshError("is larger than 1 GB");
  const auto work = [&]() -> std::string {
    try {
      return packed(read_with_assimp(path, options));
    } catch (const sim::MeshError& problem) {
      // Errors of the mesh come back from the child as text; the first byte tells them from a mesh.
      return std::string("e") + problem.what();
    }
  };
  try {
    return unpacked(do_in_child(work, {.time_s = options.timeout_s}));
  } catch (const ChildError& problem) {
    throw sim::MeshError(fmt::format("cannot be read: the importer {}", problem.what()));
  }
}

void save_mesh(const sim::Mesh& mesh, const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension != ".stl" && extension != ".obj") throw sim::MeshError("must end in .stl or .obj");
  const std::string bytes = extension == ".stl" ? binary_stl(mesh) : obj_text(mesh);
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  if (!file.flush()) throw sim::MeshError("cannot be written");
}

namespace {

using Clock = std::chrono::steady_clock;

void set_limit(__rlimit_resource resource, std::size_t value) {
  const rlimit limit{value, value};
  setrlimit(resource, &limit);
}

int be_child(const std::function<std::string()>& work, const ChildLimits& limits, int to) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int fatal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) signal(fatal, SIG_DFL);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  set_limit(RLIMIT_CORE, 0);
#ifndef __SANITIZE_ADDRESS__
  set_limit(RLIMIT_AS, limits.memory_bytes);
#endif
  return bridges::write_all(to, work()) ? 0 : 1;
}

}  // namespace

std::string do_in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.time_s));
  // Assimp may crash, loop or take all memory on a broken file. A child process keeps that from the command, and from
  // its users.
  bridges::ForkedWork done;
  try {
    done = bridges::run_forked([&](int to) { return be_child(work, limits, to); }, deadline);
  } catch (const std::system_error&) {
    throw ChildError("could not be started");
  }
  if (!done.output) throw ChildError(fmt::format("took longer than {:g} s", limits.time_s));
  if (done.status != 0) throw ChildError("failed on this file");
  return *std::move(done.output);
}

}  // namespace tools
