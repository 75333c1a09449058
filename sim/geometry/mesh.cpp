// SPDX-License-Identifier: BSD-3-Clause
#include "sim/geometry/mesh.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "sim/base/number.hpp"
#include "sim/base/whole_file.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"

namespace sim {
namespace {

constexpr double max_mesh_coordinate_m = 1e7;  // same limit as for the position of a part

/// Splits a text into words separated by white space, by line or across lines.  A line ends with `\n`, `\r\n`, or `\r`
/// in a text without any `\n`.  A backslash before its end continues it.
class Words {
 public:
  explicit Words(std::string_view text)
      : whole_(text), text_(text), line_end_(text.find('\n') == std::string_view::npos ? '\r' : '\n') {}
  /// Returns the next word of the line; empty at its end.
  std::string_view in_line() {
    while (!text_.empty()) {
      const bool blank = text_[0] != line_end_ && (text_[0] == ' ' || text_[0] == '\t' || text_[0] == '\r');
      const std::size_t skipped = blank ? 1 : continuation();
      if (skipped == 0) break;
      text_.remove_prefix(skipped);
    }
    return take();
  }
  /// Returns the next word of the text; empty at its end.
  std::string_view any() {
    while (!text_.empty() && (is_space(text_[0]) || continuation() > 0)) text_.remove_prefix(1);
    return take();
  }
  /// Skips to the next line; returns false at the end of the text.
  bool next_line() {
    const auto end = text_.find(line_end_);
    if (end == std::string_view::npos) return false;
    text_.remove_prefix(end + 1);
    return true;
  }
  bool has_lines() const { return whole_.find(line_end_) != std::string_view::npos; }
  /// Returns the line number of the last word, from 1.
  std::ptrdiff_t line() const {
    return 1 + std::count(whole_.begin(), whole_.end() - static_cast<std::ptrdiff_t>(text_.size()), line_end_);
  }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v'; }
  /// Returns the length of a continuation of the line; 0: there is none.
  std::size_t continuation() const {
    if (text_[0] != '\\') return 0;
    const std::size_t end = text_.find_first_not_of("\r", 1);
    if (line_end_ == '\r') return text_.size() > 1 && text_[1] == '\r' ? 2 : 0;
    return end != std::string_view::npos && text_[end] == '\n' ? end + 1 : 0;
  }
  std::string_view take() {
    const std::string_view rest = text_;
    while (!text_.empty() && !is_space(text_[0]) && continuation() == 0) text_.remove_prefix(1);
    return rest.substr(0, rest.size() - text_.size());
  }
  std::string_view whole_, text_;
  char line_end_;
};

std::string lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return lower;
}

std::string_view without_leading_blanks(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
}

/// Returns true for ASCII STL.  Some binary files begin with `solid` too; their numbers have bytes that are 0.
bool is_ascii_stl(std::string_view bytes) {
  constexpr std::size_t looked_at = 512;
  const std::string_view head = without_leading_blanks(without_byte_order_mark(bytes)).substr(0, looked_at);
  return lower_case(head.substr(0, 5)) == "solid" && head.find('\0') == std::string_view::npos;
}

/// Throws MeshError with the line number.  The contents of the file are not quoted, because a world may refer to a file
/// that its author cannot read.
[[noreturn]] void fail_in_line(const Words& words, const std::string& text) {
  throw MeshError("is not a mesh: line " + std::to_string(words.line()) + ": " + text);
}

double number_from(std::string_view word, const Words& words, const char* what = "number") {
  if (!word.empty() && word[0] == '+') word.remove_prefix(1);
  const std::optional<double> value = exact_number<double>(word);
  if (!value) fail_in_line(words, std::string("must have a ") + what + " here");
  return *value;
}

Vector3d checked_vertex(const Vector3d& p) {
  if (!p.allFinite()) throw MeshError("has a vertex that is not finite");
  return p + Vector3d::Zero();  // converts -0 to 0
}

/// Merges equal vertices, which STL repeats in every triangle.
class Welder {
 public:
  explicit Welder(Mesh& mesh) : mesh_(mesh) {}
  std::uint32_t number_of(const Vector3d& vertex) {
    const Vector3d p = checked_vertex(vertex);
    const auto [at, added] =
        numbers_.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(mesh_.vertices_m.size()));
    if (added) mesh_.vertices_m.push_back(p);
    return at->second;
  }

 private:
  Mesh& mesh_;
  std::map<std::array<double, 3>, std::uint32_t> numbers_;
};

void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (a == b || b == c || c == a) return;
  if (mesh.triangles.size() >= max_mesh_triangles)
    throw MeshError("has more than 4 million triangles: make a coarser one for collision");
  mesh.triangles.push_back({a, b, c});
}

