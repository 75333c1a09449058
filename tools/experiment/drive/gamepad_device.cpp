// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/drive/gamepad_device.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "tools/experiment/drive/drive_error.hpp"

namespace tools {

GamepadDevice::GamepadDevice(const std::string& path, const DriveProfile::Gamepad& profile, Gamepad& gamepad)
    : path_(path), file_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)), gamepad_(gamepad) {
  if (file_.number() < 0)
    throw DriveError(path + ": cannot be opened: " + std::strerror(errno) +
                     (errno == EACCES ? "; is this user in the group 'input'?" : ""));
  struct stat status {};
  if (fstat(file_.number(), &status) == 0 && (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)))
    throw DriveError(path + ": is not a device; --events plays a file of its events");
  for (const DriveProfile::PadAxis& axis : profile.axes) {
    input_absinfo range{};
    if (ioctl(file_.number(), EVIOCGABS(static_cast<unsigned>(axis.code)), &range) >= 0)
      gamepad.set_range(axis.code, range.minimum, range.maximum);
  }
}

bool GamepadDevice::read() {
  std::array<std::byte, 64 * InputEventReader::event_bytes> bytes{};
  for (;;) {
    const ssize_t got = ::read(file_.number(), bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) return true;
    if (got <= 0) return false;
    reader_.add(std::span(bytes).first(static_cast<std::size_t>(got)));
    try {
      while (const auto event = reader_.next()) gamepad_.take(*event);
    } catch (const DriveError& error) {
      throw DriveError(path_ + ": " + error.what());
    }
  }
}

}  // namespace tools
