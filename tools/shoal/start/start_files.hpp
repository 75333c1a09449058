// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tools {

/// Returns a commented world of one vehicle.  `vehicle_file`: as in `file:`; `schema`: path of world.schema.json,
/// empty: none.
std::string start_world(const std::string& name, const std::string& vehicle_file, const std::string& schema);
/// Returns the same under water: an AUV with an autopilot.
std::string start_sea(const std::string& name, const std::string& vehicle_file, const std::string& schema);
/// Returns a commented rover with two driven wheels, or an AUV.  `schema`: path of vehicle.schema.json, empty: none.
std::string start_vehicle(const std::string& name, bool under_water, const std::string& schema);

/// Files to write: path below the user's folder, and text.
using StartFiles = std::vector<std::pair<std::string, std::string>>;

/// Returns a C++ program that drives `vehicle` in lockstep: NAME/NAME.cpp and NAME/CMakeLists.txt, from
/// examples/client. Throws std::runtime_error when the program finds no shipped files.
StartFiles start_cpp_program(const std::string& name, const std::string& vehicle);
/// Returns the same in Python: NAME.py, from examples/python, with the path of the Python message types.  Throws
/// std::runtime_error when these are missing.
StartFiles start_python_program(const std::string& name, const std::string& vehicle);

/// Returns the text with every `word` replaced by `with`.
std::string replaced(std::string text, const std::string& word, const std::string& with);

}  // namespace tools
