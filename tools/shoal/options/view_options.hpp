// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>

#include "experiment/run/run_page.hpp"

namespace tools {

/// Adds the options of the live page, except the one that opens it.
void add_page_options(CLI::App& command, experiment::ViewOptions& view);
/// Adds `--open`: whether the address of the page is shown in the browser.
CLI::Option* add_open_option(CLI::App& command, bool& open);

}  // namespace tools
