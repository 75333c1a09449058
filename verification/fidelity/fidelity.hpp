// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace verification {

/// One degree in rad.
inline constexpr double degree_rad = std::numbers::pi / 180;

/// Mapping of columns of a reference to commands of a device.
struct FidelityInput {
  std::string device;
  std::string message = "shoal.actuator_command_t";
  std::string column;      ///< column for the field `value`
  sim::ConfigNode fields;  ///< fields of any other message: a text that is the name of a column is replaced by its
                           ///< number
  double scale = 1;        ///< factor of every column
  sim::SourcePlace place;
  void read(sim::ParamReader& in);
};

/// Largest permitted differences between a case and its reference.  Unset: no limit.
struct FidelityBars {
  std::optional<double> position_rms_m, position_max_m, velocity_rms_mps, turn_rms_degps, heading_rms_deg;
  void read(sim::ParamReader& in);
};

/// Published trajectory, and the setup that reproduces it.
struct FidelityCase {
  std::string name;
  std::string text;           ///< a sentence for the report
  std::string group, title;   ///< group: the vehicle that the case belongs to
  std::string vehicle;        ///< path of the vehicle file
  std::string reference;      ///< path of the CSV
  sim::ConfigNode world;      ///< changes of the world around the vehicle, dotted path: value
  sim::ConfigNode overrides;  ///< changes of the vehicle, dotted path: value
  double step_s = 0.005;
  std::vector<FidelityInput> inputs;
  FidelityBars bars;
  double trim_heave_m = 0, trim_pitch_rad = 0;  ///< trim of the reference that differs from ours
  sim::SourcePlace place, vehicle_place;        ///< in the file of cases
};

/// Coefficient of a vehicle that changes no motion, and why.
struct FidelityWithoutEffect {
  std::string coefficient;  ///< `devices.port.position_m[0]`
  std::string why;
  void read(sim::ParamReader& in);
};

struct FidelityFile {
  std::string text;  ///< Markdown for the top of the report
  std::vector<FidelityWithoutEffect> without_effect;
  std::vector<FidelityCase> cases;
};

/// Reads a file of cases.  Throws ConfigError.
FidelityFile read_fidelity_file(const std::string& path);

/// Names of the state in a reference: position (m) in north-east-down, roll, pitch and yaw (rad), velocity over ground
/// (m/s) and angular rates (rad/s) in forward-right-down (SNAME notation, Fossen 2021).
inline constexpr std::array<const char*, 12> fidelity_states = {"x", "y", "z", "phi", "theta", "psi",
                                                                "u", "v", "w", "p",   "q",     "r"};
using FidelityState = std::array<double, 12>;

/// Table of numbers with named columns, the first of them `t` in seconds, increasing.
struct FidelityReference {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
  /// Returns the index of a column.  Throws ConfigError with the name of the file when it does not exist.
  std::size_t column(const std::string& name) const;
  std::string file;
};

/// Reads a CSV file of at least two rows with numbers up to 1e9; a unit in brackets after a name is ignored.  Throws
/// ConfigError with file and line.
FidelityReference read_fidelity_reference(const std::string& path);

struct FidelityOptions {
  std::optional<double> step_s;                  ///< compare at this step; unset: at step zero, extrapolated from the
                                                 ///< step of the case and half of it
  std::map<std::string, std::string> overrides;  ///< changes of the vehicle, applied after those of the case: dotted
                                                 ///< path, YAML text
  bool until_missed = false;                     ///< stop at the first row at which a bar is missed for sure
};

/// Result of a case: the reference, our states at the times of its rows, and the differences.
struct FidelityResult {
  FidelityCase of;
  double step_s = 0;  ///< 0: extrapolated
  std::vector<double> t;
  std::vector<FidelityState> theirs, ours;
  double position_rms_m = 0, position_max_m = 0;
  double velocity_rms_mps = 0;  ///< of the velocity vector
  double turn_rms_degps = 0;    ///< of the angular rate vector
  double heading_rms_deg = 0;
  double path_m = 0;                ///< length of the reference's track
  std::vector<std::string> missed;  ///< limits that were exceeded, as `position_rms_m 0.3 > 0.1`
};

/// Returns the world of a case.  The source place of its values is the file of cases, that of `options` the option.
sim::ConfigNode fidelity_world(const FidelityCase& of, const FidelityReference& reference,
                               const FidelityOptions& options = {});

/// Runs the vehicle of a case in its own world.  Its devices receive the inputs of the reference over the in-process
/// bus; row k applies from its time to that of row k + 1.  Throws ConfigError, which names the case, and PhysicsFault.
FidelityResult run_fidelity_case(const FidelityCase& of, const FidelityOptions& options = {});

/// Returns the table of differences, aligned for a terminal and valid as Markdown.
std::string fidelity_table(const std::vector<FidelityResult>& results);

/// Returns the result of a case on one line: `2 of 24: otter_turn: position rms 0.0312 m`, and the number of exceeded
/// limits.
std::string fidelity_line(const FidelityResult& result, std::size_t number, std::size_t count);

/// Writes FOLDER/fidelity.md, FOLDER/fidelity/end_states.csv, and for each case FOLDER/fidelity/NAME.png (reference and
/// simulation overlaid) and, with `csv`, NAME.csv (our states).  `text`: Markdown for the top.  Throws
/// std::runtime_error.
void write_fidelity_report(const std::string& folder, const std::string& text,
                           const std::vector<FidelityResult>& results, bool csv);

/// Writes FOLDER/fidelity_coefficients.md and FOLDER/fidelity/coefficients.csv.  Throws std::runtime_error.
void write_fidelity_mutations(const std::string& folder, const std::string& page, const std::string& table);

}  // namespace verification
