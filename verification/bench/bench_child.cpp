// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <type_traits>
#include <vector>

#include "bridges/base/forked_work.hpp"
#include "sim/config/diagnostics.hpp"
#include "verification/bench/bench_figures.hpp"

namespace verification {

namespace {

static_assert(std::is_trivially_copyable_v<BenchFigures>);

// The child answers with one of these and then the figures, or a text.
constexpr char figures_follow = 'f', wrong_input_follows = 'c', error_follows = 'e';

/// Measures, and returns the answer.
std::string answer(const BenchScene& scene, int vehicles, int threads, const BenchOptions& options) {
  try {
    const BenchFigures figures = measure_bench(scene, vehicles, threads, options);
    std::string text(1 + sizeof figures, figures_follow);
    std::memcpy(text.data() + 1, &figures, sizeof figures);
    return text;
  } catch (const sim::ConfigError& error) {
    std::string text(1, wrong_input_follows);
    for (const std::string& line : error.lines()) text += line + '\n';
    return text;
  } catch (const std::exception& error) {
    return error_follows + std::string(error.what());
  }
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
  std::fflush(nullptr);  // otherwise both processes would write what is buffered
  bridges::ForkedWork done;
  try {
    done = bridges::run_forked([&](int to) {
      bridges::write_all(to, answer(scene, vehicles, threads, options));
      std::fflush(nullptr);
      return 0;  // without taking the world apart
    });
  } catch (const std::system_error& error) {
    throw std::runtime_error(fmt::format("no process for a bench scene: {}", error.code().message()));
  }
  const std::string& text = *done.output;
  const int status = done.status;
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
