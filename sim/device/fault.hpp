// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/random/noise.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

enum class FaultKind {
  stuck,     ///< a sensor repeats its last report, an actuator keeps its last command
  silent,    ///< no report is published, no command is received
  biased,    ///< `bias` is added to a quantity
  degraded,  ///< the random errors of a quantity are `noise_factor` times as large; `dropout` more is lost
  partial,   ///< an actuator gives `effectiveness` of its effort
  dead,      ///< an actuator gives none
};

inline constexpr ChoiceWords<FaultKind> fault_kind_words{
    {"stuck", FaultKind::stuck},       {"silent", FaultKind::silent},   {"biased", FaultKind::biased},
    {"degraded", FaultKind::degraded}, {"partial", FaultKind::partial}, {"dead", FaultKind::dead}};

/// What is wrong with a device, as YAML says it.
struct FaultConfig {
  FaultKind kind = FaultKind::silent;  ///< which of the faults
  std::string quantity;      ///< biased, degraded: the key of its noise without `_noise`; empty: every quantity
  double bias = 0;           ///< biased: in the unit of the quantity
  double noise_factor = 1;   ///< degraded
  double dropout = 0;        ///< degraded: probability that a report or command is lost, beside the device's own
  double effectiveness = 1;  ///< partial: 0 to 1

  /// Reads the keys of a fault.
  void read(ParamReader& in);
  /// Equal in all members.
  bool operator==(const FaultConfig&) const = default;
  /// All members.
  void visit_state(StateArchive& archive) { archive(kind, quantity, bias, noise_factor, dropout, effectiveness); }
};

/// The faults of one device.  Of each kind (and quantity) there is at most one: the last one set.
class DeviceFaults {
 public:
  /// Adds a fault, in place of one of the same kind and quantity.
  void set(const FaultConfig& fault);
  /// Removes all faults.
  void clear();

  /// Where the Noise of a quantity finds what a fault does to it; made at the first call, stays where it is.
  const NoiseFault& noise_of(const std::string& quantity);

  /// The faults that are set.
  const std::vector<FaultConfig>& active() const { return active_; }
  /// Whether the last report or command repeats.
  bool stuck() const { return stuck_; }
  /// Whether no message passes.
  bool silent() const { return silent_; }
  /// Probability that a message is lost, beside that of the device.
  double dropout() const { return dropout_; }
  /// Share of the effort that is left, 0 to 1.
  double effectiveness() const { return effectiveness_; }
  /// The active faults.
  void visit_state(StateArchive& archive);

 private:
  struct Quantity {
    std::string name;
    NoiseFault fault;
  };
  /// Computes what the active faults come to.
  void update();

  std::vector<FaultConfig> active_;
  std::vector<std::unique_ptr<Quantity>> quantities_;
  bool stuck_ = false;
  bool silent_ = false;
  double dropout_ = 0;
  double effectiveness_ = 1;
};

}  // namespace sim
