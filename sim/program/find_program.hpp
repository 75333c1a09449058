// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/config/file_access.hpp"
#include "sim/program/program_declaration.hpp"

namespace sim {

/// Suffix of a declaration file: NAME.args.yaml beside the program NAME.
inline constexpr const char* declaration_ending = ".args.yaml";

/// Returns the folders in which a `program:` without a slash is searched: the folder of the running program, then the
/// absolute folders of PATH.
std::vector<std::string> program_folders();

/// Returns the programs of a folder that have a declaration, sorted.
std::vector<std::string> declared_programs(const std::string& folder);

/// Program with the declaration beside it.
struct FoundProgram {
  std::string path;
  std::shared_ptr<const ProgramDeclaration> declaration;  ///< null: there is none, or it is invalid
  bool exists = false;                                    ///< whether the declaration file exists
};

/// Reads the declaration of a program from the first of `folders` that has one.  A name with a slash is a path, and
/// `files` must allow its declaration.  An invalid declaration is an error, reported at its own place unless a world
/// names its path.  Never starts the program.
FoundProgram find_program(const std::string& program, const std::vector<std::string>& folders, const FileAccess* files,
                          const SourcePlace& place, const std::string& who, Diagnostics& diagnostics);

/// Reads a file NAME.args.yaml.  Errors are reported to `diagnostics`, also for files that are too large or not
/// regular.
ProgramDeclaration read_declaration_file(const std::string& path, Diagnostics& diagnostics);

}  // namespace sim
