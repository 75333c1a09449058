// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/serial/serial_port.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "sim/base/log.hpp"

namespace bridges {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_waiting_bytes = 1 << 16;

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  throw std::runtime_error("serial port '" + path + "': " + what + ": " + std::strerror(errno));
}

/// File descriptor that is closed on destruction.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  int operator*() const { return number_; }

 private:
  int number_;
};

/// Place of a port: a name in an open folder, so that no link can be inserted in the path.
struct Place {
  Descriptor folder;
  std::string name;
  std::string path;  ///< full path, for messages
};

/// Opens the folder of `path` below `folder`, and creates missing folders.  Links below `folder` are not followed.
Place open_place(const std::string& folder, const std::string& path) {
  const std::string whole = (fs::path(folder) / path).string();
  const auto fail_folder = [&](const std::string& why) {
    throw std::runtime_error("serial port '" + whole + "': cannot create its directory: " + why);
  };
  // Open the folder.
  std::error_code error;
  fs::create_directories(folder.empty() ? "." : folder, error);
  if (error) fail_folder(error.message());
  Descriptor at(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (*at < 0) fail_folder(std::strerror(errno));
  // Check that the path lies below the folder.
  const fs::path below = fs::path(path).lexically_normal();
  if (below.is_absolute() || !below.has_filename() || *below.begin() == ".." || *below.begin() == ".")
    throw std::runtime_error("serial port '" + whole + "': must lie below '" + folder + "'");
  // Create and open each part, without following links.
  for (const fs::path& part : below.parent_path()) {
    mkdirat(*at, part.c_str(), 0777);
    Descriptor next(openat(*at, part.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (*next < 0)
      fail_folder(std::string(std::strerror(errno)) +
                  (errno == ELOOP || errno == ENOTDIR ? ": '" + part.string() + "'" : ""));
    at = std::move(next);
  }
  return {std::move(at), below.filename().string(), whole};
}

/// Queue of bytes for a non-blocking descriptor.
class Outbox {
 public:
  void add(std::span<const std::byte> bytes) {
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
    if (waiting_.size() <= max_waiting_bytes) return;
    const std::size_t excess = waiting_.size() - max_waiting_bytes;
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(excess));
    dropped_ += excess;
  }
  void flush(int descriptor) {
    while (!waiting_.empty()) {
      char chunk[512];
      const std::size_t size = std::min(sizeof chunk, waiting_.size());
      for (std::size_t i = 0; i < size; ++i) chunk[i] = static_cast<char>(waiting_[i]);
      const ssize_t written = ::write(descriptor, chunk, size);
      if (written <= 0) return;
      waiting_.erase(waiting_.begin(), waiting_.begin() + written);
    }
  }
  std::uint64_t dropped() const { return dropped_; }
  bool empty() const { return waiting_.empty(); }

 private:
  std::deque<std::byte> waiting_;
  std::uint64_t dropped_ = 0;
};

sim::Bytes read_all(int descriptor) {
  sim::Bytes bytes;
  char chunk[512];
  // Bounded, so that a program that writes continuously cannot delay the step.
  while (bytes.size() < max_waiting_bytes) {
    const ssize_t size = ::read(descriptor, chunk, sizeof chunk);
    if (size <= 0) break;
    const auto* data = reinterpret_cast<const std::byte*>(chunk);
    bytes.insert(bytes.end(), data, data + size);
  }
  return bytes;
}

// The system reuses the numbers of pseudo-terminals, so that a link left by a killed run may lead to another terminal.
// While a run is alive, it holds a lock on a byte of its terminal that identifies the path of the link; and its links
// have a distinct form, so that they are not confused with those of other programs.

constexpr char terminals[] = "/dev/pts/";
constexpr char own_spelling[] = "/dev/pts/./";

struct flock lock_of(const Place& place) {
  struct stat folder {};
  fstat(*place.folder, &folder);
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  const auto add = [&hash](std::uint64_t byte) { hash = (hash ^ (byte & 0xff)) * 0x100000001b3u; };
  for (int shift = 0; shift < 64; shift += 8) {
    add(static_cast<std::uint64_t>(folder.st_ino) >> shift);
    add(static_cast<std::uint64_t>(folder.st_dev) >> shift);
  }
  for (const char c : place.name) add(static_cast<unsigned char>(c));
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(hash & 0x3fffffff);
  lock.l_len = 1;
  return lock;
}

/// Returns the target of a link; empty when it is not a link.
std::string target_of(const Place& place) {
  char target[256];
  const ssize_t size = readlinkat(*place.folder, place.name.c_str(), target, sizeof target);
  return size < 0 ? std::string() : std::string(target, static_cast<std::size_t>(size));
}

/// Returns whether this link belongs to a run that is alive.
bool is_held(const Place& place) {
  const Descriptor terminal(openat(*place.folder, place.name.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (*terminal < 0) return errno != ENOENT;  // otherwise it may belong to another program
  struct flock lock = lock_of(place);
  return fcntl(*terminal, F_OFD_GETLK, &lock) != 0 || lock.l_type != F_UNLCK;
}

/// Removes the remains of a killed run at the place of a link, or throws.
void remove_stale_link(const Place& place) {
  const std::string target = target_of(place);
  if (target.empty()) return;
  // A killed run leaves its link, and the terminal of another program may have the same number now.
  if (!target.starts_with(own_spelling) || is_held(place))
    throw std::runtime_error("serial port '" + place.path + "': is in use: " + std::strerror(EEXIST) +
                             "; if no run uses it, remove the link");
  sim::log_warn("serial port '{}': replaced a link left behind by a killed run", place.path);
  unlinkat(*place.folder, place.name.c_str(), 0);
}

class PtyPort final : public sim::BytePort {
 public:
  explicit PtyPort(Place place) : place_(std::move(place)) {
    const std::string& path = place_.path;
    remove_stale_link(place_);
    char name[128];
    termios raw{};
    cfmakeraw(&raw);
    // Keep the slave open: reading the master fails while no one has the slave open.
    if (openpty(&master_, &slave_, name, &raw, nullptr) != 0) fail("cannot open a pseudo-terminal", path);
    fcntl(master_, F_SETFL, O_NONBLOCK);
    fcntl(master_, F_SETFD, FD_CLOEXEC);
    fcntl(slave_, F_SETFD, FD_CLOEXEC);
    struct flock lock = lock_of(place_);
    fcntl(slave_, F_OFD_SETLK, &lock);
    target_ = name;
    if (target_.starts_with(terminals)) target_.replace(0, sizeof terminals - 1, own_spelling);
    if (symlinkat(target_.c_str(), *place_.folder, place_.name.c_str()) != 0) {
      const int reason = errno;
      close_all();
      errno = reason;
      fail("cannot create the link", path);
    }
  }
  ~PtyPort() override {
    if (target_of(place_) == target_)
      unlinkat(*place_.folder, place_.name.c_str(), 0);  // otherwise it has been replaced
    close_all();
  }
  sim::Bytes read() override {
    if (!out_.empty()) out_.flush(master_);
    return read_all(master_);
  }
  void write(std::span<const std::byte> bytes) override {
    out_.add(bytes);
    out_.flush(master_);
  }
  std::uint64_t dropped_bytes() const override { return out_.dropped(); }

 private:
  void close_all() {
    ::close(master_);
    ::close(slave_);
  }
  Place place_;
  std::string target_;  // target of the link
  int master_ = -1;
  int slave_ = -1;
  Outbox out_;
};

/// FIFO in a folder, removed on destruction.
class Fifo {
 public:
  Fifo(const Place& port, const std::string& ending)
      : folder_(fcntl(*port.folder, F_DUPFD_CLOEXEC, 0)), name_(port.name + ending), path_(port.path + ending) {
    remove_stale();
    if (mkfifoat(*folder_, name_.c_str(), 0600) != 0) fail("cannot create the FIFO", path_);
    // Open for reading and writing: no end-of-file when a writer closes, no error without a reader.
    end_ = Descriptor(openat(*folder_, name_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW));
    if (*end_ < 0 || fstat(*end_, &status_) != 0 || !S_ISFIFO(status_.st_mode)) fail("cannot open the FIFO", path_);
    fchmod(*end_, own_mode);
  }
  ~Fifo() {
    if (is_own_file()) unlinkat(*folder_, name_.c_str(), 0);
  }
  Fifo(const Fifo&) = delete;
  Fifo& operator=(const Fifo&) = delete;
  int operator*() const { return *end_; }

 private:
  /// Mark of a FIFO created by a run: the sticky bit, which has no effect on a FIFO.
  static constexpr mode_t own_mode = S_ISVTX | 0600;

  bool is_own_file() const {
    struct stat now {};
    return *end_ >= 0 && fstatat(*folder_, name_.c_str(), &now, AT_SYMLINK_NOFOLLOW) == 0 &&
           now.st_ino == status_.st_ino && now.st_dev == status_.st_dev;
  }
  /// Removes a FIFO left by a killed run, that is one without a reader.  Throws for that of a running one.
  void remove_stale() {
    struct stat status {};
    if (fstatat(*folder_, name_.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISFIFO(status.st_mode)) return;
    if ((status.st_mode & 07777) != own_mode || status.st_uid != geteuid()) return;
    if (*Descriptor(openat(*folder_, name_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW)) >= 0) {
      errno = EEXIST;
      fail("is in use", path_);
    }
    sim::log_warn("serial port '{}': replaced a FIFO left behind by a killed run", path_);
    unlinkat(*folder_, name_.c_str(), 0);
  }

  Descriptor folder_;
  std::string name_, path_;
  Descriptor end_;
  struct stat status_ {};
};

class FifoPort final : public sim::BytePort {
 public:
  explicit FifoPort(const Place& place) : in_(place, ".in"), out_(place, ".out") {}
  sim::Bytes read() override {
    if (!outbox_.empty()) outbox_.flush(*out_);
    return read_all(*in_);
  }
  void write(std::span<const std::byte> bytes) override {
    outbox_.add(bytes);
    outbox_.flush(*out_);
  }
  std::uint64_t dropped_bytes() const override { return outbox_.dropped(); }

 private:
  Fifo in_, out_;
  Outbox outbox_;
};

}  // namespace

std::unique_ptr<sim::BytePort> open_serial_port(sim::PortKind kind, const std::string& folder,
                                                const std::string& path) {
  Place place = open_place(folder, path);
  switch (kind) {
    case sim::PortKind::pty:
      break;
    case sim::PortKind::fifo:
      return std::make_unique<FifoPort>(place);
  }
  return std::make_unique<PtyPort>(std::move(place));
}

std::unique_ptr<sim::BytePort> open_serial_port(sim::PortKind kind, const std::string& path) {
  const fs::path whole(path);
  return open_serial_port(kind, whole.parent_path().string(), whole.filename().string());
}

}  // namespace bridges
