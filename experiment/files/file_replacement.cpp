// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/file_replacement.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

#include "sim/config/diagnostics.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  sim::throw_config_error({sim::intern_file_name(path), 0, 0}, "", "cannot be written: " + why);
}

/// Temporary file beside another one; removed unless it replaces that file.
class NewFile {
 public:
  NewFile(const std::string& path, const std::string& target)
      : path_(path), target_(target), name_(target + ".XXXXXX") {
    fd_ = mkostemp(name_.data(), O_CLOEXEC);
    if (fd_ < 0) fail_by_errno();
  }
  ~NewFile() {
    if (fd_ >= 0) close(fd_);
    if (!name_.empty()) unlink(name_.c_str());
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void write(const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t written = ::write(fd_, text.data() + done, text.size() - done);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail_by_errno();
      done += static_cast<std::size_t>(written);
    }
  }

  /// Sets the owner first, because changing it removes some permissions.
  void take_rights(const struct stat& from) {
    struct stat own {};
    if (fstat(fd_, &own) != 0) fail_by_errno();
    const bool same_owner = own.st_uid == from.st_uid && own.st_gid == from.st_gid;
    if (!same_owner && fchown(fd_, from.st_uid, from.st_gid) != 0) fail(path_, "its owner cannot be kept");
    if (fchmod(fd_, from.st_mode & 07777) != 0) fail_by_errno();
  }

  void take_place() {
    if (fsync(fd_) != 0 && errno != EINVAL) fail_by_errno();
    if (rename(name_.c_str(), target_.c_str()) != 0) fail_by_errno();
    name_.clear();
  }

 private:
  [[noreturn]] void fail_by_errno() const { fail(path_, std::generic_category().message(errno)); }

  std::string path_, target_, name_;
  int fd_ = -1;
};

/// Permissions of a new file.
mode_t usual_rights() {
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

}  // namespace

namespace {

/// Owner and permissions of an existing file, or those that a new one would get.  Throws when it is not a regular file.
struct stat rights_of(const std::string& path, bool& is_there) {
  std::error_code error;
  struct stat status {};
  is_there = stat(path.c_str(), &status) == 0;
  if (!is_there && fs::is_symlink(path, error)) fail(path, "it is a symbolic link to nothing");
  if (is_there && !S_ISREG(status.st_mode)) fail(path, "it is not a regular file");
  if (!is_there) {
    status.st_uid = geteuid();
    status.st_gid = getegid();
    status.st_mode = usual_rights();
  }
  return status;
}

/// Writes a new file beside another one, and puts it there if there is a text.
void write_beside(const std::string& path, const std::string* text) {
  try {
    bool is_there = false;
    const struct stat status = rights_of(path, is_there);
    std::error_code error;
    NewFile file(path, is_there ? fs::canonical(path, error).string() : path);
    if (text != nullptr) file.write(*text);
    file.take_rights(status);
    if (text != nullptr) file.take_place();
  } catch (const sim::ConfigError& error) {
    throw std::runtime_error(error.what());
  }
}

}  // namespace

void write_whole_file(const std::string& path, const std::string& text) {
  write_beside(path, &text);
}

void check_whole_file(const std::string& path) {
  write_beside(path, nullptr);
}

void replace_file(const std::string& path, const std::string& before, const std::string& after) {
  std::error_code error;
  // A link keeps pointing to its target, which is replaced.
  const std::string target = fs::canonical(path, error).string();
  struct stat status {};
  if (error || stat(target.c_str(), &status) != 0) fail(path, "it does not exist any more");
  // Replacing one name of a file would leave the other with the old content.
  if (status.st_nlink > 1) fail(path, "it has more than one hard link");
  if (access(target.c_str(), W_OK) != 0) fail(path, std::generic_category().message(errno));
  NewFile file(path, target);
  file.write(after);
  file.take_rights(status);
  // Compared as late as possible: an editor may have saved the file meanwhile.
  std::ifstream old(target, std::ios::binary);
  const std::string now{std::istreambuf_iterator<char>(old), {}};
  if (!old.is_open() || now != before) fail(path, "it has changed since it was read");
  file.take_place();
}

}  // namespace experiment
