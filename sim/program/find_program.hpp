// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/config/file_access.hpp"
#include "sim/program/program_declaration.hpp"

namespace sim {

/// How a declaration is called: NAME.args.yaml beside the program NAME.
inline constexpr const char* declaration_ending = ".args.yaml";

/// Where a `program:` without a slash is looked up: the folder of the running program, then the absolute ones of PATH.
std::vector<std::string> program_folders();

/// The programs of a folder that have a declaration, sorted.
std::vector<std::string> declared_programs(const std::string& folder);

/// A program with its declaration, which lies beside it.
struct FoundProgram {
  std::string path;
  std::shared_ptr<const ProgramDeclaration> declaration;  ///< null: there is none, or it is broken
  bool exists = false;                                    ///< there is a file with the declaration
};

/// Reads the declaration of the program that `program` names, in the first of `folders` that has one; a name with a
/// slash is a path, of which `files` must allow the declaration.  A declaration that is broken is an error, with its
/// own place unless a world names the path of it.  Never starts the program.
FoundProgram find_program(const std::string& program, const std::vector<std::string>& folders, const FileAccess* files,
                          const SourcePlace& place, const std::string& who, Diagnostics& diagnostics);

/// Reads a file NAME.args.yaml; errors, also those of files that are too large or not regular, go to `diagnostics`.
ProgramDeclaration read_declaration_file(const std::string& path, Diagnostics& diagnostics);

}  // namespace sim
