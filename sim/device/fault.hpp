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
  degraded,  ///< the random errors of a quantity are multiplied by `noise_factor`; messages are lost with probability
             ///< `dropout`
  partial,   ///< an actuator delivers the share `effectiveness` of its effort
  dead,      ///< an actuator delivers no effort
};

inline constexpr ChoiceWords<FaultKind> fault_kind_words{
    {"stuck", FaultKind::stuck},       {"silent", FaultKind::silent},   {"biased", FaultKind::biased},
    {"degraded", FaultKind::degraded}, {"partial", FaultKind::partial}, {"dead", FaultKind::dead}};

/// Fault of a device, as configured in YAML.
struct FaultConfig {
  FaultKind kind = FaultKind::silent;  ///< kind of the fault
  std::string quantity;     ///< biased, degraded: the key of its noise without `_noise`; empty: every quantity
  double bias = 0;          ///< biased: in the unit of the quantity
  double noise_factor = 1;  ///< degraded
  double dropout = 0;  ///< degraded: probability that a report or command is lost, in addition to that of the device
  double effectiveness = 1;  ///< partial: 0 to 1

  /// Reads the keys of a fault.
  void read(ParamReader& in);
  /// Compares all members.
  bool operator==(const FaultConfig&) const = default;
  /// Visits all members.
  void visit_state(StateArchive& archive);
};

/// Faults of one device: at most one of each kind (and quantity), the last one set.
class DeviceFaults {
 public:
  /// Sets a fault; replaces one of the same kind and quantity.
  void set(const FaultConfig& fault);
  /// Removes all faults.
  void clear();

  /// Returns the effect of the faults on the Noise of a quantity; created at the first call, with a stable address.
  const NoiseFault& noise_of(const std::string& quantity);

  /// Returns the active faults.
  const std::vector<FaultConfig>& active() const { return active_; }
  /// Returns whether the last report or command is repeated.
  bool stuck() const { return stuck_; }
  /// Returns whether all messages are blocked.
  bool silent() const { return silent_; }
  /// Returns the probability that a message is lost, in addition to that of the device.
  double dropout() const { return dropout_; }
  /// Returns the available share of the effort, 0 to 1.
  double effectiveness() const { return effectiveness_; }
  /// Visits the active faults.
  void visit_state(StateArchive& archive);

 private:
  struct Quantity {
    std::string name;
    NoiseFault fault;
  };
  /// Computes the combined effect of the active faults.
  void update();

  std::vector<FaultConfig> active_;
  std::vector<std::unique_ptr<Quantity>> quantities_;
  bool stuck_ = false;
  bool silent_ = false;
  double dropout_ = 0;
  double effectiveness_ = 1;
};

}  // namespace sim
