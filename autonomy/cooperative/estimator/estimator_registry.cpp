// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/estimator/estimator_registry.hpp"

#include <map>
#include <stdexcept>

namespace navigation {

namespace {

std::map<std::string, Algorithm>& algorithms_by_name() {
  static std::map<std::string, Algorithm> algorithms;
  return algorithms;
}

/// Those of families, which exist once a caller has named them.
std::map<std::string, Algorithm>& made_algorithms() {
  static std::map<std::string, Algorithm> algorithms;
  return algorithms;
}

using AlgorithmFamily = std::function<Algorithm(const std::string& rest)>;

std::map<std::string, AlgorithmFamily>& families_by_prefix() {
  static std::map<std::string, AlgorithmFamily> families;
  return families;
}

}  // namespace

bool detail::add_family(std::string prefix, AlgorithmFamily make) {
  return families_by_prefix().emplace(std::move(prefix), std::move(make)).second;
}

bool detail::add_algorithm(Algorithm algorithm) {
  std::string name = algorithm.name;
  if (algorithms_by_name().contains(name)) throw std::logic_error("algorithm '" + name + "' exists twice");
  return algorithms_by_name().emplace(std::move(name), std::move(algorithm)).second;
}

const Algorithm& algorithm_named(const std::string& name) {
  const auto found = algorithms_by_name().find(name);
  if (found != algorithms_by_name().end()) return found->second;
  const auto made = made_algorithms().find(name);
  if (made != made_algorithms().end()) return made->second;
  // Families make an algorithm from the rest of the name, such as python:FILE.Class.
  for (const auto& [prefix, make] : families_by_prefix())
    if (name.starts_with(prefix))
      return made_algorithms().emplace(name, make(name.substr(prefix.size()))).first->second;
  std::string known;
  for (const auto& [each, algorithm] : algorithms_by_name()) known += (known.empty() ? "" : ", ") + each;
  throw std::invalid_argument("unknown algorithm '" + name + "'; known algorithms: " + known);
}

std::vector<const Algorithm*> all_algorithms() {
  std::vector<const Algorithm*> all;
  for (const auto& [name, algorithm] : algorithms_by_name()) all.push_back(&algorithm);
  return all;
}

}  // namespace navigation
