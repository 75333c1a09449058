// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace tools {

/// A row of a file of closed forms, with what the simulator gives.
struct ClosedFormRow {
  std::string name, parameters, quantity, unit;
  double expected = 0;
  double tolerance = 0;  ///< absolute
  double computed = 0;
  bool within() const;
};

/// The rows about sound of a CSV file `case,parameters,quantity,expected,unit,tolerance,tol_kind,note`, in its order.
/// Throws std::runtime_error.
std::vector<ClosedFormRow> acoustic_closed_forms(const std::string& file);

/// As a table in Markdown.
std::string closed_forms_text(const std::vector<ClosedFormRow>& rows);

}  // namespace tools
