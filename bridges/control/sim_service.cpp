// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/control/sim_service.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bridges/log/run_journal.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_info_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "shoal/utime_t.hpp"
#include "sim/config/message_text.hpp"

namespace bridges {

namespace {

constexpr double info_rate_hz = 0.1;

}  // namespace

SimService::SimService(sim::Bus& bus, sim::Bus& network, sim::World& world, sim::RunControl& control,
                       LockstepService& lockstep, Info info, const ServiceLinks& links)
    : bus_(bus),
      network_(network),
      world_(world),
      control_(control),
      lockstep_(lockstep),
      info_(std::move(info)),
      visitors_(world, bus, links.journal),
      journal_(links.journal),
      others_(links.others),
      notices_(bus, world),
      spawns_("spawn requests", "spawns_per_client", world.config().limits.spawns_per_client),
      rewinds_("rewind and restore requests", "rewinds_per_client", world.config().limits.rewinds_per_client) {
  open_line(network);
  for (sim::Bus* vehicles : links.vehicle_buses) open_line(*vehicles);
  lockstep.set_on_contradiction([this](const std::string& client, const std::string& signer, const std::string& text) {
    notices_.add({0, "contradiction", client, signer, text}, lockstep_.branch());
  });
  lockstep.set_on_heard([this](const std::string& client) { visitors_.heard_of(client); });
}

void SimService::open_line(sim::Bus& network) {
  lines_.push_back({&network, network.open_mailbox("sim.control"), network.open_mailbox("sim.info")});
}

template <typename Message>
void SimService::publish(sim::Bus& bus, const std::string& channel, const Message& message) {
  shoal::encode_into(message, buffer_);
  bus.publish(channel, buffer_, world_.now());
}

bool SimService::due(double rate_hz) const {
  if (rate_hz <= 0) return false;
  // True once in each period: at the first step at or after a multiple of it.
  const double period_us = 1e6 / rate_hz;
  const double now = static_cast<double>(world_.now().count());
  const double before = now - static_cast<double>(world_.step_time().count());
  return world_.step_number() == 0 || std::floor(now / period_us + 1e-9) > std::floor(before / period_us + 1e-9);
}

void SimService::publish_step() {
  visitors_.tell_changes();
  if (!muted_) visitors_.tell_others(network_);
  if (due(info_rate_hz) && info_step_ != world_.step_number()) publish_info();
  if (!due(world_.config().state_rate_hz)) return;
  shoal::utime_t clock;
  clock.utime = world_.epoch_us() + world_.now().count();
  publish(bus_, "sim.clock", clock);
  for (std::size_t i = 1; i < lines_.size(); ++i) {
    shoal::encode_into(clock, buffer_);
    if (!muted_) lines_[i].network->publish("sim.clock", buffer_, world_.now());
    lockstep_.post(static_cast<int>(i), "sim.clock", buffer_);
  }
  publish_state();
}

void SimService::publish_info() {
  shoal::sim_info_t info;
  info.utime = world_.epoch_us() + world_.now().count();
  info.world = world_.config().name;
  info.seed = world_.config().run.seed;
  info.step_us = world_.step_time().count();
  info.resolved_config = info_.resolved_config;
  info.versions = info_.versions;
  info.epoch_utime = world_.epoch_us();
  info.step = world_.step_number();
  info.branch = journal_ != nullptr ? journal_->branch() : 0;
  info.mail_sequence = journal_ != nullptr ? journal_->sequence() : 0;
  info.build = info_.build;
  info.files = info_.files;
  info_step_ = world_.step_number();
  publish(bus_, "sim.info", info);
}

void SimService::publish_state() {
  static thread_local shoal::sim_state_t state;  // keeps its vectors from step to step
  state.utime = world_.epoch_us() + world_.now().count();
  state.step = world_.step_number();
  const std::size_t count = world_.vehicles().size();
  state.count = static_cast<std::int32_t>(count);
  state.vehicle.resize(count);
  for (auto* list : {&state.position_m, &state.velocity_mps, &state.angular_velocity_radps})
    list->assign(count, std::vector<double>(3));
  state.orientation.assign(count, std::vector<double>(4));
  for (std::size_t i = 0; i < count; ++i) {
    const sim::Vehicle& vehicle = *world_.vehicles()[i];
    const sim::Pose X_WV = vehicle.X_WV();
    const sim::Quaterniond q(X_WV.linear());
    const sim::Vector3d w_W = vehicle.base().w_WB_W();
    const sim::Vector3d r_W = X_WV.translation() - vehicle.base().X_WB().translation();
    const sim::Vector3d v_W = vehicle.base().v_WB_W() + w_W.cross(r_W);
    state.vehicle[i] = vehicle.name();
    for (int k = 0; k < 3; ++k) {
      state.position_m[i][static_cast<std::size_t>(k)] = X_WV.translation()[k];
      state.velocity_mps[i][static_cast<std::size_t>(k)] = v_W[k];
      state.angular_velocity_radps[i][static_cast<std::size_t>(k)] = w_W[k];
    }
    state.orientation[i] = {q.w(), q.x(), q.y(), q.z()};
  }
  publish(bus_, "sim.state", state);
}

void SimService::complain(const std::string& text) {
  if (++bad_messages_ <= 100) spdlog::warn("{} (ignored)", sim::shortened(sim::printable(text), 300));
}

void SimService::handle_requests(TimeMachine* machine) {
  visitors_.remove_silent();
  lockstep_.look_at_clock();
  // A flood of requests must not keep the world from stepping; the rest waits, and what overflows is counted.
  constexpr int most_at_once = 50;
  for (Line& line : lines_)
    for (int handled = 0; handled < most_at_once; ++handled) {
      const auto message = line.requests->take();
      if (!message) break;
      handle_request(line, *message, machine);
    }
  for (Line& line : lines_)
    while (const auto info = line.infos->take())
      // Who shares the bus on purpose knows of the other.
      if (info->from_outside && others_ != nullptr && !others_->shared()) warn_of_another(line, "publishes");
}

/// Of a run that starts, for other simulators.  Another one's is answered, and that run then refuses to start; one that
/// starts all the same is warned of.
bool SimService::is_own_question(Line& line, const shoal::sim_control_request_t& request) {
  const OtherSimulators::Asker asker = others_->who_asks(request);
  if (asker == OtherSimulators::Asker::another_run_that_shares) warn_of_another(line, "was started with --lcm-shared");
  return asker == OtherSimulators::Asker::this_run;
}

void SimService::warn_of_another(const Line& line, const char* how) {
  if (std::exchange(warned_of_another_, true)) return;
  spdlog::warn("another simulator {} on {} of this run: clients and reports of the two mix", how,
               lockstep_.called(number_of(line)));
}

void SimService::handle_request(Line& line, const sim::Message& message, TimeMachine* machine) {
  try {
    const ControlGuard::Opened opened = lockstep_.guard().open(message.channel, message.payload);
    const auto request = shoal::decode<shoal::sim_control_request_t>(opened.content, shoal::Finite::any);
    if (others_ != nullptr && is_own_question(line, request)) return;
    // A run that starts has no key of ours, and changes nothing.
    const bool is_question = others_ != nullptr && others_->who_asks(request) != OtherSimulators::Asker::nobody;
    if (!opened.refusal.empty() && !is_question) return refuse(line, request, opened);
    answer(line, request, opened.signer, machine);
  } catch (const shoal::MessageError& error) {
    complain(std::string("sim.control: ") + error.what());
  }
}

/// Who is refused gets to know the rule, but a flood of such requests is not answered by a flood, and what came before
/// was answered then: its sender must not take this for the answer.
void SimService::refuse(Line& line, const shoal::sim_control_request_t& request, const ControlGuard::Opened& opened) {
  constexpr int max_answers_per_s = 10;
  constexpr std::size_t max_told = 100;
  ++refused_requests_;
  ++bad_messages_;
  if (told_refused_.size() < max_told && told_refused_.insert(sim::shortened(request.client)).second)
    spdlog::warn("sim.control: '{}' of client '{}' is refused: {} (more of this client are only counted)",
                 sim::shortened(sim::printable(request.command)), sim::shortened(sim::printable(request.client)),
                 opened.refusal);
  const auto now = std::chrono::steady_clock::now();
  if (now - refusals_since_ > std::chrono::seconds(1)) {
    refusals_since_ = now;
    refusals_answered_ = 0;
  }
  if (opened.came_before || ++refusals_answered_ > max_answers_per_s) return;
  // Without its session: a client that has joined must not be made to believe that it was dropped.
  reply(line, request, 0, false, opened.refusal);
}

void SimService::reply(Line& line, const shoal::sim_control_request_t& request, std::int64_t session, bool ok,
                       const std::string& text) {
  shoal::sim_control_reply_t reply;
  reply.id = request.id;
  reply.client = request.client;
  reply.session = session;
  reply.ok = ok;
  reply.text = ok ? text : sim::shortened(text, 4000);
  reply.utime = world_.epoch_us() + world_.now().count();  // after a rewind the new time
  publish(*line.network, "sim.control.reply", reply);
  line.network->end_of_step();
}

void SimService::answer(Line& line, const shoal::sim_control_request_t& request, const std::string& signer,
                        TimeMachine* machine) {
  const bool on_own_bus = &line != &lines_.front();
  const std::int64_t session = sim::session_in(request.text, request.command);
  if (!on_own_bus) visitors_.heard_of(request.client);  // vehicles are brought on the world's bus
  try {
    const bool of_lockstep = request.command == "join" || request.command == "leave" || request.command == "alive" ||
                             request.command == "follow";
    if (on_own_bus && !of_lockstep)
      throw std::runtime_error("only alive, follow, join and leave are served on a vehicle's bus");
    ClientAccounts* account = account_for(request.command);
    if (account != nullptr) account->check(request.client);
    const bool lets_go = request.command == "leave" && lets_go_of_another(request);
    const std::optional<std::string> text = obey(line, request, machine);
    if (!text) return;
    if (account != nullptr) account->use(request.client);
    if (lets_go || request.command != "leave") note(request, signer);
    reply(line, request, session, true, *text);
  } catch (const std::exception& error) {  // whatever it is, it is the request's fault, and the run goes on
    complain((on_own_bus ? "sim.control of " + lockstep_.called(number_of(line)) : "sim.control") + ": client '" +
             sim::shortened(request.client) + "': " + error.what());
    reply(line, request, session, false, error.what());
  }
}

ClientAccounts* SimService::account_for(const std::string& command) {
  if (command == "spawn") return &spawns_;
  return command == "rewind" || command == "restore" ? &rewinds_ : nullptr;
}

/// A program that leaves names its session, which it alone knows by heart; who lets go of a hanging one does not.
bool SimService::lets_go_of_another(const shoal::sim_control_request_t& request) const {
  return lockstep_.has(request.client) && sim::session_in(request.text, request.command) == 0;
}

void SimService::note(const shoal::sim_control_request_t& request, const std::string& signer) {
  static constexpr std::array<std::string_view, 5> noted{"leave", "quit", "remove", "restore", "rewind"};
  if (std::find(noted.begin(), noted.end(), request.command) == noted.end()) return;
  const std::string what = request.command == "rewind"  ? fmt::format("{:g} s", request.value)
                           : request.command == "leave" ? "without its session"
                                                        : request.text;
  spdlog::info("{} requests '{}{}{}'", who_asked(request.client, signer), request.command, what.empty() ? "" : " ",
               sim::shortened(sim::printable(what)));
  notices_.add({0, request.command, request.client, signer, what}, lockstep_.branch());
}

std::optional<std::string> SimService::obey(Line& line, const shoal::sim_control_request_t& request,
                                            TimeMachine* machine) {
  const std::string& command = request.command;
  const int number = number_of(line);
  if (machine != nullptr)
    if (auto text = machine->obey(command, request.text, request.value)) return text;
  if (command == "quit") {
    control_.quit = true;
  } else if (command == "join") {
    if (!lockstep_.join(number, request)) return std::nullopt;
  } else if (command == "leave") {
    if (!leave(number, request)) return std::nullopt;
  } else if (command == "follow") {
    lockstep_.follow(number, request);
  } else if (command == "spawn") {
    return visitors_.spawn(request.client, request.text);
  } else if (command == "remove") {
    visitors_.remove(request.client, request.text);
  } else if (command == "describe") {
    return visitors_.describe(request.client, request.text);
  } else if (command == "do") {
    visitors_.act(request.client, request.text);
  } else if (command != "alive") {
    throw std::runtime_error("unknown command '" + sim::shortened(sim::printable(command)) +
                             "'; known commands: alive, describe, do, follow, join, leave, pause, quit, "
                             "remove, restore, resume, rewind, snapshot, spawn, speed, step, until, where");
  }
  return "";
}

bool SimService::leave(int line, const shoal::sim_control_request_t& request) {
  const bool brought_vehicles = line == 0 && visitors_.has(request.client);
  const bool takes_part = lockstep_.has(request.client, line);
  if ((takes_part || !brought_vehicles) && !lockstep_.leave(line, request)) return false;
  if (line == 0) visitors_.remove_those_of(request.client);
  return true;
}

void SimService::obey_again(const shoal::sim_control_request_t& request) {
  const std::string& command = request.command;
  if (command == "spawn")
    visitors_.spawn_again(request.client, request.text);
  else if (command == "remove")
    visitors_.remove(request.client, request.text);
  else if (command == "describe")
    visitors_.describe(request.client, request.text);
  else if (command == "do")
    visitors_.act(request.client, request.text);
  else
    throw std::runtime_error("'" + sim::shortened(sim::printable(command)) + "' does not change a world");
}

void SimService::client_gone(const std::string& client) {
  const bool on_own_bus = lockstep_.has(client) && !lockstep_.has(client, 0);
  lockstep_.client_gone(client);
  if (!on_own_bus) visitors_.remove_those_of(client);
}

}  // namespace bridges
