// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/run_identity.hpp"

#include <gnu/libc-version.h>
#include <spdlog/fmt/fmt.h>
#include <sys/utsname.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "sim/base/state_hash.hpp"
#include "sim/world_file/data_files.hpp"

namespace experiment {

namespace {

const std::string no_hash(16, '-');

std::string processor_class() {
// Compilers and libraries choose their code by these levels, and with it the last bits of results.
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) return "x86-64-v4";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "x86-64-v3";
  if (__builtin_cpu_supports("sse4.2")) return "x86-64-v2";
  return "x86-64";
#else
  utsname name{};
  return uname(&name) == 0 ? name.machine : "unknown";
#endif
}

/// Limit, as for every file of a world.
constexpr std::uintmax_t max_file_bytes = 1'000'000'000;

/// Hashes a regular file; `path` may come from an untrusted record: reading a pipe, a device or some files of the
/// kernel, which report a size of 0, would not end.
std::string hash_of_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return no_hash;
  std::uintmax_t left = std::filesystem::file_size(path, error);
  if (error || left > max_file_bytes) return no_hash;
  std::ifstream in(path, std::ios::binary);
  if (!in) return no_hash;
  sim::StateHash hash;
  std::vector<char> buffer(std::size_t{1} << 20);
  while (left > 0) {
    in.read(buffer.data(), static_cast<std::streamsize>(std::min<std::uintmax_t>(left, buffer.size())));
    if (in.gcount() <= 0) break;
    hash.add_bytes(buffer.data(), static_cast<std::size_t>(in.gcount()));
    left -= static_cast<std::uintmax_t>(in.gcount());
  }
  return in.bad() ? no_hash : fmt::format("{:016x}", hash.value());
}

}  // namespace

std::string build_text() {
  return processor_class() + ", glibc " + gnu_get_libc_version();
}

std::string files_text(const sim::ConfigNode& resolved) {
  std::set<std::string> paths;
  sim::ConfigNode tree = resolved;
  sim::visit_data_files(tree, [&](const std::string& path, const std::string*) {
    if (path.find('/') != std::string::npos) paths.insert(path);
  });
  std::string text;
  for (const std::string& path : paths) text += hash_of_file(path) + " " + path + "\n";
  return text;
}

std::vector<std::string> changed_files(const std::string& text) {
  std::vector<std::string> changes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    // 16 digits, a blank and a path; other lines are of a newer format.
    if (line.size() < 18 || line[16] != ' ') continue;
    const std::string hash = line.substr(0, 16), path = line.substr(17);
    if (hash == no_hash) continue;
    const std::string now = hash_of_file(path);
    if (now == no_hash)
      changes.push_back(path + ": is missing");
    else if (now != hash)
      changes.push_back(path + ": is another file than in the run");
  }
  return changes;
}

void allow_files(const std::string& text, sim::LoadOptions& load) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < 18 || line[16] != ' ') continue;
    const std::string hash = line.substr(0, 16), path = line.substr(17);
    if (hash != no_hash && hash_of_file(path) == hash) load.allow_paths.push_back(path);
  }
}

}  // namespace experiment
