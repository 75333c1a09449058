// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "sim/config/diagnostics.hpp"
#include "verification/bench/bench_figures.hpp"

namespace verification {

namespace {

static_assert(std::is_trivially_copyable_v<BenchFigures>);

// The child answers with one of these and then the figures, or a text.
constexpr char figures_follow = 'f', wrong_input_follows = 'c', error_follows = 'e';

void write_all(int file, const void* data, std::size_t bytes) {
  for (const char* at = static_cast<const char*>(data); bytes > 0;) {
    const ssize_t written = ::write(file, at, bytes);
    if (written <= 0) return;  // the parent has ended
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

std::string read_all(int file) {
  std::string text;
  char block[4096];
  for (ssize_t got = 0; (got = ::read(file, block, sizeof block)) > 0;)
    text.append(block, static_cast<std::size_t>(got));
  return text;
}

/// Measures, and writes the answer.
void answer(int file, const BenchScene& scene, int vehicles, int threads, const BenchOptions& options) {
  char kind = figures_follow;
  std::string text;
  BenchFigures figures;
  try {
    figures = measure_bench(scene, vehicles, threads, options);
  } catch (const sim::ConfigError& error) {
    kind = wrong_input_follows;
    for (const std::string& line : error.lines()) text += line + '\n';
  } catch (const std::exception& error) {
    kind = error_follows;
    text = error.what();
  }
  write_all(file, &kind, 1);
  if (kind == figures_follow)
    write_all(file, &figures, sizeof figures);
  else
    write_all(file, text.data(), text.size());
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

}  // namespace

BenchFigures measure_bench_apart(const BenchScene& scene, int vehicles, int threads, const BenchOptions& options) {
  int ends[2];
  if (::pipe(ends) != 0)
    throw std::runtime_error(fmt::format("cannot open a pipe for the benchmark: {}", std::strerror(errno)));
  std::fflush(nullptr);  // otherwise both processes would write what is buffered
  const pid_t child = ::fork();
  if (child < 0)
    throw std::runtime_error(fmt::format("cannot start a process for the benchmark: {}", std::strerror(errno)));
  if (child == 0) {
    ::close(ends[0]);
    answer(ends[1], scene, vehicles, threads, options);
    std::fflush(nullptr);
    ::_exit(0);  // without taking the world apart
  }
  ::close(ends[1]);
  const std::string text = read_all(ends[0]);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const std::string who = fmt::format("scene '{}' with {} vehicles", scene.name, vehicles);
  if (WIFSIGNALED(status))
    throw std::runtime_error(fmt::format("{}: its process was ended by signal {}{}", who, WTERMSIG(status),
                                         WTERMSIG(status) == SIGKILL ? ", probably for lack of memory" : ""));
  if (text.size() == 1 + sizeof(BenchFigures) && text[0] == figures_follow) {
    BenchFigures figures;
    std::memcpy(&figures, text.data() + 1, sizeof figures);
    return figures;
  }
  if (!text.empty() && text[0] == wrong_input_follows) throw sim::ConfigError(lines_of(text.substr(1)));
  throw std::runtime_error(who + ": " + (text.empty() ? "its process ended" : text.substr(1)));
}

}  // namespace verification
