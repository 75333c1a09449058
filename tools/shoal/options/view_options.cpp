// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/options/view_options.hpp"

#include "tools/command_line/checks.hpp"

namespace tools {

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
  command.add_option("--view-page", view.page_directory, "folder with the page, for its development")->type_name("DIR");
}

CLI::Option* add_open_option(CLI::App& command, bool& open) {
  return command.add_flag("--open", open, "show the live page in the browser: $BROWSER, else xdg-open");
}

}  // namespace tools
