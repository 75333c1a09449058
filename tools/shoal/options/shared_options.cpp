// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/options/shared_options.hpp"

#include <CLI/App.hpp>

#include "sim/base/log.hpp"
#include "sim/base/number.hpp"
#include "tools/command_line/checks.hpp"

namespace tools {

CLI::Option* add_log_level_option(CLI::App& command, const std::string& usual) {
  const auto set = [](const std::string& level) { sim::set_log_level(level); };
  command.preparse_callback([set, usual](std::size_t) { set(usual); });
  return command
      .add_option_function<std::string>(
          "--log-level", set,
          "lowest level of messages on stderr: debug, info (with progress), warn, error, or off for only the error "
          "that ends the command")
      ->type_name("LEVEL")
      ->default_str(usual)
      ->check(one_of({"debug", "info", "warn", "error", "off"}).description(""));
}

void add_set_option(CLI::App& command, std::vector<std::string>& sets) {
  command.add_option("--set", sets, "change a value of the world file, such as run.seed=3")
      ->type_name("PATH=VALUE")
      ->type_size(1)
      ->allow_extra_args(false)
      ->check(command_line::setting());
}

void add_allow_path_option(CLI::App& command, sim::LoadOptions& load) {
  load.only_own_files = true;
  command
      .add_option("--allow-path", load.allow_paths,
                  "folder or file outside of the world's folder that the world may use, also for serial ports")
      ->type_name("PATH")
      ->type_size(1)
      ->allow_extra_args(false);
}

CLI::Option* add_lcm_url_option(CLI::App& command, std::string& url) {
  return command.add_option("--lcm-url", url, "LCM URL; overrides LCM_DEFAULT_URL")->type_name("URL");
}

void add_threads_option(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "threads that share the work of a step; 0: one for each processor")
      ->type_name("N")
      ->check(whole_from(0, 256));
}

void add_types_option(CLI::App& command, std::vector<std::string>& lcm_files) {
  command.add_option("--types", lcm_files, ".lcm file of types that are not Shoal's")
      ->type_name("FILE")
      ->type_size(1)
      ->allow_extra_args(false);
}

std::optional<double> parse_speed(const std::string& text) {
  if (text.empty()) return std::nullopt;
  if (text == "max") return 0.0;
  if (const auto speed = sim::read_number(text); speed && *speed >= 0.001 && *speed <= 1e6) return speed;
  throw CLI::ValidationError("--speed", "must be from 0.001 to 1e6, or max, got '" + text + "'");
}

void add_page_options(CLI::App& command, experiment::ViewOptions& view) {
  command
      .add_option("--view-port", view.port, "port of the live page; if it is taken, the next free one; 0: any free one")
      ->type_name("PORT")
      ->check(command_line::whole_from(0, 65535))
      ->capture_default_str();
  command
      .add_option("--view-host", view.host,
                  "address at which the live page listens; non-local addresses require the token for reading too")
      ->type_name("ADDRESS")
      ->capture_default_str();
  command.add_option("--view-origin", view.origins, "additional web site whose pages may connect")
      ->type_name("URL")
      ->type_size(1)
      ->allow_extra_args(false);
  command.add_flag("--foxglove-control", view.foxglove_control,
                   "any local Foxglove client may pause, rewind and change the run, or play the log");
  command.add_flag("--rosbridge", view.rosbridge,
                   "serve rosbridge v2 at the port of the live page, for roslib and others: ws://127.0.0.1:PORT");
  command.add_option("--view-page", view.page_directory, "folder with the page, for its development")->type_name("DIR");
}

CLI::Option* add_open_option(CLI::App& command, bool& open) {
  return command.add_flag("--open", open, "show the live page in the browser: $BROWSER, else xdg-open");
}

}  // namespace tools
