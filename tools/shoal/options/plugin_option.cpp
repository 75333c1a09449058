// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/plugin.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

void load(const std::string& file) {
  sim::Diagnostics diagnostics;
  const sim::SourcePlace place{sim::intern_file_name("--plugin " + file), 0, 0};
  const std::string found = sim::find_plugin(file, "");
  sim::load_plugin(found.empty() ? file : found, place, "", diagnostics);
  diagnostics.throw_if_any();
}

}  // namespace

void add_plugin_option(CLI::App& command) {
  const auto load_all = [](const std::vector<std::string>& files) {
    for (const std::string& file : files) load(file);
  };
  command.add_option_function<std::vector<std::string>>("--plugin", load_all, "plugin library with additional devices")
      ->type_name("FILE")
      ->type_size(1)
      ->allow_extra_args(false);
}

}  // namespace tools
