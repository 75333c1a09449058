// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <map>

#include "sim/config/message_text.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/help.hpp"
#include "tools/command_line/parse.hpp"

namespace command_line {

namespace {

bool is_flag(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

bool is_repeatable(const CLI::Option& option) {
  return option.get_items_expected_max() > 1;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* each : commands_of(app)) names.push_back(each->get_name());
  return names;
}

/// Returns whether a word that starts with `-` is a value: standard input, or a negative number such as `-4,2,1`.
bool looks_like_value(const std::string& text) {
  if (!text.starts_with('-') || text == "-") return true;
  return std::string("0123456789.").find(text[1]) != std::string::npos || text.starts_with("-inf") ||
         text.starts_with("-nan");
}

class Reader {
 public:
  Reader(CLI::App& app, const std::vector<std::string>& words) : words_(words) { result_.command = &app; }

  Arguments read() {
    try {
      while (at_ < words_.size()) read_word(words_[at_++]);
      if (!result_.help) check_complete();
    } catch (const UsageError& error) {
      result_.wrong = error.what();
      result_.help = result_.help || requests_help();
    }
    arrange();
    return std::move(result_);
  }

 private:
  CLI::App& command() { return *result_.command; }

  void read_word(const std::string& word) {
    if (only_places_ || word.empty() || word == "-" || !word.starts_with('-'))
      read_place(word);
    else if (word == "--")
      only_places_ = true;
    else
      read_option(word);
  }

  /// Reads a command, or an argument by its position.
  void read_place(const std::string& word) {
    const std::vector<std::string> commands = command_names(command());
    const bool is_command = std::find(commands.begin(), commands.end(), word) != commands.end();
    if (commands.empty() || (takes_places() && (!is_command || !places_.empty()))) {
      take_place(word);
    } else if (is_command) {
      result_.command = command().get_subcommand(word);
      path_.push_back(word);
    } else if (word == "help" && !only_places_) {
      result_.help = true;
    } else {
      throw UsageError(unknown_command(word, commands));
    }
  }

  std::vector<CLI::Option*> places_of_command() {
    return command().get_options([](const CLI::Option* option) { return option->get_positional(); });
  }
  /// A command may have both: `shoal study FILE`, `shoal study run DIR`.
  bool takes_places() { return !places_of_command().empty(); }

  std::string unknown_command(const std::string& word, const std::vector<std::string>& names) {
    const std::string text = "unknown command " + quoted(word);
    // A typing error, a beginning of a name, or a world without `run`: in the order of their likelihood.
    if (const std::string meant = sim::closest_name(word, names); !meant.empty())
      return text + "; did you mean '" + meant + "'?";
    const auto begins = std::find_if(names.begin(), names.end(),
                                     [&](const std::string& name) { return !word.empty() && name.starts_with(word); });
    if (begins != names.end()) return text + "; did you mean '" + *begins + "'?";
    const bool world = word.ends_with(".yaml") || word.ends_with(".yml");
    if (world && std::find(names.begin(), names.end(), "run") != names.end())
      return text + "; did you mean '" + command_path(command()) + " run " + word + "'?";
    return text + "; known commands: " + sim::list_text(names);
  }

  void take_place(const std::string& word) {
    const std::vector<CLI::Option*> places = places_of_command();
    for (CLI::Option* place : places) {
      if (counts_[place] > 0 && !is_repeatable(*place)) continue;
      if (word.empty()) throw UsageError(place->get_name(true) + " must not be empty");
      ++counts_[place];
      places_.push_back(word);
      return;
    }
    throw UsageError("unexpected argument " + quoted(word) +
                     (places.empty() ? "; it takes options only" : "; it follows " + places.back()->get_name(true)));
  }

