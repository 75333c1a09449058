// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/program/program_declaration.hpp"

namespace command_line {

/// Arguments of a program, each declared once.  A declaration defines the option on the command line with its help, and
/// the output of `--describe`: the file NAME.args.yaml, by which `shoal check` checks `args:` in a world. An argument
/// `speed_mps` is the option --speed-mps.
class DeclaredOptions {
 public:
  /// Refines the declaration of an argument.
  class Added {
   public:
    Added(DeclaredOptions& options, std::size_t index, CLI::Option* option)
        : options_(options), index_(index), option_(option) {}
    /// Makes the argument mandatory.
    Added& required();
    /// Makes the argument mandatory in worlds; on the command line the program itself checks for it where it needs it.
    Added& required_in_worlds();
    /// Declares the default of a tuple.
    Added& by_default(const std::vector<double>& numbers);
    /// Declares arguments that must be given together with this one.
    Added& needs(std::vector<std::string> keys);

   private:
    DeclaredOptions& options_;
    std::size_t index_;
    CLI::Option* option_;
  };
  using TakeList = std::function<void(const std::vector<double>&)>;
  using TakeLists = std::function<void(const std::vector<std::vector<double>>&)>;

  /// Takes the name and the description of the program from `app`, which must outlive this.
  explicit DeclaredOptions(CLI::App& app);
  DeclaredOptions(const DeclaredOptions&) = delete;
  DeclaredOptions& operator=(const DeclaredOptions&) = delete;

  // The present value is the default, unless the argument is required.
  Added number(const std::string& key, double& value, double low, double high, const std::string& meaning);
  Added number(const std::string& key, std::optional<double>& value, double low, double high,
               const std::string& meaning);
  Added integer(const std::string& key, int& value, int low, int high, const std::string& meaning);
  Added integer(const std::string& key, std::optional<int>& value, int low, int high, const std::string& meaning);
  Added seed(const std::string& key, std::uint64_t& value, const std::string& meaning);
  /// Declares a text argument; `shown` is the placeholder of its value in the help.
  Added text(const std::string& key, const char* shown, std::string& value, const std::string& meaning);
  Added flag(const std::string& key, bool& value, const std::string& meaning);
  Added choice(const std::string& key, std::string& value, const std::vector<std::string>& words,
               const std::string& meaning);
  Added choice(const std::string& key, int& value, const std::vector<std::string>& words, const std::string& meaning);
  /// Declares a tuple of numbers, one per column, each inside `range`.
  Added tuple(const std::string& key, const std::vector<std::string>& columns, const sim::Rule& range, TakeList take,
              const std::string& meaning);
  /// Declares a list of tuples; the columns after the first `min_columns` are optional.
  Added tuples(const std::string& key, const std::vector<std::string>& columns, std::size_t min_columns,
               const sim::Rule& range, TakeLists take, const std::string& meaning);

  /// Declares channels, in which {name} is replaced by the argument `name`.
  void publishes(std::vector<std::string> channels) { declaration_.publishes = std::move(channels); }
  void subscribes(std::vector<std::string> channels) { declaration_.subscribes = std::move(channels); }
  void exactly_one(std::vector<std::string> keys) { declaration_.exactly_one.push_back(std::move(keys)); }
  void at_most_one(std::vector<std::string> keys) { declaration_.at_most_one.push_back(std::move(keys)); }

  CLI::App& app() { return app_; }
  const sim::ProgramDeclaration& declaration() const { return declaration_; }
  /// Parses the command line after all declarations.  Returns std::nullopt if the program is to continue; otherwise the
  /// exit code, also after `--describe`.
  std::optional<int> parse(int argc, const char* const* argv);

 private:
  template <class Value>
  CLI::Option* bind(const std::string& key, Value& value, const std::string& meaning);
  CLI::Option* bind_list(const sim::ArgDeclaration& arg, const std::string& form, TakeLists take);
  Added add(sim::ArgDeclaration arg, CLI::Option* option);
  CLI::Option* option_of(const std::string& key) const;
  void connect_options();
  void check_groups() const;

  CLI::App& app_;
  sim::ProgramDeclaration declaration_;
  bool describe_ = false;
};

/// Adds an option of names, comma separated; it may be repeated.  An empty name is an error: CLI11 would drop it, and
/// take an option with empty names only for one that was not given.
CLI::Option* add_name_list(CLI::App& command, const std::string& option, std::vector<std::string>& names,
                           const std::string& meaning);

/// Adds `--plugin FILE`; the plugin is loaded before the command runs.
void add_plugin_option(CLI::App& command);

/// Loads the plugin that `--plugin` names.  Throws sim::ConfigError.
void load_plugin(const std::string& file);

}  // namespace command_line
