#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace test {

/// A row of tests/fidelity/reference/closed_forms.csv.
struct ClosedForm {
  double expected = 0;
  double tolerance = 0;  ///< absolute, in the unit of the quantity
};

/// The one row of this case and quantity whose parameters contain `parameters`.  Throws when there is none, or more.
inline ClosedForm closed_form(const std::string& name, const std::string& parameters, const std::string& quantity) {
  std::ifstream in(std::string(SHOAL_SOURCE_DIR) + "/tests/fidelity/reference/closed_forms.csv");
  int found = 0;
  ClosedForm form;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string field[7];
    for (std::string& text : field) std::getline(fields, text, ',');
    if (field[0] != name || field[2] != quantity || field[1].find(parameters) == std::string::npos) continue;
    ++found;
    form.expected = std::stod(field[3]);
    form.tolerance = std::stod(field[5]) * (field[6] == "rel" ? std::abs(form.expected) : 1);
  }
  if (found != 1)
    throw std::runtime_error(std::to_string(found) + " rows of " + name + " " + parameters + " " + quantity);
  return form;
}

/// Compares with a row, at the row's own tolerance.
inline void expect_closed_form(double value, const std::string& name, const std::string& parameters,
                               const std::string& quantity) {
  const ClosedForm form = closed_form(name, parameters, quantity);
  EXPECT_NEAR(value, form.expected, form.tolerance) << name << " " << parameters << " " << quantity;
}

}  // namespace test