Mesh parse_binary_stl(std::string_view bytes, std::uint32_t count) {
  Mesh mesh;
  Welder welder(mesh);
  mesh.triangles.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    float numbers[12];  // normal, which is ignored, and three vertices
    std::memcpy(numbers, bytes.data() + 84 + 50 * std::size_t{i}, sizeof numbers);
    std::uint32_t corner[3];
    for (int k = 0; k < 3; ++k)
      corner[k] = welder.number_of({numbers[3 + 3 * k], numbers[4 + 3 * k], numbers[5 + 3 * k]});
    add_triangle(mesh, corner[0], corner[1], corner[2]);
  }
  return mesh;
}

/// Skips `normal` and its three numbers, which some writers leave out or write as `-nan(ind)`.
std::string skip_normal(Words& words) {
  std::string word = lower_case(words.any());
  if (word != "normal") return word;
  for (int i = 0; i < 3; ++i) words.any();
  return lower_case(words.any());
}

Mesh parse_ascii_stl(std::string_view text) {
  Mesh mesh;
  Welder welder(mesh);
  Words words(text);
  // `solid` and an arbitrary name.
  words.any();
  if (words.has_lines()) words.next_line();
  // Collect three vertices per facet.
  std::vector<std::uint32_t> corners;
  bool ended = false, in_name = !words.has_lines();
  for (auto word = lower_case(words.any()); !word.empty(); word = lower_case(words.any())) {
    if (in_name && word != "facet" && word != "endsolid") continue;
    in_name = false;
    ended = word == "endsolid";
    if (word == "facet") word = skip_normal(words);
    if (word.empty()) break;
    if (word == "vertex") {
      const double x = number_from(words.any(), words);
      const double y = number_from(words.any(), words);
      const double z = number_from(words.any(), words);
      corners.push_back(welder.number_of({x, y, z}));
    } else if (word == "endfacet") {
      if (corners.size() != 3) throw MeshError("has a facet without three vertices");
      add_triangle(mesh, corners[0], corners[1], corners[2]);
      corners.clear();
    } else if (word == "endsolid" || word == "solid") {
      in_name = !words.has_lines();
      if (!in_name && !words.next_line()) break;
    } else if (word != "outer" && word != "loop" && word != "endloop") {
      fail_in_line(words, "unknown word");
    }
  }
  // Reject truncated files.
  if (!corners.empty()) throw MeshError("ends inside a facet");
  if (!ended) throw MeshError("is truncated: it ends without 'endsolid'");
  return mesh;
}

Mesh not_empty(Mesh mesh) {
  if (mesh.triangles.empty()) throw MeshError("has no triangles");
  const auto has_area = [&](const auto& t) {
    const Vector3d &a = mesh.vertices_m[t[0]], &b = mesh.vertices_m[t[1]], &c = mesh.vertices_m[t[2]];
    return (b - a).cross(c - a).squaredNorm() > 0;
  };
  if (std::none_of(mesh.triangles.begin(), mesh.triangles.end(), has_area))
    throw MeshError("has no triangle with an area");
  return mesh;
}

/// Faces of an OBJ file, whose vertices may follow them.
class ObjFaces {
 public:
  /// Reads corners such as `7`, `7/1`, `7//3`, or `-1` for the last vertex so far.  Texture and normal are ignored.
  void read(Words& words, Mesh& mesh) {
    std::vector<std::uint32_t> corners;
    for (auto corner = words.in_line(); !corner.empty() && corner[0] != '#'; corner = words.in_line())
      corners.push_back(index_of(corner, words, mesh.vertices_m.size()));
    if (corners.size() < 3) throw MeshError("has a face with fewer than three vertices");
    for (std::size_t i = 2; i < corners.size(); ++i) add_triangle(mesh, corners[0], corners[i - 1], corners[i]);
  }
  /// Checks that all vertices exist.
  void finish(const Mesh& mesh) const {
    if (needed_ > mesh.vertices_m.size()) refuse(*needed_at_, mesh.vertices_m.size());
  }

