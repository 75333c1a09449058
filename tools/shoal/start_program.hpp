// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tools {

/// Files to write: path below the user's folder, and text.
using StartFiles = std::vector<std::pair<std::string, std::string>>;

/// A program in C++ that drives `vehicle` in lockstep: NAME/NAME.cpp and NAME/CMakeLists.txt, from examples/client.
/// Throws std::runtime_error when the program finds no shipped files.
StartFiles start_cpp_program(const std::string& name, const std::string& vehicle);
/// The same in Python: NAME.py, from examples/python, which knows where the Python message types are.  Throws
/// std::runtime_error when these are missing.
StartFiles start_python_program(const std::string& name, const std::string& vehicle);

/// The text with `word` replaced by `with` everywhere.
std::string replaced(std::string text, const std::string& word, const std::string& with);

}  // namespace tools
