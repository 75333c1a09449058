// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/shoal/urdf/xml_element.hpp"

namespace tools {

/// Refuses a length that is negative or more than 1e7 m.  `what`: its name for errors, such as `'size'` or `<size>`.
void check_length(const XmlElement& element, const std::string& what, double value);

/// Returns whether no dimension of a shape is below the least of a part, 1e-6 m, and no scale of a mesh below 1e-9.
bool has_volume(const RobotShape& shape);

/// Adds a note on a shape without volume.
void note_no_volume(const RobotShape& shape, const std::string& who, std::vector<ImportNote>& notes);

/// Returns a color as `#rrggbb`, and adds notes on what of it is not imported; empty: it is none.  `what`: its name for
/// notes; `shown`: its text; `rgba`: its numbers.
std::string color_of(const XmlElement& color, const std::string& what, const std::string& shown,
                     std::vector<double> rgba, std::vector<ImportNote>& notes);

/// Reads a `<visual>` by `read`.  An error becomes a note: what is only visual does not matter to a run.
std::optional<RobotShape> read_or_note(const XmlElement& visual, const std::function<std::optional<RobotShape>()>& read,
                                       std::vector<ImportNote>& notes);

}  // namespace tools
