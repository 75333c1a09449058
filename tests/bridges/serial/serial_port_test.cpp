// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/serial/serial_port.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <pty.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

namespace fs = std::filesystem;

using bridges::open_serial_port;
using lcm_test::await;
using lcm_test::bytes_of;
using lcm_test::ScratchFolder;
using lcm_test::text_of;
using sim::PortKind;

/// A program's end of the port.
class Program {
 public:
  Program(const std::string& path, int how) : descriptor_(open(path.c_str(), how | O_NOCTTY | O_NONBLOCK)) {
    if (descriptor_ < 0) throw std::runtime_error("cannot open " + path);
  }
  ~Program() { close(descriptor_); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void write(const std::string& text) const {
    ASSERT_EQ(::write(descriptor_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  /// What is there, until nothing has come for 200 ms.
  std::string read() const {
    std::string all;
    pollfd waiting{descriptor_, POLLIN, 0};
    while (poll(&waiting, 1, 200) == 1) {
      char chunk[4096];
      const ssize_t size = ::read(descriptor_, chunk, sizeof chunk);
      if (size <= 0) break;
      all.append(chunk, static_cast<std::size_t>(size));
    }
    return all;
  }

 private:
  int descriptor_;
};

/// Reads the port until `size` bytes have come.
std::string read_from(sim::BytePort& port, std::size_t size) {
  std::string all;
  await([&] { return (all += text_of(port.read())).size() >= size; });
  return all;
}

std::string error_of(PortKind kind, const std::string& path) {
  try {
    open_serial_port(kind, path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

std::string all_bytes() {
  std::string text;
  for (int c = 0; c < 256; ++c) text += static_cast<char>(c);
  return text;
}

TEST(SerialPort, PtyCarriesEveryByteBothWays) {
  const ScratchFolder folder;
  const auto port = open_serial_port(PortKind::pty, folder.file("modem"));
  const Program program(folder.file("modem"), O_RDWR);
  program.write(all_bytes());
  EXPECT_EQ(read_from(*port, 256), all_bytes());
  port->write(bytes_of(all_bytes()));
  EXPECT_EQ(program.read(), all_bytes());  // and no echo of what it wrote
}

TEST(SerialPort, PtyOutlivesTheProgramsThatOpenIt) {
  const ScratchFolder folder;
  const auto port = open_serial_port(PortKind::pty, folder.file("modem"));
  Program(folder.file("modem"), O_RDWR).write("first");
  EXPECT_EQ(read_from(*port, 5), "first");
  Program(folder.file("modem"), O_RDWR).write("second");
  EXPECT_EQ(read_from(*port, 6), "second");
}

TEST(SerialPort, FifoCarriesEveryByteBothWays) {
  const ScratchFolder folder;
  const auto port = open_serial_port(PortKind::fifo, folder.file("modem"));
  const Program writer(folder.file("modem.in"), O_WRONLY);
  const Program reader(folder.file("modem.out"), O_RDONLY);
  writer.write(all_bytes());
  EXPECT_EQ(read_from(*port, 256), all_bytes());
  port->write(bytes_of(all_bytes()));
  EXPECT_EQ(reader.read(), all_bytes());
}

TEST(SerialPort, NothingToReadIsNoWait) {
  const ScratchFolder folder;
  for (const PortKind kind : {PortKind::pty, PortKind::fifo})
    EXPECT_TRUE(open_serial_port(kind, folder.file("modem"))->read().empty());
}

TEST(SerialPort, LeavesNothingBehind) {
  const ScratchFolder folder;
  for (const PortKind kind : {PortKind::pty, PortKind::fifo}) {
    open_serial_port(kind, folder.file("port/modem"));
    EXPECT_TRUE(fs::is_empty(folder.file("port"))) << static_cast<int>(kind);
  }
}

TEST(SerialPort, MakesTheDirectory) {
  const ScratchFolder folder;
  const auto port = open_serial_port(PortKind::pty, folder.file("a/b/modem"));
  EXPECT_TRUE(fs::is_symlink(folder.file("a/b/modem")));
  EXPECT_THAT(error_of(PortKind::pty, "/proc/nowhere/modem"),
              testing::StartsWith("serial port '/proc/nowhere/modem': cannot create its directory: "));
}

TEST(SerialPort, ReplacesWhatADeadRunLeft) {
  const ScratchFolder folder;
  fs::create_symlink("/dev/pts/./99999", folder.file("modem"));
  const auto pty = open_serial_port(PortKind::pty, folder.file("modem"));
  Program(folder.file("modem"), O_RDWR).write("x");
  EXPECT_EQ(read_from(*pty, 1), "x");

  for (const char* name : {"fifo.in", "fifo.out"}) {
    ASSERT_EQ(mkfifo(folder.file(name).c_str(), 0600), 0);
    ASSERT_EQ(chmod(folder.file(name).c_str(), S_ISVTX | 0600), 0);  // the mark of a run
  }
  const auto fifo = open_serial_port(PortKind::fifo, folder.file("fifo"));
  Program(folder.file("fifo.in"), O_WRONLY).write("x");
  EXPECT_EQ(read_from(*fifo, 1), "x");
}

TEST(SerialPort, SaysThatItReplacedALinkOfADeadRun) {
  const ScratchFolder folder;
  const test_support::LogCapture log;
  fs::create_symlink("/dev/pts/./99999", folder.file("modem"));
  const auto pty = open_serial_port(PortKind::pty, folder.file("modem"));
  EXPECT_THAT(log.text(), testing::HasSubstr("serial port '" + folder.file("modem") +
                                             "': replaced a link left behind by a killed run"));
}

/// The system gives the number of a terminal that is gone to the next one: here the terminal of another port.
TEST(SerialPort, ReplacesALinkOfADeadRunWhoseTerminalIsAnotherOneNow) {
  const ScratchFolder folder;
  const auto other = open_serial_port(PortKind::pty, folder.file("other"));
  fs::copy_symlink(folder.file("other"), folder.file("modem"));
  const auto pty = open_serial_port(PortKind::pty, folder.file("modem"));
  Program(folder.file("modem"), O_RDWR).write("x");
  EXPECT_EQ(read_from(*pty, 1), "x");
  EXPECT_THAT(error_of(PortKind::pty, folder.file("other")), testing::HasSubstr("is in use"));
  EXPECT_THAT(error_of(PortKind::pty, folder.file("modem")), testing::HasSubstr("is in use"));
}

TEST(SerialPort, IsInUseUnderEveryNameOfItsFolder) {
  const ScratchFolder folder;
  const auto pty = open_serial_port(PortKind::pty, folder.file("a/modem"));
  EXPECT_THAT(error_of(PortKind::pty, folder.file("a/../a/./modem")), testing::HasSubstr("is in use"));
}

/// As `socat pty,link=...` makes one.
TEST(SerialPort, RefusesALinkThatAnotherProgramMadeToALiveTerminal) {
  const ScratchFolder folder;
  int master = -1, slave = -1;
  char name[128];
  ASSERT_EQ(openpty(&master, &slave, name, nullptr, nullptr), 0);
  fs::create_symlink(name, folder.file("modem"));
  EXPECT_THAT(error_of(PortKind::pty, folder.file("modem")),
              testing::HasSubstr("is in use: File exists; if no run uses it, remove the link"));
  EXPECT_EQ(fs::read_symlink(folder.file("modem")), name);
  close(master);
  close(slave);
}

TEST(SerialPort, RefusesToReplaceAnyOtherFile) {
  const ScratchFolder folder;
  for (const char* name : {"modem", "fifo.in", "fifo2.out"}) std::ofstream(folder.file(name)) << "precious";
  EXPECT_EQ(error_of(PortKind::pty, folder.file("modem")),
            "serial port '" + folder.file("modem") + "': cannot create the link: File exists");
  EXPECT_EQ(error_of(PortKind::fifo, folder.file("fifo")),
            "serial port '" + folder.file("fifo.in") + "': cannot create the FIFO: File exists");
  EXPECT_EQ(error_of(PortKind::fifo, folder.file("fifo2")),
            "serial port '" + folder.file("fifo2.out") + "': cannot create the FIFO: File exists");
  EXPECT_FALSE(fs::exists(folder.file("fifo2.in")));  // nothing half made is left
  EXPECT_EQ(fs::file_size(folder.file("modem")), 8u);
}

/// Before: dangling links and FIFOs of anyone were removed.
TEST(SerialPort, LeavesWhatOthersMade) {
  const ScratchFolder folder;
  for (const char* target : {"/dev/pts/no-such-terminal", "/nowhere/at/all", "gone"}) {
    fs::remove(folder.file("modem"));
    fs::create_symlink(target, folder.file("modem"));
    EXPECT_THAT(error_of(PortKind::pty, folder.file("modem")), testing::HasSubstr("is in use")) << target;
    EXPECT_EQ(fs::read_symlink(folder.file("modem")), target);
  }
  ASSERT_EQ(mkfifo(folder.file("fifo.in").c_str(), 0600), 0);
  EXPECT_EQ(error_of(PortKind::fifo, folder.file("fifo")),
            "serial port '" + folder.file("fifo.in") + "': cannot create the FIFO: File exists");
  EXPECT_TRUE(fs::is_fifo(folder.file("fifo.in")));
}

TEST(SerialPort, RemovesOnlyWhatIsItsOwn) {
  const ScratchFolder folder;
  {
    const auto pty = open_serial_port(PortKind::pty, folder.file("modem"));
    const auto fifo = open_serial_port(PortKind::fifo, folder.file("fifo"));
    for (const char* name : {"modem", "fifo.in"}) {
      fs::remove(folder.file(name));
      std::ofstream(folder.file(name)) << "precious";
    }
  }
  EXPECT_EQ(fs::file_size(folder.file("modem")), 8u);
  EXPECT_EQ(fs::file_size(folder.file("fifo.in")), 8u);
  EXPECT_FALSE(fs::exists(folder.file("fifo.out")));
}

TEST(SerialPort, FollowsNoLinkBelowItsFolder) {
  const ScratchFolder folder, home;
  fs::create_directory_symlink(home.file(""), folder.file("way"));
  for (const PortKind kind : {PortKind::pty, PortKind::fifo})
    for (const char* path : {"way/modem", "../modem", "a/../../modem", "/tmp/modem", "..", ".", ""}) {
      EXPECT_THROW(bridges::open_serial_port(kind, folder.file(""), path), std::runtime_error) << path;
      EXPECT_TRUE(fs::is_empty(home.file(""))) << path;
    }
  const auto port = bridges::open_serial_port(PortKind::pty, folder.file(""), "a/b/modem");
  EXPECT_TRUE(fs::is_symlink(folder.file("a/b/modem")));
}

TEST(SerialPort, RefusesThePortOfARunningProgram) {
  const ScratchFolder folder;
  const auto pty = open_serial_port(PortKind::pty, folder.file("modem"));
  EXPECT_THAT(error_of(PortKind::pty, folder.file("modem")), testing::HasSubstr("is in use"));
  const auto fifo = open_serial_port(PortKind::fifo, folder.file("fifo"));
  EXPECT_THAT(error_of(PortKind::fifo, folder.file("fifo")), testing::HasSubstr("is in use"));
  Program(folder.file("fifo.in"), O_WRONLY).write("still mine");
  EXPECT_EQ(read_from(*fifo, 10), "still mine");
}

TEST(SerialPort, AReaderThatNeverReadsCostsOnlyTheOldestBytes) {
  const ScratchFolder folder;
  for (const PortKind kind : {PortKind::pty, PortKind::fifo}) {
    const auto port = open_serial_port(kind, folder.file("modem"));
    const bool fifo = kind == PortKind::fifo;
    const Program program(folder.file(fifo ? "modem.out" : "modem"), fifo ? O_RDONLY : O_RDWR);
    const std::string line = "0123456789abcde\n";
    constexpr int lines = 50'000;
    for (int i = 0; i < lines; ++i) port->write(bytes_of(line));
    port->write(bytes_of("the end\n"));
    const std::uint64_t sent = lines * line.size() + 8;
    EXPECT_GT(port->dropped_bytes(), sent / 2) << static_cast<int>(kind);
    std::string received;
    // The port sends what waits when it is used.
    await([&] {
      port->read();
      received += program.read();
      return received.ends_with("the end\n");
    });
    EXPECT_EQ(received.size() + port->dropped_bytes(), sent) << static_cast<int>(kind);
    EXPECT_TRUE(received.ends_with("the end\n")) << static_cast<int>(kind);
  }
}

}  // namespace
