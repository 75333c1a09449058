// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/input_device.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "experiment/drive/drive_profile.hpp"

namespace experiment {

InputDevice::InputDevice(const std::string& path)
    : path_(path), file_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
  if (file_.number() < 0)
    throw DriveError(path + ": cannot be opened: " + std::strerror(errno) +
                     (errno == EACCES ? "; is this user in the group 'input'?" : ""));
  struct stat status {};
  if (fstat(file_.number(), &status) == 0 && (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)))
    throw DriveError(path + ": is not a device; --events plays a file of its events");
}

std::optional<std::pair<double, double>> InputDevice::range(int axis) const {
  input_absinfo range{};
  if (ioctl(file_.number(), EVIOCGABS(static_cast<unsigned>(axis)), &range) < 0 || range.minimum >= range.maximum)
    return std::nullopt;
  return std::pair<double, double>{range.minimum, range.maximum};
}

bool InputDevice::read(const std::function<void(const InputEvent&)>& take) {
  std::array<std::byte, 64 * InputEventReader::event_bytes> bytes{};
  for (;;) {
    const ssize_t got = ::read(file_.number(), bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) return true;
    if (got <= 0) return false;
    reader_.add(std::span(bytes).first(static_cast<std::size_t>(got)));
    try {
      while (const auto event = reader_.next()) take(*event);
    } catch (const DriveError& error) {
      throw DriveError(path_ + ": " + error.what());
    }
  }
}

}  // namespace experiment
