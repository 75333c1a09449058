// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <thread>

#include "tests/project_paths.hpp"
#include "tests/system/shoal_program.hpp"

namespace system_test {

namespace {

/// Who is given no LCM URL does not reach the common default.
const int own_default_bus = setenv("LCM_DEFAULT_URL", own_url(7).c_str(), 1);

/// What /proc/PID/stat has behind the name: the state, a letter, and the parent; nothing without such a process, also
/// when it goes while this is read.
std::string status_of(const std::string& pid) {
  std::ifstream in("/proc/" + pid + "/stat");
  std::string line;
  std::getline(in, line);
  const std::size_t name_end = line.rfind(") ");
  return name_end == std::string::npos ? "" : line.substr(name_end + 2);
}

}  // namespace

std::string built(const std::string& program) {
  return test_support::built_path("bin/" + program);
}

std::string source(const std::string& path) {
  return test_support::source_path(path);
}

std::string text_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  if (!(out << text << std::flush)) throw std::runtime_error("cannot write " + path);
}

Program::Program(std::vector<std::string> arguments) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const std::string out = scratch_.file("out"), err = scratch_.file("err");
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("cannot start " + arguments[0]);
  if (pid_ > 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // it does not outlive a test that is killed
  const auto replace = [](int descriptor, const char* path, int flags) {
    const int file = open(path, flags, 0600);
    if (file < 0 || dup2(file, descriptor) < 0) _exit(126);
    close(file);
  };
  replace(0, "/dev/null", O_RDONLY);
  replace(1, out.c_str(), O_WRONLY | O_CREAT | O_APPEND);
  replace(2, err.c_str(), O_WRONLY | O_CREAT | O_APPEND);
  execvp(pointers[0], pointers.data());
  perror(pointers[0]);
  _exit(127);
}

Program::~Program() {
  if (!running()) return;
  send_signal(SIGKILL);
  wait();
}

void Program::send_signal(int signal) const {
  kill(pid_, signal);
}

bool Program::running() {
  int status = 0;
  rusage usage{};
  if (!over_ && wait4(pid_, &status, WNOHANG, &usage) == pid_) {
    over_ = true;
    peak_kB_ = usage.ru_maxrss;
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  return !over_;
}

int Program::wait(std::chrono::milliseconds limit) {
  if (await([this] { return !running(); }, limit)) return exit_code_;
  send_signal(SIGKILL);
  waitpid(pid_, nullptr, 0);
  over_ = true;
  return -1;
}

std::vector<pid_t> Program::children() const {
  std::vector<pid_t> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string status = status_of(name);
    if (!status.empty() && std::stoi(status.substr(2)) == pid_) found.push_back(std::stoi(name));
  }
  return found;
}

std::vector<pid_t> Program::await_children(std::size_t count) const {
  await([&] { return children().size() >= count; });
  return children();
}

Ended run_shoal(std::vector<std::string> arguments, std::chrono::milliseconds limit) {
  arguments.insert(arguments.begin(), built("shoal"));
  Program program(std::move(arguments));
  const int exit_code = program.wait(limit);
  return {exit_code, program.output(), program.errors()};
}

Ended control(std::vector<std::string> arguments, const std::string& url) {
  arguments.insert(arguments.begin(), "control");
  arguments.insert(arguments.end(), {"--lcm-url", url});
  if (std::find(arguments.begin(), arguments.end(), "--timeout") == arguments.end())
    arguments.insert(arguments.end(), {"--timeout", "60"});
  return run_shoal(arguments);
}

namespace {

std::string hash_in(const Ended& ended, const std::string& kind) {
  std::smatch match;
  if (std::regex_search(ended.output, match, std::regex(kind + " hash ([0-9a-f]{16})"))) return match[1];
  return "exit code " + std::to_string(ended.exit_code) + ": " + ended.errors + ended.output;
}

}  // namespace

std::string state_hash_in(const Ended& ended) {
  return hash_in(ended, "state");
}

std::string run_hash_in(const Ended& ended) {
  return hash_in(ended, "run");
}

void await_pause() {
  EXPECT_TRUE(await([] { return control({"where"}).output.find(", paused") != std::string::npos; }, timeout));
}

void run_until(const std::string& time_s) {
  const Ended until = control({"until", "--value", time_s});
  EXPECT_EQ(until.exit_code, 0) << until.errors;
  await_pause();
}

bool is_running(pid_t pid) {
  const std::string status = status_of(std::to_string(pid));
  return !status.empty() && status[0] != 'Z';
}

std::string summary_value(const std::string& directory, const std::string& key) {
  const std::string text = text_of_file(directory + "/summary.json");
  const std::string mark = "\n  \"" + key + "\": ";
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return "no key " + key + " in " + text;
  const std::size_t begin = at + mark.size();
  std::string value = text.substr(begin, text.find('\n', begin) - begin);
  if (value.ends_with(',')) value.pop_back();
  return value;
}

std::string endless_world(const std::string& more) {
  return "shoal: 1\n"
         "name: endless\n"
         "run: {duration_s: forever, speed: 1}\n"
         "state_rate_hz: 100\n"
         "objects:\n"
         "  - {name: ground, fixed: true, parts: [{shape: plane}]}\n"
         "vehicles:\n"
         "  - name: rover1\n"
         "    file: " +
         source("vehicles/rover.yaml") + "\n" + more;
}

}  // namespace system_test
