// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/config/config_node.hpp"
#include "tools/experiment/upgrade/rewriting.hpp"

namespace tools {

/// Result of upgrading the text of a file.
struct UpgradedText {
  std::string text;                 ///< new text; the original one where nothing changes
  std::vector<ChangedLines> lines;  ///< empty: the file is up to date
};

/// Upgrades the text of a world, vehicle or study file to the format of this version.  Rewrites only what has changed;
/// comments, quotes and layout are kept.  The result is parsed and compared with the intended meaning.  When anything
/// is ambiguous, an error is added to `diagnostics` and nothing is returned.
std::optional<UpgradedText> upgrade_text(const std::string& text, FileKind kind, const std::string& file_name,
                                         sim::Diagnostics& diagnostics,
                                         std::span<const Rewriting> rewritings = tools::rewritings());

/// Returns the kind of a file by its keys; nothing when it is none of the three.
std::optional<FileKind> kind_of(const sim::ConfigNode& root);

}  // namespace tools
