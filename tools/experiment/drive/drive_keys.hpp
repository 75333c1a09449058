// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/experiment/drive/drive_profile.hpp"

namespace tools {

/// Separates the bytes of a terminal into names of keys: characters, space, tab, enter, and the arrows, which a
/// terminal sends as ESC [ A or ESC O A (ECMA-48).  Other keys have no name.
class DriveKeyNames {
 public:
  /// Returns the name of the key that a byte completes; empty: none.
  std::string next(char byte);

 private:
  enum class State { none, escape, sequence };
  State state_ = State::none;
};

/// Set positions of the axes, moved by keys.
class DriveKeys {
 public:
  /// Effect of a key.
  enum class Effect { none, sign_of_life, next_joint };

  explicit DriveKeys(const DriveProfile::Keys& keys) : keys_(keys) {}
  /// Takes a key.  Every key of the profile is a sign of life except the one that centres.
  Effect press(const std::string& key);
  /// Returns the set position of each axis.
  const DriveValues& values() const { return values_; }
  void centre() { values_.clear(); }

 private:
  DriveProfile::Keys keys_;
  DriveValues values_;
};

}  // namespace tools
