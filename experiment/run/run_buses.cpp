// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_buses.hpp"

#include <cmath>
#include <filesystem>
#include <thread>

#include "bridges/base/bus_error.hpp"
#include "bridges/bus/network_check.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/vehicle/run_hash.hpp"

namespace experiment {

namespace {

/// Rejects special files: a pipe without a reader would block the run, and a terminal or a disk device must not receive
/// a log.
void check_record(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
  const bool folder = std::filesystem::is_directory(status);
  throw bridges::BusError(path + ": cannot record: it is " +
                          (folder ? "a folder" : "not a regular file; --special-files allows pipes and devices"));
}

}  // namespace

void RunBuses::Link::close_gate(const TapBus::Listener& listener, Tap taps) {
  sim::Bus* inner = recorder ? static_cast<sim::Bus*>(recorder.get()) : network.get();
  const auto add_tap = [&](Tap here) {
    if (!listener || taps != here) return;
    tap = std::make_unique<TapBus>(*inner, listener);
    inner = tap.get();
  };
  add_tap(Tap::sent);
  mute = std::make_unique<MuteBus>(*inner);
  inner = mute.get();
  add_tap(Tap::published);
  gate = std::make_unique<sim::MessageGate>(*inner);
}

RunBuses::RunBuses(const sim::WorldConfig& world, const RunOptions& options, const TapBus::Listener& tap, Tap taps) {
  main_ = open(options.lcm_url, options);
  if (!options.record.empty() && !options.special_files) check_record(options.record);
  if (!options.record.empty())
    main_.recorder = std::make_unique<bridges::RecordingBus>(
        *main_.network, options.record, world.epoch_us,
        options.overwrite ? bridges::Existing::overwrite : bridges::Existing::refuse);
  if (main_.recorder && options.record_mb) {
    const double duration_s = options.duration_s.value_or(world.run.duration_s);
    main_.recorder->set_budget({static_cast<std::uint64_t>(*options.record_mb * 1e6),
                                std::isfinite(duration_s) ? sim::from_seconds(duration_s).count() : 0});
  }
  main_.close_gate(tap, taps);
  std::map<std::string, std::string> names{{main_.lcm ? main_.lcm->url() : "", "the world's"}};
  for (const sim::BusConfig& bus : world.buses) {
    Link link = open(bus.lcm_url, options);
    if (link.lcm) {
      const auto [other, fresh] = names.emplace(link.lcm->url(), "bus '" + bus.name + "'");
      if (!fresh)
        throw bridges::BusError("bus '" + bus.name + "' and " + other->second + " have the same LCM URL " +
                                link.lcm->url());
    }
    if (main_.recorder) link.recorder = std::make_unique<bridges::RecordingBus>(*link.network, *main_.recorder);
    link.close_gate(tap, taps);
    others_.emplace(bus.name, std::move(link));
  }
}

RunBuses::Link RunBuses::open(const std::string& url, const RunOptions& options) {
  Link link;
  if (options.bus == "none") {
    link.network = std::make_unique<sim::InProcessBus>();
    return link;
  }
  bridges::LcmBusOptions lcm_options;
  lcm_options.arrivals = arrivals_;
  auto lcm = std::make_unique<bridges::LcmBus>(url, lcm_options);
  link.lcm = lcm.get();
  link.network = std::move(lcm);
  return link;
}

std::string RunBuses::url(const std::string& name) const {
  const Link& link = name.empty() ? main_ : others_.at(name);
  return link.lcm ? link.lcm->url() : "";
}

std::string RunBuses::name_of(sim::Bus& bus) const {
  const sim::Bus* const outer = &sim::RunHash::uncounted(bus);
  for (const auto& [name, link] : others_)
    if (link.gate.get() == outer) return name;
  return "";
}

bool RunBuses::leave_machine() const {
  bool leave = false;
  for_each([&](const Link& link) { leave = leave || (link.lcm && bridges::leaves_machine(link.lcm->url())); });
  return leave;
}

std::vector<bridges::OtherSimulators::BusToAsk> RunBuses::networks() const {
  std::vector<bridges::OtherSimulators::BusToAsk> networks;
  for_each([&](const Link& link) {
    if (link.lcm) networks.push_back({link.lcm->url(), link.lcm});
  });
  return networks;
}

void RunBuses::admit(const Admitted& admitted) {
  const auto hand_over = [&](const std::string& name, Link& link) {
    const std::vector<sim::MessageGate::Delivery>& inputs = link.gate->admit();
    if (inputs.empty()) return;
    if (link.recorder && !muted_) link.recorder->admitted(inputs);
    admitted(name, inputs);
  };
  hand_over("", main_);
  for (auto& [name, link] : others_) hand_over(name, link);
}

void RunBuses::wait(std::chrono::milliseconds time) {
  if (over_lcm())
    arrivals_->wait(time);
  else
    std::this_thread::sleep_for(time);
}

void RunBuses::end_of_step() {
  outer().end_of_step();
  for (auto& [name, link] : others_) link.outer().end_of_step();
}

void RunBuses::set_time(sim::Time at) {
  if (main_.recorder) main_.recorder->set_time(at);
}

std::optional<std::string> RunBuses::lost_connection() const {
  std::optional<std::string> lost;
  for_each([&](const Link& link) {
    if (link.lcm && !link.lcm->connected() && !lost) lost = "the connection to " + link.lcm->url() + " was lost";
  });
  return lost;
}

std::optional<std::string> RunBuses::record_error() const {
  return main_.recorder ? main_.recorder->error() : std::nullopt;
}

void RunBuses::close_record() {
  if (main_.recorder) main_.recorder->close();
}

void RunBuses::hand_over_record() {
  if (main_.recorder) main_.recorder->hand_over();
}

RunBuses::RecordMark RunBuses::record_mark() const {
  return main_.recorder ? RecordMark{main_.recorder->recorded(), main_.recorder->position()} : RecordMark{};
}

void RunBuses::prepare_record(const std::string& path, const RecordMark& mark, bool overwrite) {
  if (!main_.recorder) return;
  main_.recorder->prepare(path, mark.events, mark.position,
                          overwrite ? bridges::Existing::overwrite : bridges::Existing::refuse);
}

void RunBuses::branch_record() {
  if (main_.recorder) main_.recorder->go_on();
}

void RunBuses::give_up_record() {
  if (main_.recorder) main_.recorder->give_up();
}

void RunBuses::set_muted(bool muted) {
  muted_ = muted;
  for_each([&](const Link& link) {
    link.mute->set_muted(true);  // also discards messages that wait in the network
    link.gate->collect();
    link.gate->waiting().clear();
    link.mute->set_muted(muted);
  });
}

sim::BusCounts RunBuses::counts() const {
  sim::BusCounts sum;
  for_each([&](const Link& link) {
    const sim::BusCounts counts = link.gate->counts();
    sum.published += counts.published;
    sum.received += counts.received;
    sum.dropped_outgoing += counts.dropped_outgoing;
    sum.dropped_incoming += counts.dropped_incoming;
  });
  return sum;
}

}  // namespace experiment
