// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/fault.hpp"

#include <algorithm>

namespace sim {

void FaultConfig::read(ParamReader& in) {
  in.require("kind");
  in.read_choice("kind", kind, fault_kind_words, "kind of fault");
  in.read("quantity", quantity, "biased, degraded: key of its noise without '_noise'; unset: every quantity");
  in.read("bias", bias, any_number(), "biased: added to the quantity, in its unit");
  in.read("noise_factor", noise_factor, between(0, 1e6), "degraded: the random errors are this many times as large");
  in.read("dropout", dropout, between(0, 1), "degraded: probability that a report or a command is lost");
  in.read("effectiveness", effectiveness, between(0, 1), "partial: the share of its effort that the actuator gives");
  const auto belongs_to = [&](const char* key, std::initializer_list<FaultKind> kinds) {
    if (in.has(key) && in.has("kind") && std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
      in.error(key, std::string("'") + key + "' does not apply to a fault of this kind");
  };
  belongs_to("quantity", {FaultKind::biased, FaultKind::degraded});
  belongs_to("bias", {FaultKind::biased});
  belongs_to("noise_factor", {FaultKind::degraded});
  belongs_to("dropout", {FaultKind::degraded});
  belongs_to("effectiveness", {FaultKind::partial});
}

void FaultConfig::visit_state(StateArchive& archive) {
  archive(kind, quantity, bias, noise_factor, dropout, effectiveness);
}

void DeviceFaults::set(const FaultConfig& fault) {
  std::erase_if(active_,
                [&](const FaultConfig& other) { return other.kind == fault.kind && other.quantity == fault.quantity; });
  active_.push_back(fault);
  update();
}

void DeviceFaults::clear() {
  active_.clear();
  update();
}

const NoiseFault& DeviceFaults::noise_of(const std::string& name) {
  for (const auto& quantity : quantities_)
    if (quantity->name == name) return quantity->fault;
  quantities_.push_back(std::make_unique<Quantity>(Quantity{name, {}}));
  update();
  return quantities_.back()->fault;
}

void DeviceFaults::update() {
  stuck_ = silent_ = false;
  // Several faults act together: biases add up, factors and probabilities of receiving multiply.
  double received = 1;
  effectiveness_ = 1;
  for (const auto& quantity : quantities_) quantity->fault = {};
  for (const FaultConfig& fault : active_) {
    stuck_ |= fault.kind == FaultKind::stuck;
    silent_ |= fault.kind == FaultKind::silent;
    if (fault.kind == FaultKind::degraded) received *= 1 - fault.dropout;
    if (fault.kind == FaultKind::dead) effectiveness_ = 0;
    if (fault.kind == FaultKind::partial) effectiveness_ *= fault.effectiveness;
    for (const auto& quantity : quantities_) {
      if (!fault.quantity.empty() && fault.quantity != quantity->name) continue;
      if (fault.kind == FaultKind::biased) quantity->fault.bias += fault.bias;
      if (fault.kind == FaultKind::degraded) quantity->fault.factor *= fault.noise_factor;
    }
  }
  dropout_ = 1 - received;
}

void DeviceFaults::visit_state(StateArchive& archive) {
  archive(active_);
  if (!archive.restoring()) return;
  for (const FaultConfig& fault : active_)
    if (fault.kind < FaultKind::stuck || fault.kind > FaultKind::dead) archive.fail("an unknown kind of fault");
  update();
}

}  // namespace sim
