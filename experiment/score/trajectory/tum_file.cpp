// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/trajectory/tum_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace experiment {

namespace {

std::runtime_error tum_error(const std::string& path) {
  return std::runtime_error(path + ": cannot be written: " + std::strerror(errno));
}

}  // namespace

TumFile::TumFile(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "w")) {
  if (!file_) throw tum_error(path);
  std::fputs("# t x y z qx qy qz qw\n", file_.get());
}

void TumFile::add(double time_s, const sim::Vector3d& p_W, const sim::Quaterniond& q_WB) {
  const std::string line = fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", time_s, p_W.x(),
                                       p_W.y(), p_W.z(), q_WB.x(), q_WB.y(), q_WB.z(), q_WB.w());
  std::fputs(line.c_str(), file_.get());
}

void TumFile::close() {
  const bool bad = std::ferror(file_.get()) != 0;
  if (std::fclose(file_.release()) != 0 || bad) throw tum_error(path_);
}

}  // namespace experiment
