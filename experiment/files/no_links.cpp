// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/no_links.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace experiment {

void refuse_links(const std::string& root, const std::string& path) {
  namespace fs = std::filesystem;
  assert(path.starts_with(root));
  fs::path part = root;
  // The root is the user's choice and may be a link; only what is below it could be a trap.
  for (const fs::path& name : fs::path(path.substr(root.size())).relative_path()) {
    part /= name;
    std::error_code error;
    if (fs::is_symlink(fs::symlink_status(part, error)))
      throw std::runtime_error(part.string() +
                               ": is a symbolic link, through which nothing is written or removed in '" + root +
                               "'; remove it");
  }
}

void make_folders(const std::string& root, const std::string& folder) {
  refuse_links(root, folder);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder + ": cannot be made: " + error.message());
}

bridges::FileDescriptor make_new_file(const std::string& path) {
  if (unlink(path.c_str()) != 0 && errno != ENOENT) throw std::system_error(errno, std::generic_category());
  bridges::FileDescriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (file.number() < 0) throw std::system_error(errno, std::generic_category());
  return file;
}

}  // namespace experiment
