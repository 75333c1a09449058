// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/control/sim_service.hpp"

#include <spdlog/fmt/fmt.h>

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
#include "sim/base/log.hpp"
#include "sim/config/message_text.hpp"

namespace bridges {

namespace {

constexpr double info_rate_hz = 0.1;
/// Refusal of a request that a client sent for a tick of a branch that was left.
constexpr const char* rewound_text = "the world was rewound before this request was carried out";

}  // namespace

SimService::SimService(sim::Bus& bus, sim::Bus& network, sim::World& world, sim::RunControl& control,
                       LockstepService& lockstep, Info info, const ServiceLinks& links)
    : bus_(bus),
      network_(network),
      world_(world),
      control_(control),
      lockstep_(lockstep),
      info_(std::move(info)),
      spawned_vehicles_(world, bus, links.journal),
      journal_(links.journal),
      others_(links.others),
      publish_scene_(links.publish_scene),
      bus_url_(links.bus_url),
      audit_(bus, world),
      spawns_("spawn requests", "spawns_per_client", world.config().limits.spawns_per_client),
      rewinds_("rewind and restore requests", "rewinds_per_client", world.config().limits.rewinds_per_client) {
  open_link(network);
  for (sim::Bus* vehicles : links.vehicle_buses) open_link(*vehicles);
  lockstep.set_on_contradiction([this](const std::string& client, const std::string& signer, const std::string& text) {
    audit_.add({0, "contradiction", client, signer, text}, lockstep_.branch());
  });
  lockstep.set_on_answer([this](const std::string& client) { spawned_vehicles_.client_alive(client); });
}

void SimService::open_link(sim::Bus& network) {
  links_.push_back({&network, network.open_mailbox("sim.control"), network.open_mailbox("sim.info")});
}

template <typename Message>
void SimService::publish(sim::Bus& bus, const std::string& channel, const Message& message) {
  shoal::encode_into(message, buffer_);
  bus.publish(channel, buffer_, world_.now());
}

bool SimService::due(double rate_hz) const {
  if (rate_hz <= 0) return false;
  // Returns true once in each period: at the first step at or after a multiple of it.
  const double period_us = 1e6 / rate_hz;
  const double now = static_cast<double>(world_.now().count());
  const double before = now - static_cast<double>(world_.step_time().count());
  return world_.step_number() == 0 || std::floor(now / period_us + 1e-9) > std::floor(before / period_us + 1e-9);
}

void SimService::publish_step() {
  spawned_vehicles_.report_changes();
  if (!muted_) spawned_vehicles_.report_to_other_timeline(network_);
  // Already published in this step if the run has just started or was rewound.
  if (due(info_rate_hz) && info_step_ != world_.step_number()) publish_info();
  if (!due(world_.config().state_rate_hz)) return;
  shoal::utime_t clock{};
  clock.utime = world_.epoch_us() + world_.now().count();
  publish(bus_, "sim.clock", clock);
  for (std::size_t i = 1; i < links_.size(); ++i) {
    shoal::encode_into(clock, buffer_);
    // A muted run repeats steps that its clients have seen.
    if (!muted_) links_[i].network->publish("sim.clock", buffer_, world_.now());
    lockstep_.post(static_cast<int>(i), "sim.clock", buffer_);
  }
  publish_state();
}

void SimService::publish_info() {
  shoal::sim_info_t info{};
  info.utime = world_.epoch_us() + world_.now().count();
  info.world = world_.config().name;
  info.seed = world_.config().run.seed;
  info.step_us = world_.step_time().count();
  info.resolved_config = info_.resolved_config;
  info.versions = info_.versions;
  info.epoch_utime = world_.epoch_us();
  info.step = world_.step_number();
  info.branch = journal_ != nullptr ? journal_->branch() : 0;
  info.input_sequence = journal_ != nullptr ? journal_->sequence() : 0;
  info.build = info_.build;
  info.files = info_.files;
  info_step_ = world_.step_number();
  publish(bus_, "sim.info", info);
}

void SimService::publish_state() {
  static thread_local shoal::sim_state_t state{};  // reuses its vectors from step to step
  state.utime = world_.epoch_us() + world_.now().count();
  state.step = world_.step_number();
  // Size the lists of the message.
  const std::size_t count = world_.vehicles().size();
  state.count = static_cast<std::int32_t>(count);
  state.vehicle.resize(count);
  for (auto* list : {&state.position_m, &state.velocity_mps, &state.angular_velocity_radps})
    list->assign(count, std::vector<double>(3));
  state.orientation.assign(count, std::vector<double>(4));
  // Fill in pose and velocity of each vehicle frame V.
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

void SimService::warn_client(const std::string& text) {
  if (++bad_messages_ <= 100) sim::log_warn("{} (ignored)", sim::shortened(sim::printable(text), 300));
}

void SimService::handle_requests(TimeMachine* machine) {
  if (!repeating_)
    spawned_vehicles_.remove_timed_out([this](const std::string& client) { return lockstep_.has(client, 0); });
  lockstep_.check_clock();
  // Limit the requests per step, so that a flood does not block the world; the others remain queued, and overflows are
  // counted.
  constexpr int max_at_once = 50, max_taken = 1000;
  for (Link& link : links_)
    for (int taken = 0, handled = 0; taken < max_taken && handled < max_at_once; ++taken) {
      const auto message = link.requests->take();
      if (!message) break;
      if (handle_request(link, *message, machine)) ++handled;
    }
  answer_in_turn(max_at_once, machine);
  for (Link& link : links_)
    while (const auto info = link.infos->take())
      // No warning when the bus is shared intentionally.
      if (info->from_outside && others_ != nullptr && !others_->shared()) warn_of_another(link, "publishes");
}

/// Handles the request by which a starting run detects other simulators.  That of another run is answered, and the run
/// then refuses to start; a warning is given for one that starts nevertheless.
bool SimService::is_own_request(Link& link, const shoal::sim_control_request_t& request) {
  const OtherSimulators::Requester asker = others_->requester_of(request);
  if (asker == OtherSimulators::Requester::another_run_that_shares)
    warn_of_another(link, "was started with --lcm-shared");
  return asker == OtherSimulators::Requester::this_run;
}

void SimService::warn_of_another(const Link& link, const char* how) {
  if (std::exchange(warned_of_another_, true)) return;
  sim::log_warn("another simulator {} on {} of this run: clients and reports of the two runs will mix", how,
                lockstep_.called(number_of(link)));
}

/// Answers requests of lockstep clients, in the order of their turns.
void SimService::answer_in_turn(int max_at_once, TimeMachine* machine) {
  if (std::exchange(branch_of_requests_, lockstep_.branch()) != lockstep_.branch()) {
    lockstep_.requests().discard_answers();
    for (const ClientRequests::Waiting& each : lockstep_.requests().take_all()) {
      Link& link = links_[static_cast<std::size_t>(each.link)];
      if (each.request.command == "leave")
        answer(link, each.request, each.signer, machine);
      else
        reply(link, each.request, 0, false, rewound_text);
    }
  }
  for (int handled = 0; handled < max_at_once; ++handled) {
    const auto next = lockstep_.next_request();
    if (!next) break;
    answer(links_[static_cast<std::size_t>(next->link)], next->request, next->signer, machine);
  }
}

/// Lets a request wait for its turn, unless it repeats one that was answered: then repeats the answer.
void SimService::wait_for_turn(Link& link, const shoal::sim_control_request_t& request, const std::string& signer) {
  if (number_of(link) == 0) spawned_vehicles_.client_alive(request.client);
  ClientRequests& requests = lockstep_.requests();
  if (const ClientRequests::Answer* first = requests.answer_to(request)) {
    if (first->ok && request.command == "spawn") spawned_vehicles_.report_again(network_, first->text);
    return reply(link, request, 0, first->ok, first->text);
  }
  if (lockstep_.is_of_left_branch(request.client)) return reply(link, request, 0, false, rewound_text);
  if (requests.add({number_of(link), request, signer})) return;
  reply(link, request, 0, false,
        fmt::format("more than {} requests of this client, or {} MB of all, wait for their turn",
                    ClientRequests::max_waiting, ClientRequests::max_waiting_bytes >> 20));
}

/// Returns false for a request that waits for its turn.
bool SimService::handle_request(Link& link, const sim::Message& message, TimeMachine* machine) {
  try {
    const ControlGuard::Opened opened = lockstep_.guard().open(message.channel, message.payload);
    const auto request = shoal::decode<shoal::sim_control_request_t>(opened.content, shoal::Finite::any);
    if (others_ != nullptr && is_own_request(link, request)) return true;
    // A starting run does not have the key of this run, and changes nothing.
    const bool is_question =
        others_ != nullptr && others_->requester_of(request) != OtherSimulators::Requester::none_of_ours;
    if (!opened.refusal.empty() && !is_question) {
      refuse(link, request, opened);
    } else if (lockstep_.takes_turns(number_of(link), request)) {
      wait_for_turn(link, request, opened.signer);
      return false;
    } else {
      answer(link, request, opened.signer, machine);
    }
  } catch (const shoal::MessageError& error) {
    warn_client(std::string("sim.control: ") + error.what());
  }
  return true;
}

/// Refuses a request with the reason.  The rate of answers is limited, and a repeated request is not answered again:
/// its sender must not mistake this for the first answer.
void SimService::refuse(Link& link, const shoal::sim_control_request_t& request, const ControlGuard::Opened& opened) {
  constexpr int max_answers_per_s = 10;
  constexpr std::size_t max_warned = 100;
  ++refused_requests_;
  ++bad_messages_;
  if (warned_refused_.size() < max_warned && warned_refused_.insert(sim::shortened(request.client)).second)
    sim::log_warn("sim.control: '{}' of client '{}' is refused: {} (further requests of this client are only counted)",
                  sim::shortened(sim::printable(request.command)), sim::shortened(sim::printable(request.client)),
                  opened.refusal);
  const auto now = std::chrono::steady_clock::now();
  if (now - refusals_since_ > std::chrono::seconds(1)) {
    refusals_since_ = now;
    refusals_answered_ = 0;
  }
  if (opened.came_before || ++refusals_answered_ > max_answers_per_s) return;
  // Without its session: a joined client must not conclude that it was dropped.
  reply(link, request, 0, false, opened.refusal);
}

void SimService::reply(Link& link, const shoal::sim_control_request_t& request, std::int64_t session, bool ok,
                       const std::string& text) {
  shoal::sim_control_reply_t reply{};
  reply.id = request.id;
  reply.client = request.client;
  reply.session = session;
  reply.ok = ok;
  reply.text = ok ? text : sim::shortened(text, 4000);
  reply.utime = world_.epoch_us() + world_.now().count();  // the new time after a rewind
  publish(*link.network, "sim.control.reply", reply);
  link.network->end_of_step();
}

void SimService::answer(Link& link, const shoal::sim_control_request_t& request, const std::string& signer,
                        TimeMachine* machine) {
  const bool on_own_bus = &link != &links_.front();
  const std::int64_t session = sim::session_in(request.text, request.command);
  if (!on_own_bus) spawned_vehicles_.client_alive(request.client);  // vehicles are spawned on the bus of the world
  try {
    const bool of_lockstep = request.command == "join" || request.command == "leave" || request.command == "alive" ||
                             request.command == "follow";
    if (on_own_bus && !of_lockstep)
      throw std::runtime_error("a vehicle's bus only serves alive, follow, join and leave");
    ClientAccounts* account = account_for(request.command);
    if (account != nullptr) account->check(request.client);
    const bool releases = request.command == "leave" && releases_another(request);
    const std::optional<std::string> text = execute(link, request, machine);
    if (!text) return;
    if (account != nullptr) account->use(request.client);
    if (releases || request.command != "leave") note(request, signer);
    note_answer(link, request, true, *text);
    reply(link, request, session, true, *text);
  } catch (const std::exception& error) {  // an error of the request; the run continues
    warn_client((on_own_bus ? "sim.control of " + lockstep_.called(number_of(link)) : "sim.control") + ": client '" +
                sim::shortened(request.client) + "': " + error.what());
    note_answer(link, request, false, error.what());
    reply(link, request, session, false, error.what());
  }
}

void SimService::note_answer(const Link& link, const shoal::sim_control_request_t& request, bool ok,
                             const std::string& text) {
  if (lockstep_.takes_turns(number_of(link), request)) lockstep_.requests().note_answer(request, {ok, text});
}

ClientAccounts* SimService::account_for(const std::string& command) {
  if (command == "spawn") return &spawns_;
  return command == "rewind" || command == "restore" ? &rewinds_ : nullptr;
}

/// Returns whether a request releases another client: a program that leaves gives its own session, one that releases a
/// hanging client does not.
bool SimService::releases_another(const shoal::sim_control_request_t& request) const {
  return lockstep_.has(request.client) && sim::session_in(request.text, request.command) == 0;
}

void SimService::note(const shoal::sim_control_request_t& request, const std::string& signer) {
  static constexpr std::array<std::string_view, 5> noted{"leave", "quit", "remove", "restore", "rewind"};
  if (std::find(noted.begin(), noted.end(), request.command) == noted.end()) return;
  const std::string what = request.command == "rewind"  ? fmt::format("{:g} s", request.value)
                           : request.command == "leave" ? "without its session"
                                                        : request.text;
  sim::log_info("{} requests '{}{}{}'", who_asked(request.client, signer), request.command, what.empty() ? "" : " ",
                sim::shortened(sim::printable(what)));
  audit_.add({0, request.command, request.client, signer, what}, lockstep_.branch());
}

std::optional<std::string> SimService::execute(Link& link, const shoal::sim_control_request_t& request,
                                               TimeMachine* machine) {
  const std::string& command = request.command;
  const int number = number_of(link);
  // The time machine goes first: pause, step, rewind and the like act on the run, everything else on the world.
  if (machine != nullptr)
    if (auto text = machine->execute(command, request.text, request.value)) return text;
  if (command == "quit") {
    control_.quit = true;
  } else if (command == "join") {
    if (!lockstep_.join(number, request)) return std::nullopt;
  } else if (command == "leave") {
    if (!leave(number, request)) return std::nullopt;
  } else if (command == "follow") {
    lockstep_.follow(number, request);
  } else if (command == "spawn") {
    return spawned_vehicles_.spawn(request.client, request.text);
  } else if (command == "remove") {
    spawned_vehicles_.remove(request.client, request.text);
  } else if (command == "describe") {
    return spawned_vehicles_.describe(request.client, request.text);
  } else if (command == "bus") {
    return url_of(request.text);
  } else if (command == "do") {
    spawned_vehicles_.act(request.client, request.text);
  } else if (command == "scene") {
    if (publish_scene_) publish_scene_();
  } else if (command != "alive") {
    throw std::runtime_error("unknown command '" + sim::shortened(sim::printable(command)) +
                             "'; known commands: alive, bus, describe, do, follow, join, leave, pause, quit, "
                             "remove, restore, resume, rewind, scene, snapshot, spawn, speed, step, until, where");
  }
  return "";
}

std::string SimService::url_of(const std::string& name) const {
  const sim::Vehicle* vehicle = world_.find_vehicle(name);
  if (vehicle == nullptr) throw sim::WorldError("there is no vehicle '" + sim::shortened(sim::printable(name)) + "'");
  return bus_url_ ? bus_url_(vehicle->bus()) : "";
}

bool SimService::leave(int link, const shoal::sim_control_request_t& request) {
  const bool has_spawned = link == 0 && spawned_vehicles_.has(request.client);
  const bool takes_part = lockstep_.has(request.client, link);
  if ((takes_part || !has_spawned) && !lockstep_.leave(link, request)) return false;
  if (link == 0) spawned_vehicles_.remove_vehicles_of(request.client);
  return true;
}

std::string SimService::execute_local(const shoal::sim_control_request_t& request, TimeMachine* machine) {
  const std::string& command = request.command;
  if (command == "join" || command == "leave" || command == "follow")
    throw std::runtime_error("'" + command + "' is for programs only");
  const std::optional<std::string> text = execute(links_.front(), request, machine);
  note(request, "");
  return text.value_or("");
}

void SimService::execute_again(const shoal::sim_control_request_t& request) {
  const std::string& command = request.command;
  if (command == "spawn")
    spawned_vehicles_.spawn_again(request.client, request.text);
  else if (command == "remove")
    spawned_vehicles_.remove(request.client, request.text);
  else if (command == "describe")
    spawned_vehicles_.describe(request.client, request.text);
  else if (command == "do")
    spawned_vehicles_.act(request.client, request.text);
  else
    // What else a client may request acts on the run, not on the world, and is not part of a replay.
    throw std::runtime_error("'" + sim::shortened(sim::printable(command)) + "' does not change a world");
}

void SimService::client_exited(const std::string& client) {
  const bool on_own_bus = lockstep_.has(client) && !lockstep_.has(client, 0);
  lockstep_.client_exited(client);
  if (!on_own_bus) spawned_vehicles_.remove_vehicles_of(client);
}

}  // namespace bridges
