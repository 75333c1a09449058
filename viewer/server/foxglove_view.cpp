// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/foxglove_view.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

namespace viewer {

namespace {

constexpr std::chrono::milliseconds time_interval{33}, state_interval{200};

/// Another one for each start of a server: viewers then forget what they had from the one before.
std::string session_name() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return fmt::format("{:x}-{:x}", std::chrono::duration_cast<std::chrono::microseconds>(now).count(), getpid());
}

std::shared_ptr<bridges::foxglove::Protocol> make_protocol(bridges::WebServer& server) {
  auto protocol = std::make_shared<bridges::foxglove::Protocol>(
      [&server](std::function<void()> work) { server.run_in_thread(std::move(work)); });
  if (server.needs_token_to_read())
    protocol->require_token([&server](std::string_view token) { return server.is_token(token); });
  // If a client offers both, the newer name.
  for (const char* name : {"foxglove.sdk.v1", "foxglove.websocket.v1"}) server.add_protocol(name, protocol);
  return protocol;
}

}  // namespace

FoxgloveView::FoxgloveView(bridges::WebServer& server) : protocol_(make_protocol(server)) {}

void FoxgloveView::introduce(const std::string& name, const std::string& version, bridges::foxglove::Control control,
                             std::int64_t start_us, std::int64_t end_us) {
  protocol_->introduce({"Shoal: " + name, session_name(), {{"shoal", version}}, control, start_us, end_us});
}

void FoxgloveView::show_time(std::int64_t utime) {
  if (clients() == 0) return;
  const Clock::time_point now = Clock::now();
  if (now < next_time_) return;
  next_time_ = now + time_interval;
  protocol_->show_time(utime);
}

bool FoxgloveView::take_subscribed() {
  const std::uint64_t now = protocol_->subscriptions();
  return std::exchange(subscriptions_, now) != now;
}

void FoxgloveView::serve(const std::function<State()>& state, const std::function<Answer(const Request&)>& execute) {
  // A client that floods the run with requests must not stop the simulation.
  constexpr int max_at_once = 50;
  for (int i = 0; i < max_at_once; ++i) {
    const auto request = protocol_->take_request();
    if (!request) break;
    auto [ok, text] = execute(*request);
    // The state first, so that the client sees its effect before the reply.
    protocol_->set_state(state());
    protocol_->reply(*request, ok, std::move(text));
  }
  if (clients() == 0) return;
  const Clock::time_point now = Clock::now();
  if (now < next_state_) return;
  next_state_ = now + state_interval;
  protocol_->set_state(state());
}

}  // namespace viewer
