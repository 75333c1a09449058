// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/world_programs.hpp"

#include <algorithm>

#include "sim/config/message_text.hpp"
#include "sim/program/find_program.hpp"
#include "sim/program/program_args.hpp"

namespace experiment {

namespace {

/// Returns the search folders: that of the running program, then those that the command line allows, then PATH.
std::vector<std::string> folders_of(const ProgramLookup& lookup) {
  std::vector<std::string> folders = lookup.folders.empty() ? sim::program_folders() : lookup.folders;
  folders.insert(folders.empty() ? folders.end() : folders.begin() + 1, lookup.allow_paths.begin(),
                 lookup.allow_paths.end());
  return folders;
}

std::string no_declaration(const std::string& program, const std::vector<std::string>& folders) {
  const std::string name = sim::shortened(sim::printable(program));
  std::string text = "no declaration '" + name + sim::declaration_ending + "'";
  if (program.find('/') == std::string::npos) {
    std::vector<std::string> looked;  // PATH may name a folder twice
    for (const std::string& folder : folders)
      if (std::find(looked.begin(), looked.end(), folder) == looked.end()) looked.push_back(folder);
    text += " in " + sim::list_text(looked, 4);
    const std::string meant =
        folders.empty() ? "" : sim::closest_name(program, sim::declared_programs(folders.front()));
    if (!meant.empty()) return text + "; did you mean '" + meant + "'?";
  }
  return text + "; 'command: [" + name + ", ...]' takes a program without one";
}

}  // namespace

WrittenProcess written_process(const sim::LoadedWorld& loaded, std::size_t index) {
  static const sim::ConfigNode nothing;
  WrittenProcess written;
  const sim::ConfigNode* list = loaded.resolved.find("processes");
  const std::size_t processes = list != nullptr ? list->items.size() : 0;
  if (index >= processes) {
    written.is_bridge = true;
    index -= processes;
    list = loaded.resolved.find("bridges");
  }
  if (list == nullptr || index >= list->items.size()) return written;
  const sim::ConfigNode& item = list->items[index];
  // The resolved tree has the places in files, which the configuration does not keep.
  written.place = item.place;
  if (const sim::ConfigNode* program = item.find("program")) {
    written.program = program->scalar;
    written.place = program->place;
    const sim::ConfigNode* args = item.find("args");
    written.args = args != nullptr ? args : &nothing;
  } else if (const sim::ConfigNode* command = item.find("command")) {
    written.place = command->items.empty() ? command->place : command->items.front().place;
  }
  return written;
}

std::vector<std::string> free_bridges(const sim::LoadedWorld& loaded) {
  std::vector<std::string> names;
  const std::vector<sim::ProcessConfig>& all = loaded.config.processes;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].client.empty() && written_process(loaded, i).is_bridge) names.push_back(all[i].name);
  return names;
}

void read_programs(sim::LoadedWorld& loaded, const ProgramLookup& lookup) {
  const std::vector<std::string> folders = folders_of(lookup);
  sim::Diagnostics diagnostics;
  for (std::size_t i = 0; i < loaded.config.processes.size(); ++i) {
    sim::ProcessConfig& process = loaded.config.processes[i];
    const WrittenProcess written = written_process(loaded, i);
    if (written.program.empty()) continue;
    const std::string who = (written.is_bridge ? "bridge '" : "process '") + process.name + "': program '" +
                            sim::shortened(sim::printable(written.program)) + "'";
    const sim::FoundProgram found =
        sim::find_program(written.program, folders, loaded.config.files.get(), written.place, who, diagnostics);
    if (!found.exists && lookup.all_needed)
      diagnostics.error(written.place, who, no_declaration(written.program, folders));
    if (found.declaration == nullptr) continue;
    const sim::SourcePlace& place = written.args->place.file != nullptr ? written.args->place : written.place;
    process.command = sim::command_line_of(*found.declaration, *written.args, place, who, diagnostics);
    process.command.insert(process.command.begin(), found.path);
  }
  diagnostics.throw_if_any();
}

}  // namespace experiment
