// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "tests/fidelity/closed_forms.hpp"

namespace wave_records {

inline constexpr double g = 9.80665, pi = std::numbers::pi;

inline std::vector<test::ClosedForm> rows_of_spectra() {
  std::vector<test::ClosedForm> rows = test::closed_forms_of("pierson_moskowitz");
  for (const test::ClosedForm& row : test::closed_forms_of("jonswap")) rows.push_back(row);
  return rows;
}

/// The `waves:` of a row.
inline std::string spectrum_of(const test::ClosedForm& form) {
  return "type: " + form.name + ", hs_m: " + std::to_string(form.at("Hs")) +
         ", tp_s: " + std::to_string(form.at("Tp")) +
         (form.name == "jonswap" ? ", gamma: " + std::to_string(form.at("gamma")) : "");
}

}  // namespace wave_records
