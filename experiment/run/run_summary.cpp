// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "devices/common/serial_port.hpp"
#include "devices/comms/message_modem.hpp"
#include "experiment/process/process_check.hpp"
#include "experiment/process/world_programs.hpp"
#include "experiment/run/run.hpp"
#include "experiment/run/version.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "sim/acoustics/channel.hpp"
#include "sim/base/log.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/world/world_checks.hpp"
#include "sim/world/world_state.hpp"

namespace experiment {

namespace {

/// Records a signal as the end of the run; a signal during its end counts as well.
void note_signal(Summary& summary) {
  if (caught_signal() != 0 && summary.exit_code <= 1 && summary.error.empty())
    summary.fail(128 + caught_signal(), "signal", "");
}

/// Returns whether all programs of the world are started here, or a client by hand.
bool programs_take_part(const sim::WorldConfig& world, const RunOptions& options) {
  return world.processes.empty() || options.launch || !options.await.empty();
}

}  // namespace

void Run::finish(Summary& summary) {
  const OrderlyEnd orderly;
  programs_.note_last();
  if (alone_) {        // otherwise the bus belongs to another simulator
    admit_messages();  // record messages after the last step as inputs
    parts_.journal.finish(summary.ended != "fault" && summary.ended != "error");
    parts_.lockstep.publish_end([this](std::chrono::milliseconds time) { parts_.buses.wait(time); },
                                std::chrono::milliseconds(caught_signal() == 0 ? 1000 : 200));
    if (caught_signal() == 0) programs_.await_clients();
  }
  programs_.stop();
  parts_.buses.close_record();
  if (const auto error = parts_.buses.record_error(); error && summary.exit_code == 0) summary.fail(4, "bus", *error);
  add_figures(summary);
  warn_at_end(summary);
  // Any failed rule or program, or the event that ended it.
  if (summary.exit_code == 0 && summary.judgement() == Judgement::failed) summary.exit_code = 1;
  note_signal(summary);
  if (results_) write_results(summary);
  report_missed_snapshots();
}

void Run::warn_at_end(Summary& summary) {
  if (summary.steps == 0) return;
  sim::Warnings warnings;
  if (programs_take_part(loaded_.config, options_)) scoring_.warn_of_silence(warnings);
  const bridges::ChannelUse use = parts_.lockstep.channel_use();
  const auto is_awaited = [&](const std::string& channel) {
    return std::any_of(use.clients().begin(), use.clients().end(), [&](const auto& client) {
      const auto found = client.second.find(channel);
      return found != client.second.end() && found->second.is_subscribed;
    });
  };
  for (const std::string& line : sim::end_warnings(parts_.world, is_awaited)) warnings.warn({}, "", line);
  warn_of_channels(loaded_, parts_.world, use, !options_.record.empty(), warnings);
  summary.warnings = warnings.lines();
}

void Run::add_figures(Summary& summary) {
  const sim::BusCounts counts = parts_.buses.counts();
  // Run, versions and time.
  summary.world = loaded_.config.name;
  summary.description = loaded_.config.description;
  summary.seed = loaded_.config.run.seed;
  summary.branch = parts_.control.branch;
  summary.snapshot = options_.from_file;
  summary.from_s = time_.scores_from_s();
  summary.stepped_s = sim::to_seconds(parts_.world.step_time() * steps_taken_);
  summary.version = short_version();
  summary.build = build_text();
  summary.steps = parts_.world.step_number();
  summary.sim_time_s = sim::to_seconds(parts_.world.now());
  summary.duration_s = duration_s_;
  // Hashes and counts of messages.
  summary.state_hash = parts_.world.state().hash();
  summary.run_hash = parts_.world.state().run_hash(summary.state_hash);
  summary.messages = counts.published + counts.received;
  summary.dropped_messages = counts.dropped_incoming + counts.dropped_outgoing + parts_.lockstep.dropped_messages();
  summary.bad_messages = parts_.world.counts().bad_messages + parts_.service.bad_messages() +
                         parts_.lockstep.bad_messages() + scoring_.bad_messages();
  summary.quick_steps = parts_.world.physics().quick_steps();
  // More threads are of interest only to a user who asked for some, where the run takes all the time it can get.
  constexpr double keeps_up = 0.9;
  if (options_.threads > 1 &&
      (parts_.control.speed <= 0 || summary.real_time_factor() < keeps_up * parts_.control.speed))
    summary.threads_advice = shared_work_.advice(sim::ThreadPool(options_.threads).threads());
  // Modems and serial ports.
  const LinkCounts links = link_counts(parts_.world, "", "");
  if (!parts_.world.acoustics().transducers().empty()) summary.acoustics = links;
  summary.acoustic_effects = parts_.world.acoustics().effects();
  for (const sim::ShadowLoss& loss : parts_.world.acoustics().shadow_losses())
    summary.shadowed.push_back({sim::to_seconds(loss.sent), loss.source, loss.receiver, loss.range_m});
  summary.modem_dropped_messages = parts_.world.shared().of(devices::message_modems).dropped_from_queues();
  summary.serial_dropped_bytes = devices::serial_dropped_bytes(parts_.world);
  // Metrics, programs and interventions.
  summary.metrics = scoring_.figures();
  summary.verdicts = scoring_.verdicts();
  summary.processes = programs_.ended();
  if (options_.launch)
    for (const std::string& bridge : free_bridges(loaded_)) summary.not_repeatable.push_back("bridge " + bridge);
  summary.clients = parts_.lockstep.summaries();
  summary.not_recorded = parts_.lockstep.not_recorded();
  if (const std::uint64_t count = parts_.buses.left_out_of_record(); count > 0)
    summary.not_recorded.push_back(fmt::format("{} messages (--record-mb)", count));
  summary.needs_key = parts_.lockstep.guard().requires_key();
  summary.refused_requests = parts_.service.refused_requests();
  summary.audit = parts_.service.audit().all();
  summary.audit_count = parts_.service.audit().count();
  summary.event = parts_.world.ended();
  for (const auto& [vehicle, record] : parts_.world.zone_records()) summary.zones[vehicle] = record;
  // Without the programs of the world there is nothing to judge.
  const bool took_part = programs_take_part(loaded_.config, options_);
  if (!took_part && !summary.verdicts.empty())
    summary.no_verdicts = "its programs took no part: see --launch and --await";
  if (!took_part) summary.verdicts.clear();
  const auto rules = static_cast<std::ptrdiff_t>(summary.verdicts.size());
  summary.contacts = scoring_.contacts().all();
  summary.judge_processes();
  summary.judge_clients();
  // A rule applies to the whole run; a failed program counts in any case.
  if (summary.ended_by_hand()) summary.verdicts.erase(summary.verdicts.begin(), summary.verdicts.begin() + rules);
}

void Run::write_results(Summary& summary) {
  const int exit_code = summary.exit_code;
  const int signals = caught_signals();
  try {
    results_->finish(summary, scoring_, loaded_.resolved, [&] { return caught_signals() != signals; });
  } catch (const std::exception& error) {
    if (summary.exit_code <= 1 && summary.error.empty()) summary.fail(4, "bus", error.what());
  }
  note_signal(summary);
  if (summary.exit_code == exit_code) return;
  try {
    results_->write_summary_again(summary);
  } catch (const std::exception& error) {
    sim::log_debug("{}", error.what());
  }
}

}  // namespace experiment
