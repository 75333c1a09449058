// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <string>

namespace command_line {

/// Shell commands that print the words for the value of an argument, one per line, by the name that the help shows for
/// it: {"WORLD", "shoal list worlds"}.
using WordCommands = std::map<std::string, std::string>;

/// Returns the completion of a command line for bash: a function and the `complete` that registers it.  Completes
/// commands, options, the words of an option that takes one of some, and files, folders or the words of
/// `word_commands` by the names of values.
std::string bash_completion(const CLI::App& app, const WordCommands& word_commands);

/// The same for zsh, as a file for a folder of $fpath; it also shows what commands and options mean.
std::string zsh_completion(const CLI::App& app, const WordCommands& word_commands);

}  // namespace command_line
