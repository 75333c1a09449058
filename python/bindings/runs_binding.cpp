// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "experiment/process/world_programs.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/version.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "messages/yaml/message_writer.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/gil.hpp"
#include "python/bindings/in_use.hpp"
#include "python/world/error.hpp"
#include "sim/base/log.hpp"
#include "sim/config/file_access.hpp"

namespace py = pybind11;

namespace python {
namespace {

/// Arguments of run(), as options of `shoal run`.
struct RunArguments {
  std::string world;
  std::optional<std::string> text;  ///< YAML instead of the file
  std::optional<std::int64_t> seed;
  std::vector<std::string> sets;
  std::optional<double> duration_s;
  std::string results, record, bus, lcm_url;
  std::vector<std::string> wait_for;
  bool launch = false, overwrite = false;
};

/// Runs a world to its end, and returns its summary as JSON.
std::string run(const RunArguments& arguments) {
  sim::LoadOptions load;
  load.sets = arguments.sets;
  load.seed = arguments.seed;
  load.encode_message = shoal::encode_own_message;
  load.duration_s = arguments.duration_s;
  load.allow_plugins = arguments.launch;
  experiment::RunOptions options;
  options.duration_s = arguments.duration_s;
  options.speed = 0;
  options.bus = arguments.bus;
  options.lcm_url = arguments.lcm_url;
  options.results = arguments.results;
  options.record = arguments.record;
  options.overwrite = arguments.overwrite;
  options.launch = arguments.launch;
  options.await = arguments.wait_for;
  options.quiet = true;
  options.keys = false;
  experiment::Summary summary;
  {
    const WithoutGil others;
    sim::LoadedWorld loaded = arguments.text ? sim::load_world_text(*arguments.text, arguments.world, load)
                                             : sim::load_world(arguments.world, load);
    experiment::read_programs(loaded, {options.launch, load.allow_paths});
    auto next_check = std::chrono::steady_clock::now();
    options.leave = [&next_check] {
      const auto now = std::chrono::steady_clock::now();
      if (now < next_check) return false;
      next_check = now + std::chrono::milliseconds(20);
      return interrupted();
    };
    summary = experiment::run_world(loaded, options);
  }
  raise_interrupt();
  if (!summary.error.empty()) throw Error(summary.error);
  return summary.to_json();
}

/// Writes warnings to standard error, as the programs do; standard output belongs to the program in Python.
void log_to_stderr() {
  constexpr const char* name = "shoal";
  if (spdlog::get(name)) return;
  spdlog::set_default_logger(spdlog::stderr_color_mt(name));
  sim::set_log_level("warn");
  spdlog::set_pattern("%^%l%$: %v");
}

void set_log_level(const std::string& name) {
  const std::vector<std::string> names{"debug", "info", "warn", "error", "off"};
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw Error("a log level is debug, info, warn, error or off, got '" + name + "'");
  sim::set_log_level(name);
}

}  // namespace

void add_runs(py::module_& module) {
  using py::literals::operator""_a;
  log_to_stderr();
  module.def("set_log_level", &set_log_level, "level"_a);
  module.def(
      "warn", [](const std::string& text) { sim::log_warn("{}", text); }, "text"_a, "Logs a warning.");
  module.def(
      "run",
      [](std::string world, std::optional<std::string> text, std::optional<std::int64_t> seed,
         std::vector<std::string> sets, std::optional<double> duration_s, std::string results, std::string record,
         std::string bus, std::string lcm_url, std::vector<std::string> wait_for, bool launch, bool overwrite) {
        return run({std::move(world), std::move(text), seed, std::move(sets), duration_s, std::move(results),
                    std::move(record), std::move(bus), std::move(lcm_url), std::move(wait_for), launch, overwrite});
      },
      "world"_a, "text"_a, "seed"_a, "sets"_a, "duration_s"_a, "results"_a, "record"_a, "bus"_a, "lcm_url"_a,
      "wait_for"_a, "launch"_a, "overwrite"_a);
  module.def("version", &experiment::version_text, "Returns the versions of Shoal and of its libraries.");
  module.def("short_version", &experiment::short_version, "Returns the version of Shoal only.");
  module.def("world_file", &experiment::world_file, "name"_a, "Returns the path of a world file; see World.");
  module.def("shipped_folder", &sim::shipped_folder, "Returns the folder with the shipped worlds; '': there is none.");
  module.def("program_folder", &sim::program_folder, "Returns the folder of the program shoal; '': there is none.");
}

}  // namespace python
