// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/plugin_option.hpp"

#include <vector>

#include "sim/device/plugin.hpp"

namespace command_line {

void load_plugin(const std::string& file) {
  sim::Diagnostics diagnostics;
  const sim::SourcePlace place{sim::intern_file_name("--plugin " + file), 0, 0};
  const std::string found = sim::find_plugin(file, "");
  sim::load_plugin(found.empty() ? file : found, place, "", diagnostics);
  diagnostics.throw_if_any();
}

void add_plugin_option(CLI::App& command) {
  const auto load_all = [](const std::vector<std::string>& files) {
    for (const std::string& file : files) load_plugin(file);
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--plugin", load_all, "plugin library with additional devices, metrics, actions or algorithms")
      ->type_name("FILE")
      ->type_size(1)
      ->allow_extra_args(false);
}

}  // namespace command_line
