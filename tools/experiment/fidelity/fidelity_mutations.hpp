// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "tools/experiment/fidelity/fidelity.hpp"

namespace tools {

/// A number in the `hydrodynamics:` or in an actuator of a vehicle file.
struct FidelityCoefficient {
  std::string name;                 ///< `bodies.hull.hydrodynamics.added_mass[1]`
  std::string path;                 ///< of the scalar or of its whole list, as in `overrides:`
  double value = 0;                 ///< never 0
  std::vector<std::string> items;   ///< numbers of the list as in the file; one for a scalar
  std::vector<std::size_t> places;  ///< of the number in `items`; two for a pair of a symmetric matrix
  bool list = false;
  /// Returns YAML text of the value at `path` with this number times `factor`.
  std::string text_with(double factor) const;
};

/// Returns the coefficients of the vehicle of a case, without the changes by the case: all numbers except 0 in
/// `hydrodynamics:` of bodies with coefficients, and in thrusters, fins, buoyancy engines, moving masses and body
/// wrenches.  Keys that the file leaves to their defaults are not in it.  Throws ConfigError.
std::vector<FidelityCoefficient> fidelity_coefficients(const FidelityCase& of);

/// Outcome of a changed coefficient: which case misses a bar with it.
struct FidelityVerdict {
  std::string seen_by;  ///< name of the case; empty: none
  std::string missed;   ///< its first missed bar
  std::string refused;  ///< why the world refuses this value; empty: it does not
};

struct FidelityMutation {
  FidelityCoefficient of;
  std::string title;                        ///< of the group of the vehicle
  std::array<FidelityVerdict, 2> verdicts;  ///< for the value decreased, and increased
  /// True when a change to at least one side is seen by no case.
  bool unseen() const;
};

/// Runs a case with a changed coefficient until it misses a bar.
FidelityVerdict try_fidelity_mutation(const FidelityCase& of, const FidelityCoefficient& coefficient, double factor);

/// Returns true when the case itself changes this coefficient, so that it cannot see it.
bool overrides_coefficient(const FidelityCase& of, const FidelityCoefficient& coefficient);

/// Changes every coefficient of every vehicle of the cases by `share` of its value, to both sides, one at a time, and
/// finds a case of this vehicle that misses a bar.  `progress` is called with a line after each vehicle.
std::vector<FidelityMutation> mutate_fidelity(const std::vector<FidelityCase>& cases, double share,
                                              const std::function<void(const std::string&)>& progress);

/// Returns a page in Markdown: what no case sees, and the table of every vehicle.  `cases`: the file of cases, as in
/// the command.
std::string fidelity_mutations_page(const std::vector<FidelityMutation>& mutations, double share,
                                    const std::string& cases);

}  // namespace tools
