// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/commands/live_page.hpp"

#include <charconv>
#include <chrono>
#include <iostream>
#include <set>
#include <thread>
#include <utility>

#include "experiment/run/version.hpp"
#include "experiment/world_files/watched_files.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "viewer/server/run_view.hpp"
#include "viewer/server/waiting_page.hpp"

namespace tools {

namespace {

/// Takes port and token of an address `http://HOST:PORT/#t=TOKEN`, so that further runs have the same.
void keep_address(const std::string& url, experiment::ViewOptions& view) {
  constexpr std::string_view before_token = "/#t=";
  const std::size_t fragment = url.find(before_token);
  const std::size_t colon = url.rfind(':', fragment);
  std::from_chars(url.data() + colon + 1, url.data() + fragment, view.port);
  view.token = url.substr(fragment + before_token.size());
  view.port_tries = 1;
}

std::string text_of(const sim::ConfigError& error) {
  std::string text;
  for (const std::string& line : error.lines()) text += (text.empty() ? "" : "\n") + line;
  return text;
}

/// Shows a text on the page until a file was saved or a signal has come.
void wait_for_files(experiment::WatchedFiles& files, experiment::ViewOptions& view, const std::string& world_file,
                    const std::string& problem) {
  viewer::WaitingPage page(view, experiment::short_version(), world_file, problem);
  view.opened(page.url());
  std::cerr << "live page: " << page.url() << "\n";
  constexpr std::chrono::milliseconds tick{50};
  while (experiment::caught_signal() == 0 && !files.changed()) {
    page.serve();
    std::this_thread::sleep_for(tick);
  }
}

int run_watched(const std::string& world_file, experiment::RunOptions& options, experiment::ViewOptions& view,
                const std::function<sim::LoadedWorld()>& load, const std::function<int(const sim::LoadedWorld&)>& go) {
  bool shown = false;  // the page stays open over all runs
  view.opened = [&view, &shown, show = view.opened](const std::string& url) {
    keep_address(url, view);
    if (!std::exchange(shown, true) && show) show(url);
  };
  int exit_code = exit_ok;
  std::set<std::string> names{world_file};
  while (experiment::caught_signal() == 0) {
    experiment::WatchedFiles files(names);
    options.leave = [&files] { return files.changed(); };
    // Run the world, if it has no errors.
    std::string problem;
    try {
      const sim::LoadedWorld loaded = load();
      names = experiment::files_of(loaded.resolved);
      names.insert(world_file);
      files.add(names);
      exit_code = go(loaded);
      problem = "the run has ended; save " + world_file + " to run it again";
    } catch (const sim::ConfigError& error) {
      problem = text_of(error);
      std::cerr << problem << '\n';
      exit_code = exit_usage;
    }
    if (experiment::caught_signal() == 0 && !files.changed()) wait_for_files(files, view, world_file, problem);
  }
  return exit_code;
}

constexpr LivePage of_this_library{viewer::run_page, run_watched};
[[maybe_unused]] const bool is_set = (live_page = &of_this_library) != nullptr;

}  // namespace

}  // namespace tools
