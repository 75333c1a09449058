// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "sim/state/state_archive.hpp"

namespace devices {

/// The settings of a Micro-Modem ($CCCFG, $CCCFQ): numbers with names of three letters.  It has the names of the real
/// one; those without an effect here are stored and reported nevertheless, so that a driver reads back what it wrote.
class MicromodemSettings {
 public:
  MicromodemSettings();

  /// Nothing when there is no such setting.
  std::optional<int> find(const std::string& name) const;
  /// Of one that exists.
  int get(const char* name) const { return values_.at(name); }
  bool on(const char* name) const { return get(name) != 0; }
  enum class Outcome { done, unknown, out_of_range };
  Outcome set(const std::string& name, int value);
  /// All values become those of a new modem.
  void reset() { *this = MicromodemSettings(); }
  const std::map<std::string, int>& all() const { return values_; }
  void visit_state(sim::StateArchive& archive);

 private:
  std::map<std::string, int> values_;
};

}  // namespace devices
