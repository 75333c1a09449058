// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/commands/commands.hpp"

#include <utility>
#include <vector>

#include "tools/shoal/commands/command_library.hpp"

namespace tools {

namespace {

/// Groups of the help.
constexpr const char *run = "run worlds", *look = "look at runs", *measure = "measure", *make = "make files",
                     *connect = "work with a running simulator";

struct Command {
  const char* group;
  const char* name;
  const char* library;  ///< empty: the command is part of the program
  const char* description;
};

/// Commands in the order of the help.  CMakeLists.txt lists the sources of each library.
constexpr Command commands[] = {
    {run, "run", "", "Run a world"},
    {run, "replay", "records", "Replay the world of a log, and compare"},
    {run, "check", "files", "Check a world, vehicle, study or motion file without running it"},
    {look, "view", "view", "Serve a live page of a log, or of a run in another process, in 3-D"},
    {look, "snap", "film", "Render an image of a world or a recorded run at a given time"},
    {look, "film", "film", "Make a film of a recorded run, or of a world without programs"},
    {look, "map", "film", "Write the true map of a world or log, or one that a program published, for ROS map_server"},
    {look, "log", "records", "Inspect and convert LCM event logs"},
    {look, "snapshot", "records", "Show the contents of a snapshot file"},
    {look, "medium", "models", "Show the water and the air of a world at a place and a time"},
    {look, "acoustics", "models", "Show the propagation of sound between two positions under water"},
    {measure, "study", "study", "Run a world with many seeds and settings, and compare"},
    {measure, "tune", "study", "Search for the settings of a study that make a figure best"},
    {measure, "score", "records", "Score a log again, or an estimate that was made elsewhere"},
    {measure, "report", "view", "Make one HTML page of the results of a run or a study"},
    {measure, "bench", "models", "Measure the speed of this machine on standard scenes"},
    {measure, "fidelity", "models", "Compare vehicles with published trajectories"},
    {make, "new", "files", "Write a world, a vehicle or a program to start with"},
    {make, "list", "", "List shipped worlds and vehicles, device types or message types"},
    {make, "describe", "files", "Describe a device, a message, a program or the keys of a file"},
    {make, "motion", "motion", "Record, show, check, edit, play and convert motions of robots with joints"},
    {make, "import", "models", "Convert robots and data sets of other programs"},
    {make, "mesh", "models", "Describe a mesh file, and convert it for worlds and vehicles"},
    {connect, "control", "", "Send a request to a running simulator and print its answer"},
    {connect, "drive", "drive", "Drive a vehicle of a running simulator by hand"},
    {connect, "spy", "", "Watch the live channels: rates and decoded fields"},
    {connect, "doctor", "", "Check whether LCM works on this machine, and print how to fix it"},
    {connect, "bug", "records", "Pack a run into one archive for a report to the developers"},
};

/// Commands that people know from other programs, and what does the same.
constexpr std::pair<const char*, const char*> calls_elsewhere[] = {
    {"play", "`shoal view LOG`, or `shoal replay --play LOG` for programs on a bus"},
    {"playback", "`shoal view LOG`, or `shoal replay --play LOG` for programs on a bus"},
    {"plot", "`shoal report DIR`, or `shoal.plots` in Python"},
    {"record", "`shoal run WORLD --record LOG`, or `shoal motion record` for a motion"},
    {"bag", "`shoal run WORLD --record LOG`, and `shoal log`"},
    {"version", "`shoal --version`"},
    {"start", "`shoal run WORLD`"},
    {"launch", "`shoal run WORLD --launch`"},
    {"sim", "`shoal run WORLD`"},
    {"topic", "`shoal spy`"},
    {"echo", "`shoal spy CHANNEL`"},
    {"msg", "`shoal describe TYPE`"},
    {"validate", "`shoal check FILE`"},
    {"lint", "`shoal check FILE`"},
    {"init", "`shoal new world NAME`"},
    {"create", "`shoal new world NAME`"},
    {"convert", "`shoal import`, `shoal log` or `shoal mesh`"},
    {"video", "`shoal film LOG`"},
    {"screenshot", "`shoal snap WORLD`"},
    {"benchmark", "`shoal study benchmark`, or `shoal bench` for the speed of this machine"},
};

/// Those that were registered since the last add_registered().
std::vector<AddCommand>& registered() {
  static std::vector<AddCommand> all;
  return all;
}

void add_registered(CLI::App& app, int& exit_code) {
  for (const AddCommand add : std::exchange(registered(), {})) add(app, exit_code);
}

}  // namespace

bool register_command(AddCommand add) {
  registered().push_back(add);
  return true;
}

std::string meant_call(const std::string& name) {
  for (const auto& [known, call] : calls_elsewhere)
    if (name == known) return call;
  return {};
}

void list_commands(CLI::App& app) {
  for (const Command& command : commands) app.add_subcommand(command.name, command.description)->group(command.group);
}

void complete_command(CLI::App& app, int& exit_code, const std::string& name) {
  for (const Command& command : commands)
    if (command.name == name && *command.library != '\0') load_library(command.library);
  add_registered(app, exit_code);
}

void complete_commands(CLI::App& app, int& exit_code) {
  for (const Command& command : commands) complete_command(app, exit_code, command.name);
}

}  // namespace tools
