// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/drive/drive_profile.hpp"

namespace experiment {

/// Set positions of the axes, moved by keys.
class DriveKeys {
 public:
  /// Effect of a key.
  enum class Effect { none, sign_of_life, next_joint };

  explicit DriveKeys(const DriveProfile::Keys& keys) : keys_(keys) {}
  /// Takes a key by its name, as in KeyEvent.  Every key of the profile is a sign of life except the one that centers.
  Effect press(const std::string& key);
  /// Returns the set position of each axis.
  const DriveValues& values() const { return values_; }
  void centre() { values_.clear(); }

 private:
  DriveProfile::Keys keys_;
  DriveValues values_;
};

}  // namespace experiment
