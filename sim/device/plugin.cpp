// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/plugin.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <vector>

#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"

namespace sim {

namespace {

namespace fs = std::filesystem;

struct LoadedPlugin {
  fs::path path;     ///< canonical
  std::string name;  ///< file name
};

std::vector<LoadedPlugin>& loaded_plugins() {
  static std::vector<LoadedPlugin> plugins;
  return plugins;
}

std::vector<fs::path> plugin_directories() {
  std::vector<fs::path> directories;
  if (const char* list = std::getenv("SHOAL_PLUGIN_PATH"); list != nullptr) {
    std::istringstream stream(list);
    for (std::string each; std::getline(stream, each, ':');)
      if (!each.empty()) directories.emplace_back(each);
  }
  if (!program_folder().empty()) directories.push_back(fs::path(program_folder()).parent_path() / "lib/shoal/plugins");
  return directories;
}

/// Reads the text of SHOAL_PLUGIN from the file, before the library is loaded: loading runs its initializers, which may
/// have undefined behavior with another interface.
std::string info_in_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const std::size_t at = bytes.find(SHOAL_PLUGIN_MARK);
  return at == std::string::npos ? std::string() : std::string(bytes.c_str() + at);
}

/// Returns why a file cannot be loaded as a plugin; empty when it can.
std::string objection(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return "there is no such file";
  if (!fs::is_regular_file(path, error)) return "is not a file";
  std::ifstream in(path, std::ios::binary);
  char magic[4] = {};
  if (!in.read(magic, sizeof magic) || std::string_view(magic, 4) !=
                                           "\x7f"
                                           "ELF")
    return "is not a library";
  const std::string info = info_in_file(path);
  if (info.empty()) return "is not a Shoal plugin: it lacks SHOAL_PLUGIN(\"name\", \"version\")";
  const std::string abi = info.substr(info.rfind('|') + 1);
  if (abi != SHOAL_PLUGIN_ABI)
    return "was built for another version of Shoal and must be rebuilt; it has '" + printable(abi) +
           "', this program '" + SHOAL_PLUGIN_ABI + "'";
  return {};
}

/// Prints an error before an exception in an initializer of a library ends the program.
std::string initializing;
[[noreturn]] void print_exception() {
  std::string what = "an initializer ended the program";
  if (const std::exception_ptr thrown = std::current_exception()) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::exception& error) {
      what = std::string("an initializer threw: ") + error.what();
    } catch (...) {
      what = "an initializer threw an unknown exception";
    }
  }
  std::fprintf(stderr, "%s: %s\n", initializing.c_str(), printable(what).c_str());
  // Exceptions of a plug-in's initializers cannot be caught across dlopen(), so std::terminate() leads here; no
  // destructor may run.
  std::_Exit(2);
}

/// Loads a library; returns the reason of a failure, or empty.
std::string open_library(const fs::path& path) {
  const std::terminate_handler before = std::set_terminate(print_exception);
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  std::set_terminate(before);
  if (library == nullptr) {
    std::string reason = dlerror();
    if (reason.starts_with(path.string() + ": ")) reason.erase(0, path.string().size() + 2);
    return "cannot be loaded: " + printable(reason);
  }
  // The library is never closed: its devices and their code are used until the program ends.
  return dlsym(library, "shoal_plugin_info") == nullptr ? "does not export shoal_plugin_info" : std::string();
}

}  // namespace

std::string find_plugin(const std::string& file, const std::string& directory) {
  std::vector<fs::path> directories{directory};
  if (fs::path(file).is_relative())
    for (const fs::path& each : plugin_directories()) directories.push_back(each);
  for (const fs::path& each : directories) {
    std::error_code error;
    if (fs::exists(each / file, error)) return (each / file).lexically_normal().string();
  }
  return {};
}

void load_plugin(const std::string& path, const SourcePlace& place, const std::string& who, Diagnostics& diagnostics) {
  std::error_code error;
  // An absolute path also prevents dlopen from searching the system libraries.
  fs::path canonical = fs::weakly_canonical(path, error);
  if (error) canonical = fs::path(path);
  for (const LoadedPlugin& plugin : loaded_plugins())
    if (plugin.path == canonical) return;
  std::string problem = objection(canonical);
  initializing = place.text() + (who.empty() ? "" : ": " + who);
  if (problem.empty()) problem = open_library(canonical);
  if (!problem.empty()) return diagnostics.error(place, who, problem);
  const std::vector<std::string> clashes = DeviceRegistry::instance().take_problems();
  for (const std::string& clash : clashes) diagnostics.error(place, who, clash);
  if (clashes.empty()) loaded_plugins().push_back({canonical, canonical.filename().string()});
}

bool is_loaded_plugin(const std::string& file) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(file, error);
  const bool bare = !fs::path(file).has_parent_path();
  const auto& plugins = loaded_plugins();
  return std::any_of(plugins.begin(), plugins.end(), [&](const LoadedPlugin& plugin) {
    return plugin.path == canonical || (bare && plugin.name == file);
  });
}

}  // namespace sim
