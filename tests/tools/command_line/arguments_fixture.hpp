// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/command_line/checks.hpp"

namespace arguments_fixture {

using namespace command_line;

/// A program with the kinds of options and commands that there are.
struct App {
  CLI::App app{"A program.", "prog"};
  double number = 0;
  std::string place, file, out, title = "none";
  std::vector<std::string> sets;
  bool quiet = false, plots = true;

  App() {
    app.require_subcommand(1);
    CLI::App* run = app.add_subcommand("run", "Run it");
    run->add_option("WORLD", place, "world file");
    run->add_option("--duration", number, "how long")->type_name("S")->check(number_from(-10, 1e9));
    run->add_option("--record", file, "log")->type_name("FILE");
    run->add_option("--title", title, "of the run")->type_name("TITLE");
    run->add_option("--set", sets, "a value")->type_size(1)->allow_extra_args(false);
    run->add_flag("--quiet", quiet, "no words");
    run->add_flag_callback(
        "--no-plots", [this] { plots = false; }, "no images");
    CLI::App* log = app.add_subcommand("log", "Look into it");
    log->require_subcommand(1);
    log->add_subcommand("info", "What it is")->add_option("LOG", place, "log")->required();
    log->add_subcommand("csv", "A table")->add_option("--out", out, "file")->required();
  }
};

}  // namespace arguments_fixture
