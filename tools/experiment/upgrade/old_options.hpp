// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tools {

/// Conversion of the value of a command-line option to YAML.
enum class OptionForm {
  same,       ///< the text as it is
  word,       ///< the same with `_` for `-`
  flag,       ///< an option without a value
  numbers,    ///< "x,y,z"
  points,     ///< "x,y;x,y"
  pose,       ///< "x,y,yaw", two keys
  slot,       ///< "I/N", two keys
  orders,     ///< "T:X,Y,D;T:X,Y,D,S"
  speeds,     ///< "T:V;T:V:W"
  behaviour,  ///< "circle:X,Y,R", "zigzag:X,Y,X,Y,A,L", "follow:VEHICLE,A,L" or "route"
};

/// Option of a program that came with version 0.1, and the equivalent keys of `args:` since 0.2.
struct OldOption {
  const char* program;  ///< `*`: each of them
  const char* option;
  const char* keys;  ///< with spaces between
  OptionForm form;
};

/// Returns whether a program came with version 0.1.
bool is_old_program(std::string_view program);
/// Returns null when the program had no such option.
const OldOption* find_old_option(std::string_view program, std::string_view option);

/// Key and value that replace an option, for a map in braces.
struct Argument {
  std::string key;
  std::string value;
};
/// Returns the arguments that replace an option; nothing when the value does not have the option's form.
std::optional<std::vector<Argument>> arguments_of(const OldOption& option, const std::string& value);

}  // namespace tools