  void read_option(const std::string& word) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    CLI::Option* option = find_option(name);
    if (option == nullptr) throw UsageError(unknown_option(name));
    const std::string shown = option_name(*option);
    // Help and flags take no value.
    if (option == command().get_help_ptr()) {
      result_.help = true;
      return;
    }
    if (is_flag(*option)) {
      if (equals != std::string::npos)
        throw UsageError(shown + " takes no value, got " + quoted(word.substr(equals + 1)));
      if (counts_[option]++ == 0) options_.push_back(shown);
      return;
    }
    // Value after `=`, or in the next argument.
    std::string value;
    if (equals != std::string::npos)
      value = word.substr(equals + 1);
    else if (at_ < words_.size() && looks_like_value(words_[at_]))
      value = words_[at_++];
    else
      throw UsageError(
          shown + " needs a value: " + shown + " " + value_name(*option) +
          (at_ < words_.size() && words_[at_].starts_with("-") ? "; " + quoted(words_[at_]) + " follows it" : ""));
    // Checks of the value.
    if (counts_[option]++ > 0 && !is_repeatable(*option)) throw UsageError(shown + " is given twice");
    const std::string kind = value_name(*option);
    if (value.empty() && (kind == "FILE" || kind == "DIR")) throw UsageError(shown + " must not be empty");
    if (value.empty()) {  // CLI11 would take the next argument as the value of `--name=`
      options_.push_back(shown);
      options_.push_back("");
    } else {
      options_.push_back(shown + "=" + value);
    }
  }

  CLI::Option* find_option(const std::string& name) {
    for (CLI::Option* option : command().get_options(nullptr))
      if (name.starts_with("--") ? option->check_lname(name.substr(2)) : option->check_sname(name.substr(1)))
        return option;
    return nullptr;
  }

  std::string unknown_option(const std::string& name) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command().get_options(nullptr))
      for (const std::string& each : option->get_lnames()) names.push_back(each);
    const std::string bare =
        name.substr(name.find_first_not_of('-') == std::string::npos ? name.size() : name.find_first_not_of('-'));
    const bool right_but_for_dashes = std::find(names.begin(), names.end(), bare) != names.end();
    std::string meant = right_but_for_dashes ? bare : sim::closest_name(bare, names);
    if (meant.empty())
      for (const std::string& each : names)
        if (bare.size() > 2 && each.starts_with(bare)) meant = each;
    return "unknown option " + quoted(name) + (meant.empty() ? "" : "; did you mean '--" + meant + "'?");
  }

  void check_complete() {
    const std::vector<std::string> commands = command_names(command());
    const bool version = std::find(options_.begin(), options_.end(), "--version") != options_.end();
    if (!commands.empty() && !version && !takes_places())
      throw UsageError("needs a command: " + alternatives(commands));
    for (const CLI::Option* option : command().get_options(nullptr))
      if (option->get_required() && counts_[option] == 0) throw UsageError(option_name(*option) + " is required");
  }

  bool requests_help() const {
    return std::any_of(words_.begin() + static_cast<std::ptrdiff_t>(at_), words_.end(),
                       [](const std::string& word) { return word == "--help" || word == "-h"; });
  }

  /// Orders the result: options with their values in one word, then `--` where a positional argument could be misread.
  void arrange() {
    std::vector<std::string> all = path_;
    all.insert(all.end(), options_.begin(), options_.end());
    const auto odd = [](const std::string& place) { return place.starts_with('-') || place == "++"; };
    if (std::any_of(places_.begin(), places_.end(), odd)) all.push_back("--");
    all.insert(all.end(), places_.begin(), places_.end());
    result_.for_cli11.assign(all.rbegin(), all.rend());
  }

  const std::vector<std::string>& words_;
  std::size_t at_ = 0;
  bool only_places_ = false;
  std::map<const CLI::Option*, int> counts_;
  std::vector<std::string> path_, options_, places_;
  Arguments result_;
};

}  // namespace

Arguments read_arguments(CLI::App& app, const std::vector<std::string>& arguments) {
  return Reader(app, arguments).read();
}

std::string command_path(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent == nullptr ? command.get_name() : command_path(*parent) + " " + command.get_name();
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

}  // namespace command_line
