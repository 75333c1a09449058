// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_line/name_list.hpp"

#include <algorithm>

#include "tools/command_line/checks.hpp"

namespace command_line {

namespace {

void split_names(const std::string& option, const std::string& text, std::vector<std::string>& names) {
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end == begin) throw CLI::ValidationError(option, "must be names, comma separated, got " + quoted(text));
    names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

}  // namespace

CLI::Option* add_name_list(CLI::App& command, const std::string& option, std::vector<std::string>& names,
                           const std::string& meaning) {
  return command
      .add_option_function<std::vector<std::string>>(
          option,
          [option, &names](const std::vector<std::string>& texts) {
            names.clear();
            for (const std::string& text : texts) split_names(option, text, names);
          },
          meaning)
      ->type_name("NAMES")
      ->type_size(1)
      ->allow_extra_args(false);
}

}  // namespace command_line
