// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/door/ros2_door.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <iostream>

#include "bridges/lockstep_client/wait_warning.hpp"
#include "bridges/ros2/node/node_types.hpp"
#include "bridges/ros2/ros2_names.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "shoal/sim_info_t.hpp"
#include "shoal/utime_t.hpp"

namespace bridges::ros2 {
namespace {

using namespace std::chrono_literals;

/// Most topics out, topics in and vehicles of a bus, on which any program may publish.
constexpr std::size_t max_topics = 5000;

/// Messages that are kept of a topic, and of the commands to one, in lockstep.
constexpr int max_in_a_tick = 1000;

/// In place of a writer that cannot be made.
constexpr std::int32_t no_endpoint = -1;

/// Returns whether a channel is only for clients of the run and its record.
bool is_internal(std::string_view channel) {
  static constexpr std::array<std::string_view, 10> internal{
      "sim.ack",    "sim.control", "sim.control.reply", "sim.hash",     "sim.inputs",
      "sim.resend", "sim.resent",  "sim.signed",        "sim.snapshot", "sim.tick"};
  return std::find(internal.begin(), internal.end(), channel) != internal.end();
}

std::string user_data(std::string_view type, std::string_view schema) {
  return "typehash=" + type_hash(type, schema) + ";";
}

/// `/rover1/imu` is `rt/rover1/imu`.
std::string dds_topic(const std::string& topic) {
  return "rt" + topic;
}

std::vector<std::string> commands_of(const shoal::sim_vehicle_t& vehicle) {
  std::vector<std::string> commands = vehicle.command_channel;
  commands.insert(commands.end(), vehicle.command_types.begin(), vehicle.command_types.end());
  return commands;
}

}  // namespace

Ros2Door::Ros2Door(const Options& options)
    : options_(options),
      client_("shoal-ros2-" + std::to_string(getpid())),
      lcm_(options.lcm_url),
      participant_(options.network, "enclave=/;"),
      services_({[this](const std::string& command, double value, const std::string& text) {
                   return ask(command, value, text);
                 },
                 [this](std::size_t service, std::span<const std::byte> cdr) { answer(service, cdr); }},
                options.controls) {
  const auto key = options.run.empty() ? run_key_from_environment() : read_run_key(options.run);
  if (key) signer_.emplace(*key, client_);
  graph_ = participant_.add_writer("ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_",
                                   {1, true, ""});
  add_services();
  if (!options.lockstep.nodes.empty()) add_lockstep();
  lcm_.listen_to_all();
  receiver_ = std::thread([this] { receive(); });
}

Ros2Door::~Ros2Door() {
  participant_.stop();
  receiver_.join();
}

void Ros2Door::run(const std::function<bool()>& stops) {
  std::exception_ptr error;
  std::atomic<bool> is_over = false;
  std::thread lockstep;
  if (lockstep_)
    lockstep = std::thread([&] {
      try {
        lockstep_->run();
      } catch (...) {
        error = std::current_exception();
      }
      is_over = true;
    });
  try {
    carry([&] { return is_over || stops(); });
  } catch (...) {
    error = std::current_exception();
  }
  if (lockstep_) {
    lockstep_->stop();
    lockstep.join();
  }
  if (error) std::rethrow_exception(error);
}

void Ros2Door::carry(const std::function<bool()>& stops) {
  WaitWarning no_bus("shoal-ros2: waiting for messages of a run at " + lcm_.url());
  bool answers_wait = false;
  for (bool heard = false; !stops();) {
    const auto message = lcm_.next(answers_wait ? 5ms : 100ms);
    heard = heard || message;
    if (!heard) no_bus.look();
    const std::scoped_lock lock(mutex_);
    if (message) take_message(*message);
    look_after(Clock::now());
    answers_wait = !waiting_answers_.empty();
  }
}

void Ros2Door::add_lockstep() {
  const DdsQos qos{1, true, user_data(Tick::type, Tick::schema())};
  const std::string type = dds_type_name(Tick::type);
  ticks_ = participant_.add_writer("rt/shoal/tick", type, qos);
  tick_answers_ = participant_.add_reader("rt/shoal/tick_done", type, {max_in_a_tick, false, qos.user_data});
  Ros2Lockstep::Links links;
  links.pass = [this](const std::string& channel, std::span<const std::byte> payload) {
    const std::scoped_lock lock(mutex_);
    is_in_tick_ = true;
    publish({channel, {payload.begin(), payload.end()}, 0});
    is_in_tick_ = false;
  };
  links.channels = [this] {
    const std::scoped_lock lock(mutex_);
    return report_channels();
  };
  links.tell = [this](const Tick& tick) {
    const std::scoped_lock lock(mutex_);
    utime_ = tick.utime;
    participant_.write(ticks_, encode(tick));
    if (tick.last) participant_.flush(ticks_);
  };
  links.warn = [](const std::string& sentence) { std::cerr << "shoal-ros2: " << sentence << std::endl; };
  lockstep_.emplace(options_.lcm_url, options_.lockstep, std::move(links));
}

void Ros2Door::add_services() {
  for (std::size_t i = 0; i < SimServices::services().size(); ++i) {
    const SimServices::Service& service = SimServices::services()[i];
    std::string type = dds_type_name(service.type);
    type.pop_back();
    const Endpoint reader =
        participant_.add_reader("rq/" + std::string(service.name) + "Request", type + "_Request_", {});
    answers_.push_back(participant_.add_writer("rr/" + std::string(service.name) + "Reply", type + "_Response_", {}));
    calls_.push_back(reader);
    service_of_.emplace(reader, i);
  }
}

void Ros2Door::take_message(const Received& message) {
  if (!lockstep_ || !belongs_to_ticks(message.channel)) publish(message);
}

/// Reports come by the lockstep, in its order.  Until all are known, so may be any other message.
bool Ros2Door::belongs_to_ticks(const std::string& channel) {
  const auto& ticked = Ros2Lockstep::world_channels;
  if (channel.starts_with("sim.")) return std::find(ticked.begin(), ticked.end(), channel) != ticked.end();
  return !knows_state_ || rates_hz_.contains(channel) || !report_channels();
}

void Ros2Door::publish(const Received& message) {
  try {
    learn(message);
  } catch (const shoal::MessageError&) {
    return;  // of a stranger on the bus; the simulator warns
  }
  if (is_internal(message.channel) || command_channels_.contains(message.channel)) return;
  if (table_.topics().size() < max_topics ||
      table_.has(message.channel, static_cast<std::uint64_t>(shoal::fingerprint(message.payload))))
    table_.encode(message.channel, message.payload, *this);
}

void Ros2Door::learn(const Received& message) {
  using shoal::Finite;
  if (message.channel == "sim.clock") {
    utime_ = shoal::decode<shoal::utime_t>(message.payload, Finite::any).utime;
  } else if (message.channel == "sim.state") {
    auto state = shoal::decode<shoal::sim_state_t>(message.payload, Finite::any);
    for (const std::string& name : state.vehicle)
      if (vehicles_.size() < max_topics) vehicles_.try_emplace(name);
    present_ = state.vehicle;
    knows_state_ = true;
    services_.know(std::move(state));
  } else if (message.channel == "sim.vehicle") {
    learn_vehicle(shoal::decode<shoal::sim_vehicle_t>(message.payload, Finite::any));
  } else if (message.channel == "sim.info") {
    auto info = shoal::decode<shoal::sim_info_t>(message.payload, Finite::any);
    if (info.resolved_config == world_) return;
    world_ = std::move(info.resolved_config);
    for (auto& [name, vehicle] : vehicles_) vehicle.is_described = false;
  } else if (message.channel == "sim.control.reply") {
    const auto reply = shoal::decode<shoal::sim_control_reply_t>(message.payload, Finite::any);
    if (reply.client != client_) return;
    const auto question = questions_.extract(reply.id);
    if (question.empty()) return services_.take_reply(reply, Clock::now());
    // A vehicle that was removed meanwhile is not described.
    const auto vehicle = vehicles_.find(question.mapped());
    if (reply.ok == 0 && vehicle != vehicles_.end()) vehicle->second.is_described = true;
  }
}

void Ros2Door::learn_vehicle(const shoal::sim_vehicle_t& description) {
  if (vehicles_.size() >= max_topics && !vehicles_.contains(description.vehicle)) return;
  Vehicle& vehicle = vehicles_[description.vehicle];
  if (description.present == 0) {
    forget(vehicle);
    vehicles_.erase(description.vehicle);
    return;
  }
  vehicle.is_described = true;
  vehicle.reports.clear();
  for (std::size_t i = 0; i < description.report_channel.size(); ++i) {
    if (description.report_channel[i].empty() || rates_hz_.size() >= max_topics) continue;
    vehicle.reports.insert(description.report_channel[i]);
    rates_hz_[description.report_channel[i]] = description.rate_hz[i];
  }
  if (vehicle.described == commands_of(description)) return;
  forget(vehicle);
  vehicle.described = commands_of(description);
  command_channels_.insert(description.command_channel.begin(), description.command_channel.end());
  for (CommandTopic& topic : command_topics(description)) {
    if (commands_.size() >= max_topics) break;
    try {
      const Endpoint reader =
          participant_.add_reader(dds_topic(topic.name), dds_type_name(topic.type),
                                  {lockstep_ ? max_in_a_tick : 10, false, user_data(topic.type, topic.schema)});
      vehicle.readers.push_back(reader);
      commands_.emplace(reader, std::move(topic));
    } catch (const BusError& error) {
      warn_once(topic.name, error.what());
    }
  }
  graph_changed_ = true;
}

void Ros2Door::forget(Vehicle& vehicle) {
  for (const Endpoint reader : vehicle.readers) {
    commands_.erase(reader);
    participant_.remove(reader);
  }
  vehicle.readers.clear();
  vehicle.described.clear();
  graph_changed_ = true;
}

/// Returns the channels of the vehicles in the last state; none while one of them is not described.
std::optional<std::set<std::string>> Ros2Door::report_channels() {
  std::set<std::string> channels;
  for (const std::string& name : present_) {
    const auto vehicle = vehicles_.find(name);
    if (vehicle == vehicles_.end()) continue;  // it was removed meanwhile
    if (!vehicle->second.is_described) return std::nullopt;
    channels.insert(vehicle->second.reports.begin(), vehicle->second.reports.end());
  }
  return channels;
}

/// Ends calls that wait too long, asks again what was not answered, and tells changes of the graph.
void Ros2Door::look_after(Clock::time_point now) {
  if (!waiting_answers_.empty()) send_answers(now);
  if (now < next_look_) return;
  next_look_ = now + 100ms;
  services_.expire(now);
  if (graph_changed_) publish_graph();
  if (now < next_question_) return;
  next_question_ = now + 1s;
  int questions = 200;
  for (const auto& [name, vehicle] : vehicles_)
    if (!vehicle.is_described && questions-- > 0) questions_.insert_or_assign(ask("describe", 0, name), name);
  while (questions_.size() > max_topics) questions_.erase(questions_.begin());  // a simulator that does not answer
}

/// Publishes rmw_dds_common/ParticipantEntitiesInfo, by which ROS 2 knows the endpoints of a node.
void Ros2Door::publish_graph() {
  graph_changed_ = false;
  std::vector<Endpoint> readers, writers = answers_;
  for (const auto& [reader, topic] : commands_) readers.push_back(reader);
  for (const auto& [reader, service] : service_of_) readers.push_back(reader);
  std::copy_if(writers_.begin(), writers_.end(), std::back_inserter(writers), [](Endpoint each) { return each > 0; });
  std::vector<std::byte> cdr;
  CdrWriter out(cdr);
  out.put_array(std::span<const std::uint8_t>(participant_.guid()));
  out.put_count(1);
  out.put(std::string_view("/"));
  out.put(std::string_view("shoal"));
  for (const auto* endpoints : {&readers, &writers}) {
    out.put_count(endpoints->size());
    for (const Endpoint each : *endpoints) out.put_array(std::span<const std::uint8_t>(participant_.guid_of(each)));
  }
  participant_.write(graph_, cdr);
}

std::int32_t Ros2Door::ask(const std::string& command, double value, const std::string& text) {
  shoal::sim_control_request_t request{};
  request.utime = utime_;
  request.id = ++last_request_;
  request.client = client_;
  request.command = command;
  request.value = value;
  request.text = text;
  const sim::Bytes payload = shoal::encode(request);
  lcm_.publish("sim.control", signer_ ? signer_->sign("sim.control", payload) : payload);
  return last_request_;
}

bool Ros2Door::wants(const Topic& topic) {
  if (topic.encoding != "cdr" || (topic.name == "/tf" && !options_.publishes_tf)) return false;
  writers_.resize(std::max(writers_.size(), topic.number + 1));
  depths_.resize(writers_.size());
  Endpoint& writer = writers_[topic.number];
  if (writer == 0) {
    try {
      const DdsQos qos = qos_of(topic);
      writer = participant_.add_writer(dds_topic(topic.name), dds_type_name(topic.type), qos);
      depths_[topic.number] = static_cast<std::uint32_t>(qos.depth);
      graph_changed_ = true;
    } catch (const BusError& error) {
      writer = no_endpoint;
      warn_once(topic.name, error.what());
    }
  }
  if (writer == no_endpoint) return false;
  return topic.latched || is_in_tick_ || participant_.has_readers(writer);
}

/// In lockstep a topic keeps the messages of a tick: those who subscribe late get them too, and so all runs are equal.
DdsQos Ros2Door::qos_of(const Topic& topic) const {
  DdsQos qos{topic.latched ? 1 : 10, topic.latched || is_in_tick_, user_data(topic.type, topic.schema)};
  if (topic.latched || !is_in_tick_) return qos;
  const auto rate = rates_hz_.find(topic.lcm_channel);
  const double in_a_tick = rate == rates_hz_.end() ? 0 : rate->second * options_.lockstep.period_s;
  qos.depth =
      in_a_tick > 0 ? static_cast<int>(std::min<double>(max_in_a_tick, 10 + 2 * std::ceil(in_a_tick))) : max_in_a_tick;
  return qos;
}

bool Ros2Door::take(const Topic& topic, std::span<const std::byte> bytes) {
  ++counts_.published;
  if (!participant_.write(writers_[topic.number], bytes))
    ++counts_.late;  // a node does not wait for it
  else if (is_in_tick_ && !topic.latched)
    lockstep_->count(topic.name, depths_[topic.number]);
  return true;
}

void Ros2Door::receive() {
  while (const auto readers = participant_.wait()) {
    for (const Endpoint reader : *readers)
      while (const auto cdr = participant_.take(reader)) {
        const std::scoped_lock lock(mutex_);
        deliver(reader, *cdr);
      }
  }
}

/// Reports the first mistake of a topic: another program may have taken its name with another type.
void Ros2Door::warn_once(const std::string& topic, const std::string& what) {
  if (warned_.insert(topic).second) std::cerr << "shoal-ros2: " << topic << ": " << what << std::endl;
}

/// The call of a new client may come before its reader of the answers is known: DDS would not send it what was written
/// before.  The answer waits until each client that can call can receive it, at most 10 s.
void Ros2Door::answer(std::size_t service, std::span<const std::byte> cdr) {
  constexpr std::size_t max_waiting = 1000;
  waiting_answers_.push_back({service, {cdr.begin(), cdr.end()}, Clock::now() + 10s});
  if (waiting_answers_.size() > max_waiting) waiting_answers_.front().until = {};
  send_answers(Clock::now());
}

void Ros2Door::send_answers(Clock::time_point now) {
  std::erase_if(waiting_answers_, [&](const WaitingAnswer& waiting) {
    const Endpoint writer = answers_[waiting.service];
    if (now < waiting.until && participant_.readers_of(writer) < participant_.writers_to(calls_[waiting.service]))
      return false;
    participant_.write(writer, waiting.cdr);
    return true;
  });
}

void Ros2Door::deliver(Endpoint reader, std::span<const std::byte> cdr) {
  const auto command = commands_.find(reader);
  const auto service = service_of_.find(reader);
  ++counts_.commands;
  try {
    if (reader == tick_answers_ && lockstep_)
      lockstep_->take(decode_tick(cdr));
    else if (command != commands_.end())
      deliver(command->second, cdr);
    else if (service != service_of_.end())
      services_.call(service->second, cdr, Clock::now());
  } catch (const shoal::MessageError& error) {
    ++counts_.refused;
    warn_once(command != commands_.end()     ? command->second.name
              : service != service_of_.end() ? SimServices::services()[service->second].name
                                             : "/shoal/tick_done",
              std::string("a message is ignored: ") + error.what());
  }
}

/// Passes a command on, in lockstep at the end of the tick: one that is refused counts as well.
void Ros2Door::deliver(const CommandTopic& command, std::span<const std::byte> cdr) {
  if (!lockstep_) {
    lcm_.publish(command.channel, command.convert(cdr, utime_));
    return;
  }
  std::optional<TickExchange::Command> converted;
  try {
    converted = {command.channel, command.convert(cdr, utime_)};
  } catch (const shoal::MessageError&) {
    lockstep_->add(command.name, std::nullopt);
    throw;
  }
  lockstep_->add(command.name, std::move(converted));
}

}  // namespace bridges::ros2
