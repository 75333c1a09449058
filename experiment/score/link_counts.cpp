// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/link_counts.hpp"

#include <algorithm>

#include "devices/comms/acoustic_modem.hpp"
#include "devices/comms/modem.hpp"
#include "sim/acoustics/channel.hpp"
#include "sim/acoustics/transducer.hpp"

namespace experiment {

const std::vector<std::string>& loss_causes() {
  static const std::vector<std::string> causes = [] {
    std::vector<std::string> words;
    for (int loss = 1; loss < sim::signal_losses; ++loss)  // 0: none
      words.emplace_back(sim::signal_loss_word(static_cast<sim::SignalLoss>(loss)));
    return words;
  }();
  return causes;
}

namespace {

LinkCounts no_counts() {
  LinkCounts counts;
  for (const std::string& cause : loss_causes()) counts.lost[cause] = 0;
  return counts;
}

void add_losses(LinkCounts& sum, const std::array<std::int64_t, sim::signal_losses>& lost) {
  const std::vector<std::string>& causes = loss_causes();
  for (std::size_t i = 0; i < causes.size(); ++i) sum.lost[causes[i]] += lost[i + 1];  // 0: none
}

/// Returns whether a name is of a vehicle (empty: any) and one of its devices (empty: any).
bool is_asked(const std::string& full_name, const std::string& vehicle, const std::string& device) {
  if (vehicle.empty()) return true;
  return device.empty() ? full_name.starts_with(vehicle + "/") : full_name == vehicle + "/" + device;
}

LinkCounts radio_counts(const sim::World& world, const std::string& vehicle, const std::string& device) {
  LinkCounts sum = no_counts();
  for (const auto& mounted : world.devices()) {
    const auto* modem = mounted ? dynamic_cast<const devices::Modem*>(mounted->sensor()) : nullptr;
    if (modem == nullptr || !is_asked(modem->full_name(), vehicle, device)) continue;
    const devices::Modem::Counts& counts = modem->counts();
    sum.sent += counts.sent;
    sum.bytes_sent += counts.sent_bytes;
    sum.received += counts.received;
    sum.dropped += modem->dropped_from_queue();
    add_losses(sum, counts.lost);
  }
  return sum;
}

}  // namespace

LinkCounts link_counts(const sim::World& world, const std::string& vehicle, const std::string& device) {
  LinkCounts sum = no_counts();
  const auto add = [&](const sim::Transducer::Counts& counts) {
    sum.sent += counts.sent;
    sum.bytes_sent += counts.sent_bytes;
    sum.received += counts.understood;
    sum.unsent += counts.unsent;
    add_losses(sum, counts.lost);
  };
  if (vehicle.empty()) add(world.acoustics().counts_of_removed());
  const bool any_lost = std::any_of(sum.lost.begin(), sum.lost.end(), [](const auto& lost) { return lost.second > 0; });
  sum.acoustic = sum.sent > 0 || sum.received > 0 || any_lost;  // modems that were removed
  // Acoustic transducers.
  for (const sim::Transducer* transducer : world.acoustics().transducers()) {
    if (transducer == nullptr || !is_asked(transducer->full_name(), vehicle, device)) continue;
    add(transducer->counts());
    sum.acoustic = sum.acoustic || transducer->has_address();
  }
  // Queues of modems.
  for (const auto& mounted : world.devices()) {
    const auto* modem = mounted ? dynamic_cast<const devices::AcousticModem*>(mounted->sensor()) : nullptr;
    if (modem != nullptr && is_asked(mounted->full_name(), vehicle, device)) sum.dropped += modem->dropped_from_queue();
  }
  return sum;
}

LinkCounts any_link_counts(const sim::World& world, const std::string& vehicle, const std::string& device) {
  const LinkCounts counts = link_counts(world, vehicle, device);
  return counts.acoustic ? counts : radio_counts(world, vehicle, device);
}

}  // namespace experiment
