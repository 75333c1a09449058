// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "tools/shoal/urdf/robot_description.hpp"

namespace tools {

/// Names of one kind in a vehicle file: letters, digits, `_` and `-`, each unique.
class ShoalNames {
 public:
  /// `reserved`: names that are taken from the start.
  ShoalNames(std::string kind, std::set<std::string> reserved);

  /// Gives an original name its new one, and adds a note when they differ.
  std::string add(const std::string& original, const sim::SourcePlace& place, std::vector<ImportNote>& notes);
  /// Returns the new name of an original one; null: it was not added.
  const std::string* find(const std::string& original) const {
    const auto found = names_.find(original);
    return found == names_.end() ? nullptr : &found->second;
  }
  /// Returns the new name of an original one that was added.
  const std::string& of(const std::string& original) const { return names_.at(original); }

 private:
  std::string kind_;
  std::set<std::string> taken_;
  std::map<std::string, int> last_number_;  ///< by plain name, so that many equal names take linear time
  std::map<std::string, std::string> names_;
};

/// Returns the text with every character that a name must not have replaced by `_`; never empty.
std::string plain_name(const std::string& text);

}  // namespace tools
