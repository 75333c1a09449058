// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/run_claim.hpp"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "bridges/base/file_descriptor.hpp"
#include "experiment/files/no_links.hpp"

namespace experiment {

RunClaim::RunClaim(const std::string& root, const std::string& directory) {
  make_folders(root, directory);
  const std::string path = directory + "/study_claim";
  refuse_links(root, path);
  file_ = bridges::FileDescriptor(open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (file_.number() < 0) throw std::runtime_error(path + ": cannot be opened: " + std::strerror(errno));
  owner_ = bridges::lock_against_others(file_.number());
  if (owner_) return;
  // The runner may have been killed a moment ago, while its `shoal run` still ends: that locks the folder itself.
  const bridges::FileDescriptor folder(open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.number() >= 0) owner_ = bridges::lock_against_others(folder.number());
  if (owner_) file_ = bridges::FileDescriptor();
}

}  // namespace experiment
