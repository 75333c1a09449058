// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/config/config_node.hpp"
#include "tools/experiment/upgrade/rewriting.hpp"

namespace tools {

/// What became of the text of a file.
struct UpgradedText {
  std::string text;                 ///< as it is to be; as it was where nothing changes
  std::vector<ChangedLines> lines;  ///< empty: it is up to date
};

/// Brings the text of a world, vehicle or study file to the format of this version.  Only what has changed is written
/// again; comments, quotes and layout stay.  The result is parsed and compared with what was meant.  Where anything is
/// in doubt an error goes to `diagnostics`, and the result is nothing.
std::optional<UpgradedText> upgrade_text(const std::string& text, FileKind kind, const std::string& file_name,
                                         sim::Diagnostics& diagnostics,
                                         std::span<const Rewriting> rewritings = tools::rewritings());

/// What the file is about by its keys; nothing when it is none of the three.
std::optional<FileKind> kind_of(const sim::ConfigNode& root);

}  // namespace tools
