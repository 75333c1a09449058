// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_parts.hpp"

#include "experiment/run/run_ports.hpp"
#include "experiment/run/version.hpp"
#include "experiment/snapshot/run_identity.hpp"

namespace experiment {

namespace {

sim::PortOpener opener_of(const sim::WorldConfig& world, const RunOptions& run, const RunParts::Options& options,
                          bridges::JournalPorts& ports) {
  if (options.ports) return options.ports;
  return run.serial_ports ? ports.wrap(serial_ports_of(world, run)) : sim::PortOpener();
}

}  // namespace

RunParts::RunParts(const sim::LoadedWorld& loaded, const RunOptions& run, const Options& options)
    : buses(loaded.config, run, options.tap, options.taps),
      other_simulators(buses.networks(), run.lcm_shared),
      world(loaded.config, buses.outer(), opener_of(loaded.config, run, options, ports),
            [this](const std::string& name) -> sim::Bus& { return buses.of(name); }),
      journal(options.journal != nullptr ? *options.journal : buses.outer(), world, ports,
              [this, is_read = options.journal == nullptr] {
                return is_read && (buses.has_listeners() || buses.gate().reads("sim.hash"));
              }),
      lockstep(world, control, lockstep_buses(run, options)),
      service(buses.outer(), buses.network(), world, control, lockstep,
              {sim::to_yaml(loaded.resolved), version_text(), build_text(), options.files}, service_links(options)) {}

std::vector<bridges::LockstepBus> RunParts::lockstep_buses(const RunOptions& run, const Options& options) {
  if (!options.has_clients) return {};
  const bool is_recorded = !run.record.empty();
  std::vector<bridges::LockstepBus> all{{buses.network(), buses.gate(), "", is_recorded}};
  for (const sim::BusConfig& bus : world.config().buses)
    all.push_back({buses.network(bus.name), buses.gate(bus.name), bus.name, is_recorded});
  return all;
}

bridges::ServiceLinks RunParts::service_links(const Options& options) {
  if (!options.has_clients) return {};
  bridges::ServiceLinks links{&journal, &other_simulators};
  links.publish_scene = options.publish_scene;
  links.bus_url = [this](sim::Bus& bus) { return buses.url(buses.name_of(bus)); };
  for (const sim::BusConfig& bus : world.config().buses) links.vehicle_buses.push_back(&buses.network(bus.name));
  return links;
}

}  // namespace experiment
