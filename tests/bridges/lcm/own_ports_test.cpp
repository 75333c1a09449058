// SPDX-License-Identifier: BSD-3-Clause
#include "tests/own_ports.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/project_paths.hpp"

// That two tests never have the same ports.

namespace {

using lcm_test::await;
using test_support::own_ports;
using test_support::take_port_slot;

int slot_of(int port) {
  return (port - test_support::first_own_port) / test_support::ports_of_a_slot;
}

/// A slot far from those that tests with process numbers near this one try first.
int distant_slot(int number) {
  return (static_cast<int>(getpid()) + test_support::port_slots / 2 + number) % test_support::port_slots;
}

/// A test in Python, which has its ports until this goes.
class PythonTest {
 public:
  /// It tries this slot first.
  explicit PythonTest(int slot) {
    std::array<int, 2> input{}, output{};
    if (pipe2(input.data(), O_CLOEXEC) != 0 || pipe2(output.data(), O_CLOEXEC) != 0)
      throw std::runtime_error("no pipe");
    const std::string module = test_support::source_path("tests/own_ports.py"), argument = std::to_string(slot);
    pid_ = fork();
    if (pid_ == 0) {
      dup2(input[0], 0);
      dup2(output[1], 1);
      execlp("python3", "python3", module.c_str(), argument.c_str(), nullptr);
      _exit(127);
    }
    close(input[0]);
    close(output[1]);
    input_ = input[1];
    for (char c = 0; read(output[0], &c, 1) == 1 && c != '\n';) url_ += c;
    close(output[0]);
  }
  ~PythonTest() {
    close(input_);
    waitpid(pid_, nullptr, 0);
  }
  PythonTest(const PythonTest&) = delete;
  PythonTest& operator=(const PythonTest&) = delete;
  int port() const { return std::stoi(url_.substr(url_.rfind(':') + 1)); }

 private:
  pid_t pid_;
  int input_;
  std::string url_;
};

TEST(OwnPorts, ATestInPythonGetsOthersThanOneInCpp) {
  const int port = own_ports();
  EXPECT_NE(PythonTest(slot_of(port)).port(), port);
}

TEST(OwnPorts, ATestInCppGetsOthersThanOneInPython) {
  int slot = 0;
  {
    const PythonTest other(distant_slot(0));
    slot = slot_of(other.port());
    EXPECT_EQ(take_port_slot(slot), 0);
    EXPECT_NE(own_ports(slot), other.port());
  }
  EXPECT_TRUE(await([&] { return take_port_slot(slot) != 0; })) << "they are free again when it has ended";
}

TEST(OwnPorts, AreFreeAgainThoughAProgramThatTheTestStartedStillRuns) {
  const test_support::ScratchFolder folder;
  const pid_t test = fork();
  if (test == 0) {
    const std::string port = std::to_string(own_ports(distant_slot(1)));
    _exit(std::system(("sleep 1000 & echo " + port + " $! > " + folder.file("said")).c_str()));
  }
  int status = -1, port = 0;
  waitpid(test, &status, 0);
  ASSERT_EQ(status, 0);
  pid_t program = 0;
  std::ifstream(folder.file("said")) >> port >> program;
  EXPECT_EQ(kill(program, 0), 0);
  EXPECT_TRUE(await([&] { return take_port_slot(slot_of(port)) != 0; }));
  kill(program, SIGKILL);
}

TEST(OwnPorts, AreNotThoseThatAProgramUses) {
  const int program = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0), yes = 1;
  setsockopt(program, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);  // as LCM does
  sockaddr_in address{};
  address.sin_family = AF_INET;
  const int port = own_ports(distant_slot(2)) + test_support::ports_of_a_slot + 5;
  address.sin_port = htons(static_cast<in_port_t>(port));
  ASSERT_EQ(bind(program, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(take_port_slot(slot_of(port)), 0);
  close(program);
  EXPECT_TRUE(await([&] { return take_port_slot(slot_of(port)) != 0; }));
}

}  // namespace
