// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/options/shared_options.hpp"

#include "sim/base/log.hpp"

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

}  // namespace tools
