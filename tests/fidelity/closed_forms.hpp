// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/project_paths.hpp"

namespace test {

/// A row of tests/fidelity/reference/closed_forms.csv.
struct ClosedForm {
  std::string name;        ///< of the case
  std::string parameters;  ///< such as `T=5;depth=10`
  std::string quantity;
  double expected = 0;
  double tolerance = 0;  ///< absolute, in the unit of the quantity

  /// The number of one parameter.  Throws when there is none of this name.
  double at(const std::string& key) const {
    std::istringstream all(parameters);
    for (std::string each; std::getline(all, each, ';');)
      if (each.starts_with(key + "=")) return std::stod(each.substr(key.size() + 1));
    throw std::runtime_error(name + " " + parameters + " has no " + key);
  }
};

/// All rows of all cases, in the order of the file.
inline std::vector<ClosedForm> all_closed_forms() {
  std::ifstream in(test_support::source_path("tests/fidelity/reference/closed_forms.csv"));
  std::vector<ClosedForm> forms;
  std::string line;
  std::getline(in, line);  // the header
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::string field[7];
    for (std::string& text : field) std::getline(fields, text, ',');
    const double expected = std::stod(field[3]);
    forms.push_back(
        {field[0], field[1], field[2], expected, std::stod(field[5]) * (field[6] == "rel" ? std::abs(expected) : 1)});
  }
  return forms;
}

/// All rows of a case, or those of one quantity.  Throws when there is none.
inline std::vector<ClosedForm> closed_forms_of(const std::string& name, const std::string& quantity = "") {
  std::vector<ClosedForm> forms;
  for (const ClosedForm& form : all_closed_forms())
    if (form.name == name && (quantity.empty() || form.quantity == quantity)) forms.push_back(form);
  if (forms.empty()) throw std::runtime_error("no rows of " + name + " " + quantity);
  return forms;
}

/// The one row of this case and quantity whose parameters contain `parameters`.  Throws when there is none, or more.
inline ClosedForm closed_form(const std::string& name, const std::string& parameters, const std::string& quantity) {
  std::vector<ClosedForm> found;
  for (const ClosedForm& form : closed_forms_of(name, quantity))
    if (form.parameters.find(parameters) != std::string::npos) found.push_back(form);
  if (found.size() != 1)
    throw std::runtime_error(std::to_string(found.size()) + " rows of " + name + " " + parameters + " " + quantity);
  return found.front();
}

/// Compares with a row, at the row's own tolerance.
inline void expect_closed_form(double value, const ClosedForm& form) {
  EXPECT_NEAR(value, form.expected, form.tolerance) << form.name << " " << form.parameters << " " << form.quantity;
}

inline void expect_closed_form(double value, const std::string& name, const std::string& parameters,
                               const std::string& quantity) {
  expect_closed_form(value, closed_form(name, parameters, quantity));
}

}  // namespace test
