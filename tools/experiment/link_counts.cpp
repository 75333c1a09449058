#include "tools/experiment/link_counts.hpp"

#include "sim/acoustics/channel.hpp"
#include "sim/acoustics/transducer.hpp"

namespace tools {

LinkCounts link_counts(const sim::World& world, const std::string& vehicle, const std::string& device) {
  const std::vector<std::string>& causes = sim::loss_causes();
  LinkCounts sum;
  for (const std::string& cause : causes) sum.lost[cause] = 0;
  const auto add = [&](const sim::Transducer::Counts& counts) {
    sum.sent += counts.sent;
    sum.bytes_sent += counts.sent_bytes;
    sum.received += counts.understood;
    sum.unsent += counts.unsent;
    for (std::size_t i = 0; i < causes.size(); ++i) sum.lost[causes[i]] += counts.lost[i + 1];  // 0: none
  };
  if (vehicle.empty()) add(world.acoustics().counts_of_those_gone());
  for (const sim::Transducer* transducer : world.acoustics().transducers()) {
    if (transducer == nullptr) continue;
    if (!vehicle.empty() && transducer->vehicle().name() != vehicle) continue;
    if (!device.empty() && transducer->full_name() != vehicle + "/" + device) continue;
    add(transducer->counts());
  }
  return sum;
}

}  // namespace tools
