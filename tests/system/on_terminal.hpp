// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "tests/system/shoal_program.hpp"

namespace system_test {

/// A program with its own terminal; 0 columns and lines: of unknown size.
class OnTerminal {
 public:
  explicit OnTerminal(std::vector<std::string> arguments, unsigned short columns = 0, unsigned short lines = 0) {
    winsize size{};
    size.ws_col = columns;
    size.ws_row = lines;
    pid_ = forkpty(&terminal_, nullptr, nullptr, &size);
    if (pid_ == 0) {
      std::vector<char*> argv;
      for (std::string& argument : arguments) argv.push_back(argument.data());
      argv.push_back(nullptr);
      execvp(argv[0], argv.data());
      _exit(127);
    }
  }
  ~OnTerminal() {
    if (pid_ > 0 && !over_) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(terminal_);
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  void press(const std::string& keys) const {
    EXPECT_EQ(write(terminal_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  /// Waits until the terminal shows a text that it has not shown before; what was shown up to its end is used up.
  bool shows(const std::string& text) {
    const bool found = await(
        [&] {
          read_all();
          return shown_.find(text) != std::string::npos;
        },
        timeout);
    EXPECT_TRUE(found) << "no '" << text << "' in: " << shown_;
    if (found) shown_.erase(0, shown_.find(text) + text.size());
    return found;
  }
  int wait() {
    int status = 0;
    const bool ended = await(
        [&] {
          read_all();
          return waitpid(pid_, &status, WNOHANG) == pid_;
        },
        timeout);
    over_ = ended;
    if (!ended) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  /// It stands still after Ctrl-Z.
  bool is_stopped() {
    return await(
        [&] {
          read_all();
          int status = 0;
          return waitpid(pid_, &status, WNOHANG | WUNTRACED) == pid_ && WIFSTOPPED(status);
        },
        timeout);
  }
  /// Keys are given one by one, without echo.
  bool is_raw() const {
    termios settings{};
    tcgetattr(terminal_, &settings);
    return (settings.c_lflag & (ICANON | ECHO)) == 0;
  }
  pid_t pid() const { return pid_; }
  /// What the terminal got and shows() has not used up.
  const std::string& shown() const { return shown_; }
  int file() const { return terminal_; }

 private:
  void read_all() {
    pollfd waiting{terminal_, POLLIN, 0};
    char part[4096];
    while (poll(&waiting, 1, 0) > 0 && (waiting.revents & POLLIN) != 0) {
      const ssize_t got = read(terminal_, part, sizeof part);
      if (got <= 0) return;
      shown_.append(part, static_cast<std::size_t>(got));
    }
  }

  pid_t pid_ = 0;
  int terminal_ = -1;
  bool over_ = false;
  std::string shown_;
};

}  // namespace system_test
