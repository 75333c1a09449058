// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "autonomy/cooperative/estimator/estimator.hpp"

namespace navigation {

/// Registered algorithm; one of the two makers is set.
struct Algorithm {
  std::string name;
  std::string meaning;
  std::function<std::unique_ptr<Estimator>()> make;
  std::function<std::unique_ptr<TeamEstimator>()> make_team;  ///< of a reference that runs from a record only
  bool on_land = true;                                        ///< it handles relative measurements of other vehicles
  bool at_sea = true;                                         ///< it uses ranges by sound
  /// Returns the CPU time that a program of the algorithm has used outside of this process; may be empty.
  std::function<double()> outside_cpu_s = {};
};

/// Clock of the CPU time of an algorithm and what calls it.
class AlgorithmClock {
 public:
  explicit AlgorithmClock(const Algorithm& algorithm) : algorithm_(algorithm), start_s_(used_s()) {}
  /// Returns the time since the construction.
  double elapsed_s() const { return used_s() - start_s_; }

 private:
  double used_s() const {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC +
           (algorithm_.outside_cpu_s ? algorithm_.outside_cpu_s() : 0);
  }

  const Algorithm& algorithm_;
  double start_s_;
};

/// Returns the algorithm with this name, or one of a family: `python:FILE.Class`.  Throws std::invalid_argument, with
/// the known names.
const Algorithm& algorithm_named(const std::string& name);
/// Returns all that this program has, by name; none of a family, such as those in Python.
std::vector<const Algorithm*> all_algorithms();

namespace detail {
bool add_algorithm(Algorithm algorithm);
/// Registers algorithms that are made by the rest of their name.
bool add_family(std::string prefix, std::function<Algorithm(const std::string& rest)> make);
}  // namespace detail

/// Whether an estimator has an on_bearing() of its own.
template <class Type>
inline constexpr bool has_own_on_bearing =
    !std::is_same_v<decltype(&Type::on_bearing), void (Estimator::*)(const Relative&)>;

/// Whether an estimator uses ranges by sound: unless it has `static constexpr bool at_sea = false`.
template <class Type>
constexpr bool is_at_sea() {
  if constexpr (requires { Type::at_sea; })
    return Type::at_sea;
  else
    return true;
}

/// Registers an algorithm, in its own file: an Estimator with `static constexpr const char* meaning`.  Without its
/// own on_bearing() it does not work on land.
#define SHOAL_ESTIMATOR(name, Type)                                                 \
  [[maybe_unused]] static const bool registered_estimator_##Type =                  \
      ::navigation::detail::add_algorithm({name,                                    \
                                           Type::meaning,                           \
                                           [] { return std::make_unique<Type>(); }, \
                                           {},                                      \
                                           ::navigation::has_own_on_bearing<Type>,  \
                                           ::navigation::is_at_sea<Type>()})

/// Registers a TeamEstimator.
#define SHOAL_TEAM_ESTIMATOR(name, Type)                           \
  [[maybe_unused]] static const bool registered_estimator_##Type = \
      ::navigation::detail::add_algorithm({name, Type::meaning, {}, [] { return std::make_unique<Type>(); }, true})

}  // namespace navigation
