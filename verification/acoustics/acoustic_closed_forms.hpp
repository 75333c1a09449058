// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace verification {

/// Row of a file of closed-form results, with the result of the simulator.
struct ClosedFormRow {
  std::string name, parameters, quantity, unit;
  double expected = 0;
  double tolerance = 0;  ///< absolute
  double computed = 0;
  bool within() const;
};

/// Reads the rows about sound of a CSV file `case,parameters,quantity,expected,unit,tolerance,tol_kind,note`, in its
/// order, and computes their quantities.  Throws std::runtime_error.
std::vector<ClosedFormRow> acoustic_closed_forms(const std::string& file);

/// Returns the rows as a table in Markdown.
std::string closed_forms_text(const std::vector<ClosedFormRow>& rows);

}  // namespace verification
