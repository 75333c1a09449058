// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace system_test {

using namespace std::chrono_literals;

using lcm_test::await;
using lcm_test::own_url;
using lcm_test::ScratchFolder;

/// Much more than anything here takes: other tests may run at the same time.  It only ends a test that has failed,
/// before CTest does.
constexpr std::chrono::seconds timeout{240};

/// A program of the build tree, such as `shoal`.
std::string built(const std::string& program);
/// A file of the source tree, such as `worlds/minimal.yaml`.
std::string source(const std::string& path);
std::string text_of_file(const std::string& path);
void write_file(const std::string& path, const std::string& text);

/// A child process, killed at the latest when this goes.
class Program {
 public:
  /// `arguments[0]` is the program, looked up in PATH.  The thread must outlive it.
  explicit Program(std::vector<std::string> arguments);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  pid_t pid() const { return pid_; }
  void send_signal(int signal) const;
  /// The exit code, 128 + signal when one killed it.  Kills it when it does not end in time, and gives -1.
  int wait(std::chrono::milliseconds limit = timeout);
  bool running();
  /// The most memory that it had, once it is over.
  long peak_kB() const { return peak_kB_; }
  std::string output() const { return text_of_file(scratch_.file("out")); }
  std::string errors() const { return text_of_file(scratch_.file("err")); }
  /// Processes that it started itself, by the parent in /proc/PID/stat: /proc/PID/task/PID/children is exact only for a
  /// process that stands still.
  std::vector<pid_t> children() const;
  /// The same, once there are so many.
  std::vector<pid_t> await_children(std::size_t count) const;

 private:
  ScratchFolder scratch_;
  pid_t pid_ = 0;
  bool over_ = false;
  int exit_code_ = -1;
  long peak_kB_ = 0;
};

struct Ended {
  int exit_code = -1;
  std::string output;
  std::string errors;
};

/// Runs `shoal` with these arguments to its end.
Ended run_shoal(std::vector<std::string> arguments, std::chrono::milliseconds limit = timeout);
/// `shoal control`; a simulator that is there answers, however busy the machine is.
Ended control(std::vector<std::string> arguments, const std::string& url = own_url());
/// Waits until the run stands.
void await_pause();
/// Lets a run that is paused continue to a time, and waits until it is there.
void run_until(const std::string& time_s);
/// The 16 digits after `state hash`, or what was said instead.
std::string state_hash_in(const Ended& ended);
/// The same after `run hash`: equal for equal runs, not only for equal ends.
std::string run_hash_in(const Ended& ended);

/// Neither gone nor dead and waiting to be noticed.
bool is_running(pid_t pid);

/// The value of a key at the top of DIRECTORY/summary.json, as written there.
std::string summary_value(const std::string& directory, const std::string& key);

/// One rover on flat ground that runs until it is commanded to quit, with a report of its pose at every step of
/// 0.01 s. `more`: further keys of the rover, indented by four spaces, and of the world.
std::string endless_world(const std::string& more = "");

}  // namespace system_test
