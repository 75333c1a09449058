// SPDX-License-Identifier: BSD-3-Clause
#include "sim/program/find_program.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"

namespace sim {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_bytes = 256 << 10;

bool is_file(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// Reads a declaration.  Errors of files found in the program folders are reported in full; a declaration that a world
/// names by its path may be any file, and only the number of its errors is reported.
FoundProgram read_found(const std::string& path, const std::string& file, bool quoted, const SourcePlace& place,
                        const std::string& who, Diagnostics& diagnostics) {
  Diagnostics own;
  auto declaration = std::make_shared<ProgramDeclaration>(read_declaration_file(file, own));
  if (own.ok()) return {path, std::move(declaration), true};
  if (quoted)
    for (const std::string& line : own.lines()) diagnostics.error({}, "", line);
  else
    diagnostics.error(place, who, "the declaration '" + file + "' has errors; `shoal check " + file + "` shows them");
  return {path, nullptr, true};
}

}  // namespace

std::vector<std::string> program_folders() {
  std::vector<std::string> folders;
  if (!program_folder().empty()) folders.push_back(program_folder());
  const char* path = std::getenv("PATH");
  std::istringstream all(path != nullptr ? path : "");
  for (std::string folder; std::getline(all, folder, ':');)
    if (folder.starts_with('/')) folders.push_back(folder);
  return folders;
}

std::vector<std::string> declared_programs(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (name.ends_with(declaration_ending) && name.size() > std::string_view(declaration_ending).size())
      names.push_back(name.substr(0, name.size() - std::string_view(declaration_ending).size()));
  }
  std::sort(names.begin(), names.end());
  return names;
}

FoundProgram find_program(const std::string& program, const std::vector<std::string>& folders, const FileAccess* files,
                          const SourcePlace& place, const std::string& who, Diagnostics& diagnostics) {
  // A name without a slash is searched in the folders of programs only, not in the working folder, which differs from
  // user to user.
  if (program.find('/') == std::string::npos) {
    for (const std::string& folder : folders) {
      const std::string path = (fs::path(folder) / program).string();
      if (is_file(path + declaration_ending))
        return read_found(path, path + declaration_ending, true, place, who, diagnostics);
    }
    return {};
  }
  const std::string file = program + declaration_ending;
  // A world file may come from elsewhere. The declaration is read, and errors quote it, so that it falls under the
  // rule for all files that a world names.
  if (files != nullptr && place.origin != Origin::command_line && !files->may_read(file)) {
    diagnostics.error(
        place, who,
        "the declaration of 'program' " + FileAccess::reading_rule() + ", got '" + shortened(printable(file)) + "'");
    return {program, nullptr, true};
  }
  if (!is_file(file)) return {};
  const bool quoted = files == nullptr || place.origin == Origin::command_line || files->may_quote(file);
  return read_found(program, file, quoted, place, who, diagnostics);
}

ProgramDeclaration read_declaration_file(const std::string& path, Diagnostics& diagnostics) {
  const SourcePlace whole{intern_file_name(path), 0, 0};
  std::error_code error;
  // Read the file, bounded.
  if (!fs::is_regular_file(path, error)) {
    diagnostics.error(whole, "", "must be a regular file");
    return {};
  }
  if (fs::file_size(path, error) > max_bytes || error) {
    diagnostics.error(whole, "", "a declaration must have at most 256 KiB");
    return {};
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    diagnostics.error(whole, "", "cannot read the file");
    return {};
  }
  std::string text(max_bytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));  // it may have grown since
  // Parse it, and compare its program with the name of the file.
  ProgramDeclaration declaration = read_declaration(text, path, diagnostics);
  const std::string name = fs::path(path).filename().string();
  const std::string program =
      name.substr(0, name.size() - std::min(name.size(), std::string_view(declaration_ending).size()));
  if (diagnostics.ok() && name == program + declaration_ending && declaration.program != program)
    diagnostics.error(whole, "",
                      "'program' must be '" + shortened(printable(program)) + "', the name of the file, got '" +
                          shortened(printable(declaration.program)) + "'");
  return declaration;
}

}  // namespace sim
