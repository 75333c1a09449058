// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_key_file.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "bridges/base/bus_error.hpp"
#include "bridges/base/file_descriptor.hpp"

namespace experiment {

namespace {

std::string make_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  std::error_code error;
  const bool usable = runtime != nullptr && std::filesystem::is_directory(runtime, error);
  std::string path = (usable ? std::string(runtime) : "/tmp") + "/shoal-run-XXXXXX";
  if (mkdtemp(path.data()) == nullptr)  // with mode 0700
    throw bridges::BusError(path + ": cannot be created for the key of the run: " + std::strerror(errno));
  return path;
}

}  // namespace

RunKeyFile::RunKeyFile(const std::string& folder)
    : key_(bridges::RunKey::random()), folder_(folder.empty() ? make_folder() : folder), own_folder_(folder.empty()) {
  std::error_code error;
  if (!own_folder_) std::filesystem::create_directories(folder_, error);
  write();
}

void RunKeyFile::write() const {
  const std::string path = folder_ + "/" + bridges::run_key_file;
  const auto fail = [&] {
    throw bridges::BusError(path + ": cannot write the key of the run: " + std::strerror(errno));
  };
  // Refuse a file or link of another user.
  if (unlink(path.c_str()) != 0 && errno != ENOENT) fail();
  const bridges::FileDescriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (file.number() < 0) fail();
  const std::string text = key_.text() + "\n";
  if (::write(file.number(), text.data(), text.size()) != static_cast<ssize_t>(text.size())) fail();
}

RunKeyFile::~RunKeyFile() {
  unlink((folder_ + "/" + bridges::run_key_file).c_str());
  if (own_folder_) rmdir(folder_.c_str());
}

}  // namespace experiment
