// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "verification/fidelity/fidelity.hpp"

namespace verification {

/// A number in the `hydrodynamics:` or in an actuator of a vehicle file.
struct FidelityCoefficient {
  std::string name;                 ///< `bodies.hull.hydrodynamics.added_mass[1]`
  std::string path;                 ///< of the scalar or of its whole list, as in `overrides:`
  double value = 0;                 ///< never 0
  std::vector<std::string> items;   ///< numbers of the list as in the file; one for a scalar
  std::vector<std::size_t> places;  ///< of the number in `items`; two for a pair of a symmetric matrix
  bool list = false;
  std::string mirrored_path;  ///< derivative that is the same element of the added mass, such as N_vdot of Y_rdot
  double mirrored_value = 0;
  /// Returns the changes of the vehicle that multiply this number by `factor`: dotted path, YAML text.
  std::map<std::string, std::string> changes(double factor) const;
};

/// Returns the coefficients of the vehicle of a case, without the changes by the case: all numbers except 0 in
/// `hydrodynamics:` of bodies with coefficients, and in thrusters, fins, buoyancy engines, moving masses and body
/// wrenches.  Keys that the file leaves to their defaults are not in it.  Throws ConfigError.
std::vector<FidelityCoefficient> fidelity_coefficients(const FidelityCase& of);

/// Outcome of a changed coefficient: which case misses a bar with it.
struct FidelityVerdict {
  std::string seen_by;  ///< name of the case; empty: none
  std::string missed;   ///< its first missed bar, or the fault of the run
  std::string refused;  ///< why the world refuses this value; empty: it does not
};

struct FidelityMutation {
  FidelityCoefficient of;
  std::string vehicle;                      ///< name of its file, without the ending
  std::array<FidelityVerdict, 2> verdicts;  ///< for the value decreased, and increased
  std::string without_effect;               ///< why no case can see it; empty: it should be seen
  /// True when a change to at least one side is seen by no case.
  bool unseen() const;
};

/// Runs a case with a changed coefficient until it misses a bar.
FidelityVerdict try_fidelity_mutation(const FidelityCase& of, const FidelityCoefficient& coefficient, double factor);

/// Returns true when the case itself changes this coefficient, so that it cannot see it.
bool overrides_coefficient(const FidelityCase& of, const FidelityCoefficient& coefficient);

/// Changes every coefficient of every vehicle of a file of cases by `share` of its value, to both sides, one at a time,
/// and finds a case of this vehicle that misses a bar.  `progress` is called with a line after each vehicle.
std::vector<FidelityMutation> mutate_fidelity(const FidelityFile& file, double share,
                                              const std::function<void(const std::string&)>& progress);

/// Returns a page in Markdown: how many coefficients each vehicle has, and what no case sees.  `cases`: the file of
/// cases, as in the command.
std::string fidelity_mutations_page(const std::vector<FidelityMutation>& mutations, double share,
                                    const std::string& cases);

/// Returns a CSV table with a row for each coefficient of each vehicle and the cases that see it change.
std::string fidelity_mutations_csv(const std::vector<FidelityMutation>& mutations);

}  // namespace verification
