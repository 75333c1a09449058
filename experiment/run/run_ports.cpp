// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_ports.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "bridges/serial/serial_port.hpp"
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;

/// Returns a valid folder name for the name of a world, which may be any text.
std::string as_file_name(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_') c = '_';
  return name.empty() ? "world" : name.substr(0, 100);
}

struct PortPlace {
  std::string folder, path;
};

PortPlace place_of(const std::string& path, const sim::FileAccessPointer& files, const std::string& results,
                   const std::string& world_name) {
  const fs::path whole(path);
  if (whole.is_relative()) {
    if (!results.empty()) return {results, "serial/" + path};
    const PortFolder temporary = temporary_port_folder(world_name);
    return {temporary.folder, temporary.world + "/" + path};
  }
  if (files == nullptr) return {whole.parent_path().string(), whole.filename().string()};
  const std::string folder = files->allowed_above(path);
  if (folder.empty()) throw std::runtime_error("serial port '" + path + "': " + sim::FileAccess::making_rule());
  return {folder, fs::weakly_canonical(whole).lexically_relative(folder).string()};
}

}  // namespace

PortFolder temporary_port_folder(const std::string& world_name) {
  const std::string folder = (fs::temp_directory_path() / ("shoal-" + std::to_string(geteuid()))).string();
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    throw std::runtime_error("folder '" + folder + "' for serial ports cannot be made: " + std::strerror(errno));
  struct stat status {};
  const bool own = lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == geteuid() &&
                   (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
  if (!own)
    throw std::runtime_error("folder '" + folder +
                             "' for serial ports must be a folder that only this user can write to; use --results");
  return {folder, as_file_name(world_name)};
}

sim::PortOpener serial_ports_of(const sim::WorldConfig& world, const RunOptions& options) {
  return [files = world.files, results = options.results, name = options.name, world_name = world.name](
             sim::PortKind kind, const std::string& path) {
    const PortPlace place = place_of(with_run_name(path, name), files, results, world_name);
    auto port = bridges::open_serial_port(kind, place.folder, place.path);
    sim::log_info("serial port '{}' is {}{}", sim::printable(path),
                  sim::printable((fs::path(place.folder) / place.path).string()),
                  kind == sim::PortKind::fifo ? ".in and .out" : "");
    return port;
  };
}

}  // namespace experiment
