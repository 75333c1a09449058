// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace tools {

/// A degree in rad.
inline constexpr double degree_rad = std::numbers::pi / 180;

/// How columns of a reference become a command of a device.
struct FidelityInput {
  std::string device;
  std::string message = "shoal.actuator_command_t";
  std::string column;      ///< becomes `value`
  sim::ConfigNode fields;  ///< of any other message: a text that is the name of a column becomes its number
  double scale = 1;        ///< times every column
  sim::SourcePlace place;
  void read(sim::ParamReader& in);
};

/// What a case may differ by from its reference.  Unset: any.
struct FidelityBars {
  std::optional<double> position_rms_m, position_max_m, velocity_rms_mps, heading_rms_deg;
  void read(sim::ParamReader& in);
};

/// A published trajectory, and how to run the same here.
struct FidelityCase {
  std::string name;
  std::string text;           ///< a sentence for the report
  std::string group, title;   ///< the vehicle it belongs to
  std::string vehicle;        ///< path of the vehicle file
  std::string reference;      ///< path of the CSV
  sim::ConfigNode world;      ///< dotted path: value, of the world around the vehicle
  sim::ConfigNode overrides;  ///< dotted path: value, of the vehicle
  double step_s = 0.005;
  std::vector<FidelityInput> inputs;
  FidelityBars bars;
  double trim_heave_m = 0, trim_pitch_rad = 0;  ///< the reference's level is not ours
  sim::SourcePlace place, vehicle_place;        ///< in the file of cases
};

struct FidelityFile {
  std::string text;  ///< Markdown for the top of the report
  std::vector<FidelityCase> cases;
};

/// Throws ConfigError.
FidelityFile read_fidelity_file(const std::string& path);

/// Names of the state in a reference: place (m) in north-east-down, roll, pitch and yaw (rad), velocity over ground
/// (m/s) and turn rates (rad/s) in forward-right-down.
inline constexpr std::array<const char*, 12> fidelity_states = {"x", "y", "z", "phi", "theta", "psi",
                                                                "u", "v", "w", "p",   "q",     "r"};
using FidelityState = std::array<double, 12>;

/// A table of numbers with named columns, the first of them `t` in seconds, rising.
struct FidelityReference {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
  /// Index of a column.  Throws ConfigError that names the file when there is none.
  std::size_t column(const std::string& name) const;
  std::string file;
};

/// Reads a CSV of two rows or more with numbers up to 1e9; a unit in brackets after a name is passed over.  Throws
/// ConfigError with file and line.
FidelityReference read_fidelity_reference(const std::string& path);

struct FidelityOptions {
  std::optional<double> step_s;                  ///< instead of that of the case
  std::map<std::string, std::string> overrides;  ///< of the vehicle, over those of the case: dotted path, YAML text
};

/// A case as it went: the reference, our states at the times of its rows, and how far they are apart.
struct FidelityResult {
  FidelityCase of;
  double step_s = 0;
  std::vector<double> t;
  std::vector<FidelityState> theirs, ours;
  double position_rms_m = 0, position_max_m = 0;
  double velocity_rms_mps = 0;  ///< of the velocity vector
  double turn_rms_degps = 0;    ///< of the turn rate vector
  double heading_rms_deg = 0;
  double path_m = 0;                ///< length of the reference's track
  std::vector<std::string> missed;  ///< bars, as `position_rms_m 0.3 > 0.1`
};

/// The world of a case.  Its values localise themselves in the file of cases, those of `options` the option.
sim::ConfigNode fidelity_world(const FidelityCase& of, const FidelityReference& reference,
                               const FidelityOptions& options = {});

/// Runs the vehicle of a case in its own world, its devices commanded over the in-process bus with what the
/// reference's inputs were; row k holds from its time to that of row k + 1.  Throws ConfigError, which names the case,
/// and PhysicsFault.
FidelityResult run_fidelity_case(const FidelityCase& of, const FidelityOptions& options = {});

}  // namespace tools