 private:
  [[noreturn]] static void refuse(const Words& words, std::size_t vertices) {
    fail_in_line(words, "must have numbers of the " + std::to_string(vertices) + " vertices");
  }
  std::uint32_t index_of(std::string_view word, const Words& words, std::size_t vertices) {
    constexpr double max_number = 4e9;
    const double number = number_from(word.substr(0, word.find('/')), words, "vertex number");
    // OBJ counts vertices from 1, and negative numbers back from the last one read.
    const double index = number < 0 ? static_cast<double>(vertices) + number : number - 1;
    if (number != std::floor(number) || !(index >= 0 && index < max_number)) refuse(words, vertices);
    const auto found = static_cast<std::uint32_t>(index);
    // A face may come before its vertices; whether they exist is known at the end of the file.
    if (found >= std::max(needed_, vertices)) {
      needed_ = std::size_t{found} + 1;
      needed_at_ = words;
    }
    return found;
  }
  std::size_t needed_ = 0;  ///< number of vertices that a face before them needs
  std::optional<Words> needed_at_;
};

}  // namespace

Mesh load_mesh(const std::string& path, double scale) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  if (extension != ".stl" && extension != ".obj") throw MeshError("must end in .stl or .obj");
  const std::string bytes = whole_file<MeshError>(path);
  Mesh mesh = extension == ".obj" ? parse_obj(bytes) : parse_stl(bytes);
  for (Vector3d& p : mesh.vertices_m) {
    p = checked_vertex(p * scale);
    if (p.cwiseAbs().maxCoeff() > max_mesh_coordinate_m)
      throw MeshError("has a vertex more than 1e7 m from its origin, at " + number_text(p.cwiseAbs().maxCoeff()) +
                      " m");
  }
  return mesh;
}

Mesh parse_stl(std::string_view bytes) {
  constexpr std::size_t head = 84, per_triangle = 50;
  std::uint32_t count = 0;
  if (bytes.size() >= head) std::memcpy(&count, bytes.data() + 80, 4);
  const bool size_fits = bytes.size() >= head && bytes.size() == head + per_triangle * count;
  if (!size_fits && is_ascii_stl(bytes)) {
    return not_empty(parse_ascii_stl(bytes));
  }
  if (bytes.size() < head) throw MeshError("is not a mesh: too short for an STL file");
  const std::size_t room = (bytes.size() - head) / per_triangle;
  // Writers that do not know the number in advance leave 0 or all ones.
  const bool no_count = count == 0 || count == std::numeric_limits<std::uint32_t>::max();
  if (no_count && bytes.size() == head + per_triangle * room)
    count = static_cast<std::uint32_t>(std::min<std::size_t>(room, std::numeric_limits<std::uint32_t>::max()));
  if (count > max_mesh_triangles && count <= room)
    throw MeshError("has more than 4 million triangles: make a coarser one for collision");
  if (count > room)
    throw MeshError("says it has " + std::to_string(count) + " triangles, but there is room for " +
                    std::to_string(room));
  return not_empty(parse_binary_stl(bytes, count));
}

Mesh parse_obj(std::string_view text) {
  Mesh mesh;
  ObjFaces faces;
  Words words(without_byte_order_mark(text));
  do {
    const std::string_view word = words.in_line();
    if (word == "v") {
      const double x = number_from(words.in_line(), words);
      const double y = number_from(words.in_line(), words);
      const double z = number_from(words.in_line(), words);
      mesh.vertices_m.push_back(checked_vertex({x, y, z}));
    } else if (word == "f") {
      faces.read(words, mesh);
    }
  } while (words.next_line());
  faces.finish(mesh);
  return not_empty(std::move(mesh));
}

bool is_closed(const Mesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges, reversed;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      edges.emplace_back(t[k], t[(k + 1) % 3]);
      reversed.emplace_back(t[(k + 1) % 3], t[k]);
    }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  return edges == reversed;
}

MeshSolid solid_of(const Mesh& mesh) {
  // Sum over the tetrahedra between each triangle and a point near the mesh, which limits cancellation for a mesh far
  // from the origin.  The integral of x x^T over a tetrahedron is det/120 (sum of p p^T + s s^T), with p its corners
  // and s their sum.
  const Vector3d near = mesh.vertices_m.empty() ? Vector3d::Zero() : mesh.vertices_m.front();
  double volume = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices_m[t[0]] - near, b = mesh.vertices_m[t[1]] - near, c = mesh.vertices_m[t[2]] - near;
    const double det = a.dot(b.cross(c));
    const Vector3d sum = a + b + c;
    volume += det / 6;
    first += det / 24 * sum;
    second += det / 120 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  // Shift the second moments to the centroid and convert them to inertia.
  MeshSolid solid;
  solid.volume_m3 = volume;
  if (volume == 0) return solid;
  const Vector3d centroid = first / volume;
  second -= volume * centroid * centroid.transpose();
  solid.centroid_m = near + centroid;
  solid.inertia = second.trace() * Matrix3d::Identity() - second;
  return solid;
}

void turn_inside_out(Mesh& mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace sim
