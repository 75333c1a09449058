// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <thread>

#include "tests/project_paths.hpp"
#include "tests/system/shoal_program.hpp"

extern char** environ;

namespace system_test {

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
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, scratch_.file("out").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, scratch_.file("err").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  const int error = posix_spawnp(&pid_, pointers[0], &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("cannot start " + arguments[0]);
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
  if (!over_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    over_ = true;
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
  const std::string task = "/proc/" + std::to_string(pid_) + "/task/" + std::to_string(pid_) + "/children";
  std::ifstream in(task);
  return {std::istream_iterator<pid_t>(in), {}};
}

Ended run_shoal(std::vector<std::string> arguments, std::chrono::milliseconds limit) {
  arguments.insert(arguments.begin(), built("shoal"));
  Program program(std::move(arguments));
  const int exit_code = program.wait(limit);
  return {exit_code, program.output(), program.errors()};
}

Ended control(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "control");
  arguments.insert(arguments.end(), {"--lcm-url", own_url()});
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

bool is_running(pid_t pid) {
  const std::string status = text_of_file("/proc/" + std::to_string(pid) + "/stat");
  const std::size_t name_end = status.rfind(") ");
  return name_end != std::string::npos && status[name_end + 2] != 'Z';
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
