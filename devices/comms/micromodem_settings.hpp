// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "sim/state/state_archive.hpp"

namespace devices {

/// Settings of a Micro-Modem ($CCCFG, $CCCFQ): numbers with names of three letters, as in the real modem.  Settings
/// without an effect in the simulation are also stored and reported, so that a driver reads back what it wrote.
class MicromodemSettings {
 public:
  MicromodemSettings();

  /// Returns a setting; none when it does not exist.
  std::optional<int> find(const std::string& name) const;
  /// Returns a setting that exists.
  int get(const char* name) const { return values_.at(name); }
  bool on(const char* name) const { return get(name) != 0; }
  enum class Outcome { done, unknown, out_of_range };
  Outcome set(const std::string& name, int value);
  /// Resets all settings to their defaults.
  void reset() { *this = MicromodemSettings(); }
  const std::map<std::string, int>& all() const { return values_; }
  void visit_state(sim::StateArchive& archive);

 private:
  std::map<std::string, int> values_;
};

}  // namespace devices
