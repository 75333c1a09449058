// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/micromodem_settings.hpp"

#include <set>

namespace devices {

MicromodemSettings::MicromodemSettings()
    : values_{
          // Settings with an effect in the simulation; times in seconds, TAT in milliseconds.
          {"CST", 1},
          {"CTO", 10},
          {"DTO", 2},
          {"PTO", 14},
          {"REV", 1},
          {"RXD", 1},
          {"RXP", 0},
          {"SNV", 0},
          {"SRC", 0},
          {"TAT", 50},
          {"TXF", 1},
          {"TXP", 1},
          {"XST", 1},
          // Settings that are only stored.
          {"AGC", 0},
          {"AGN", 250},
          {"ASD", 0},
          {"BBD", 0},
          {"BND", 0},
          {"BR1", 3},
          {"BR2", 3},
          {"BW0", 0},
          {"CPR", 1},
          {"CRL", 50},
          {"DBG", 0},
          {"DGM", 0},
          {"DOP", 0},
          {"DQF", 0},
          {"DTH", 108},
          {"DTP", 90},
          {"ECD", 50},
          {"EFB", 2},
          {"EFF", 20},
          {"FMD", 1},
          {"FML", 200},
          {"GPS", 0},
          {"HFC", 0},
          {"IRE", 0},
          {"MCM", 1},
          {"MFD", 0},
          {"MOD", 0},
          {"MPR", 1},
          {"MSE", 0},
          {"NDT", 120},
          {"NPT", 50},
          {"NRL", 25},
          {"NRV", 150},
          {"PAD", 2},
          {"PCM", 0},
          {"POW", -157},
          {"PRL", 75},
          {"PTH", 50},
          {"RSP", -157},
          {"RXA", 0},
          {"SCG", 0},
          {"SGP", 0},
          {"SHF", 0},
          {"SNR", 0},
          {"SPL", 0},
          {"TOA", 0},
          {"TXD", 600},
      } {}

std::optional<int> MicromodemSettings::find(const std::string& name) const {
  const auto found = values_.find(name);
  if (found == values_.end()) return {};
  return found->second;
}

MicromodemSettings::Outcome MicromodemSettings::set(const std::string& name, int value) {
  const auto found = values_.find(name);
  if (found == values_.end()) return Outcome::unknown;
  if (name == "SRC" && (value < 0 || value > 126)) return Outcome::out_of_range;
  const bool is_time = name == "CTO" || name == "DTO" || name == "PTO";
  if (is_time && (value < 1 || value > 3600)) return Outcome::out_of_range;
  static const std::set<std::string> switches{"CST", "REV", "RXD", "RXP", "SNV", "TXF", "TXP", "XST"};
  if (switches.contains(name) && value != 0 && value != 1) return Outcome::out_of_range;
  if (name == "TAT" && (value < 0 || value > 10000)) return Outcome::out_of_range;
  found->second = value;
  return Outcome::done;
}

void MicromodemSettings::visit_state(sim::StateArchive& archive) {
  for (auto& [name, value] : values_) {
    int restored = value;
    archive(restored);
    if (archive.restoring() && set(name, restored) != Outcome::done)
      archive.fail("the snapshot has a setting " + name + " of " + std::to_string(restored) + ", which no modem takes");
  }
}

}  // namespace devices
