// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/rosbridge_view.hpp"

#include <iterator>
#include <utility>

#include "bridges/control/spawned_vehicles.hpp"
#include "bridges/rosbridge/rosbridge_command.hpp"
#include "messages/yaml/message_writer.hpp"

namespace viewer {

namespace {

using bridges::rosbridge::CommandTopic;
using bridges::rosbridge::Protocol;
using bridges::rosbridge::Request;

std::shared_ptr<Protocol> make_protocol(bridges::WebServer& server, bool may_control) {
  auto protocol = std::make_shared<Protocol>(
      [&server](std::function<void()> work) { server.run_in_thread(std::move(work)); }, may_control);
  if (server.needs_token_to_read())
    protocol->require_token([&server](std::string_view token) { return server.is_token(token); });
  // Clients of rosbridge offer no subprotocol.
  server.add_protocol("", protocol);
  return protocol;
}

}  // namespace

RosbridgeView::RosbridgeView(bridges::WebServer& server, bool may_control)
    : protocol_(make_protocol(server, may_control)) {}

bool RosbridgeView::take_subscribed() {
  const std::uint64_t now = protocol_->subscriptions();
  return std::exchange(subscriptions_, now) != now;
}

void RosbridgeView::release() {
  constexpr std::chrono::milliseconds interval{33};
  if (protocol_->clients() == 0) return;
  const Clock::time_point now = Clock::now();
  if (now < next_release_) return;
  next_release_ = now + interval;
  protocol_->release();
}

void RosbridgeView::show_commands(const sim::World& world) {
  if (generation_ == world.generation()) return;
  generation_ = world.generation();
  std::vector<CommandTopic> topics;
  for (const auto& vehicle : world.vehicles()) {
    const shoal::sim_vehicle_t message = bridges::vehicle_message(*vehicle);
    auto own = bridges::rosbridge::command_topics(vehicle->name(), message.command_channel, message.command_types,
                                                  shoal::has_unchanged);
    topics.insert(topics.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
  }
  protocol_->set_commands(std::move(topics));
}

void RosbridgeView::serve(const sim::World& world, const experiment::RunPage::Execute& execute,
                          const experiment::RunPage::Publish& publish) {
  show_commands(world);
  // A client that floods the run with requests must not stop the simulation.
  constexpr int max_at_once = 50;
  for (int i = 0; i < max_at_once; ++i) {
    const std::optional<Request> request = protocol_->take_request();
    if (!request) break;
    if (request->kind == Request::Kind::command) {
      if (publish) publish(request->vehicle, request->channel, request->payload);
      continue;
    }
    const experiment::RunPage::Answer answer = execute(request->command, request->value, request->text);
    protocol_->reply(*request, answer.ok, answer.text);
  }
  release();
}

}  // namespace viewer
