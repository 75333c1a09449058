#include "bridges/serial/serial_port.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <filesystem>
#include <stdexcept>

namespace bridges {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_waiting_bytes = 1 << 16;

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  throw std::runtime_error("serial port '" + path + "': " + what + ": " + std::strerror(errno));
}

void make_parent(const std::string& path) {
  const fs::path parent = fs::path(path).parent_path();
  std::error_code error;
  if (!parent.empty()) fs::create_directories(parent, error);
  if (error) throw std::runtime_error("serial port '" + path + "': cannot make its directory: " + error.message());
}

/// Bytes that wait to be written to a descriptor that never blocks.
class Outbox {
 public:
  void add(std::span<const std::byte> bytes) {
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
    if (waiting_.size() <= most_waiting_bytes) return;
    const std::size_t excess = waiting_.size() - most_waiting_bytes;
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
  // Bounded, so that a program that writes without end cannot hold up the step.
  while (bytes.size() < most_waiting_bytes) {
    const ssize_t size = ::read(descriptor, chunk, sizeof chunk);
    if (size <= 0) break;
    const auto* data = reinterpret_cast<const std::byte*>(chunk);
    bytes.insert(bytes.end(), data, data + size);
  }
  return bytes;
}

// The system gives the number of a pseudo-terminal that is gone to the next one, so a link that a killed run left may
// lead to another terminal.  While a run lives, it holds a lock on a byte of its terminal that stands for the path of
// the link; and its links are spelt in a way of their own, so that no other program's is taken for one.

constexpr char terminals[] = "/dev/pts/";
constexpr char own_spelling[] = "/dev/pts/./";

struct flock lock_of(const std::string& path) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const char c : fs::absolute(path).lexically_normal().string())
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(hash & 0x3fffffff);
  lock.l_len = 1;
  return lock;
}

/// Whether a run that lives made this link.
bool is_held(const std::string& path) {
  const int terminal = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (terminal < 0) return true;  // somebody else's, perhaps
  struct flock lock = lock_of(path);
  const bool held = fcntl(terminal, F_OFD_GETLK, &lock) != 0 || lock.l_type != F_UNLCK;
  ::close(terminal);
  return held;
}

/// Makes room for a link, or throws.
void remove_stale_link(const std::string& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return;
  if (fs::exists(path, error)) {
    const bool own = fs::read_symlink(path, error).string().starts_with(own_spelling);
    if (!own || is_held(path)) {
      // A run that was killed leaves its link, and another program's terminal may have that number since.
      throw std::runtime_error("serial port '" + path + "': is in use: " + std::strerror(EEXIST) +
                               "; when no run has it, remove the link");
    }
  }
  spdlog::warn("serial port '{}': replaced the link that a killed run left", path);
  fs::remove(path, error);
}

class PtyPort final : public sim::BytePort {
 public:
  explicit PtyPort(const std::string& path) : path_(path) {
    make_parent(path);
    remove_stale_link(path);
    char name[128];
    termios raw{};
    cfmakeraw(&raw);
    // The slave stays open here too: reading the master fails while nobody has it open.
    if (openpty(&master_, &slave_, name, &raw, nullptr) != 0) fail("cannot open a pseudo-terminal", path);
    fcntl(master_, F_SETFL, O_NONBLOCK);
    fcntl(master_, F_SETFD, FD_CLOEXEC);
    fcntl(slave_, F_SETFD, FD_CLOEXEC);
    struct flock lock = lock_of(path);
    fcntl(slave_, F_OFD_SETLK, &lock);
    std::string target = name;
    if (target.starts_with(terminals)) target.replace(0, sizeof terminals - 1, own_spelling);
    if (symlink(target.c_str(), path.c_str()) != 0) {
      const int reason = errno;
      close_all();
      errno = reason;
      fail("cannot make the link", path);
    }
  }
  ~PtyPort() override {
    unlink(path_.c_str());
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
  std::string path_;
  int master_ = -1;
  int slave_ = -1;
  Outbox out_;
};

class FifoPort final : public sim::BytePort {
 public:
  explicit FifoPort(const std::string& path) : in_path_(path + ".in"), out_path_(path + ".out") {
    make_parent(path);
    refuse_if_read(in_path_);
    make_fifo(in_path_);
    try {
      make_fifo(out_path_);
    } catch (...) {
      unlink(in_path_.c_str());
      throw;
    }
    // Both ways on both: no end-of-file when a writer leaves, no error while nobody reads.
    in_ = ::open(in_path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    out_ = ::open(out_path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (in_ < 0 || out_ < 0) {
      const int reason = errno;
      remove_all();
      errno = reason;
      fail("cannot open the FIFOs", path);
    }
  }
  ~FifoPort() override { remove_all(); }
  sim::Bytes read() override {
    if (!outbox_.empty()) outbox_.flush(out_);
    return read_all(in_);
  }
  void write(std::span<const std::byte> bytes) override {
    outbox_.add(bytes);
    outbox_.flush(out_);
  }
  std::uint64_t dropped_bytes() const override { return outbox_.dropped(); }

 private:
  /// A FIFO that somebody reads belongs to a run that is not dead.
  static void refuse_if_read(const std::string& path) {
    struct stat status {};
    if (lstat(path.c_str(), &status) != 0 || !S_ISFIFO(status.st_mode)) return;
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return;
    ::close(descriptor);
    errno = EEXIST;
    fail("is in use", path);
  }
  static void make_fifo(const std::string& path) {
    struct stat status {};
    if (lstat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode)) {
      spdlog::warn("serial port '{}': replaced the FIFO that a killed run left", path);
      unlink(path.c_str());
    }
    if (mkfifo(path.c_str(), 0600) != 0) fail("cannot make the FIFO", path);
  }
  void remove_all() {
    if (in_ >= 0) ::close(in_);
    if (out_ >= 0) ::close(out_);
    unlink(in_path_.c_str());
    unlink(out_path_.c_str());
  }
  std::string in_path_, out_path_;
  int in_ = -1;
  int out_ = -1;
  Outbox outbox_;
};

}  // namespace

std::unique_ptr<sim::BytePort> open_serial_port(const std::string& kind, const std::string& path) {
  if (kind == "fifo") return std::make_unique<FifoPort>(path);
  return std::make_unique<PtyPort>(path);
}

}  // namespace bridges
