// SPDX-License-Identifier: BSD-3-Clause
// Ten experiments in Shoal, in MuJoCo and by closed form.
//   cross_check [EXPERIMENT ...] [--page FILE]
// Without --page it prints the tables; with it, it writes docs/models/cross_check.md, and cross_check/runs.csv beside
// it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/cross_check/page.hpp"

namespace {

/// Writes the page, and its table into the folder of the same name.
int write_page(const std::filesystem::path& path, const std::vector<cross_check::Experiment>& chosen) {
  const std::filesystem::path folder = std::filesystem::path(path).replace_extension();
  std::filesystem::create_directories(folder);
  std::ofstream page(path), table(folder / "runs.csv");
  const std::vector<cross_check::Measured> all = cross_check::measure(chosen);
  cross_check::write_page(page, all);
  cross_check::write_csv(table, all);
  if (page.flush() && table.flush()) return 0;
  std::cerr << "cross_check: cannot write '" << path.string() << "'\n";
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Ten experiments in Shoal, in MuJoCo and by closed form");
  std::vector<std::string> names;
  std::string page;
  std::vector<cross_check::Experiment> chosen = cross_check::experiments();
  std::vector<std::string> known;
  for (const cross_check::Experiment& each : chosen) known.push_back(each.name);
  app.add_option("experiments", names, "names of experiments; default: all")
      ->type_name("EXPERIMENT")
      ->check(CLI::IsMember(known));
  app.add_option("--page", page, "write the page of all experiments to this file")->type_name("FILE");
  CLI11_PARSE(app, argc, argv);
  try {
    if (!page.empty() && cross_check::mujoco_version().empty())
      throw std::runtime_error("the page needs the rows of MuJoCo; install libmujoco-dev and configure again");
    if (!page.empty()) return write_page(page, chosen);
    if (!names.empty())
      std::erase_if(chosen,
                    [&](const auto& each) { return std::find(names.begin(), names.end(), each.name) == names.end(); });
    cross_check::write_tables(std::cout, cross_check::measure(chosen));
  } catch (const std::exception& error) {
    std::cerr << "cross_check: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
