// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/door/ros2_lockstep.hpp"

#include <utility>

namespace bridges::ros2 {
namespace {

using namespace std::chrono_literals;

/// stop() does not notify under the lock, so that a signal may lead to it: waits look again.
constexpr auto slice = 100ms;
/// Patience before a warning names what the world waits for.
constexpr auto patience = 3s;

}  // namespace

Ros2Lockstep::Ros2Lockstep(const std::string& lcm_url, const Options& options, Links links)
    : options_(options), links_(std::move(links)), client_(lcm_url, options.name), exchange_(options.nodes) {
  client_.set_silence_limit(0ms);
  client_.on_rewind([](const shoal::sim_tick_t&) {});  // nodes see the branch
  for (const std::string_view channel : world_channels) subscribe(std::string(channel));
}

void Ros2Lockstep::subscribe(const std::string& channel) {
  if (!subscribed_.insert(channel).second) return;
  client_.subscribe(channel, [this, channel](std::span<const std::byte> payload) { links_.pass(channel, payload); });
}

void Ros2Lockstep::run() {
  client_.join(options_.period_s, options_.join_timeout);
  shoal::sim_tick_t tick{};
  while (client_.next_tick(tick)) {
    if (!subscribe_to_reports()) break;
    tell(tick);
    const auto commands = await_commands();
    if (!commands) break;
    for (const TickExchange::Command& command : *commands) client_.publish(command.channel, command.payload);
    client_.acknowledge(tick);
  }
  if (client_.end() == LockstepClient::End::last_tick) return tell(tick);
  if (client_.end() == LockstepClient::End::dropped) throw BusError(client_.reason());
  client_.leave("shoal-ros2 was stopped");
}

void Ros2Lockstep::stop() {
  stopped_ = true;
  client_.stop();
}

/// The world waits meanwhile, so that new vehicles are received from the same step on in every run.
bool Ros2Lockstep::subscribe_to_reports() {
  std::optional<std::set<std::string>> channels;
  while (!stopped_ && !(channels = links_.channels())) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, slice);
  }
  if (channels)
    for (const std::string& channel : *channels) subscribe(channel);
  return channels.has_value();
}

std::optional<std::vector<TickExchange::Command>> Ros2Lockstep::await_commands() {
  bool has_warned = false;
  const auto warn_at = std::chrono::steady_clock::now() + patience;
  std::unique_lock lock(mutex_);
  for (std::string missing; !stopped_ && !(missing = exchange_.missing()).empty(); changed_.wait_for(lock, slice)) {
    if (has_warned || std::chrono::steady_clock::now() < warn_at) continue;
    has_warned = true;
    links_.warn("the world waits for " + missing);
  }
  if (!exchange_.contested().empty() && !std::exchange(was_contested_, true))
    links_.warn("two nodes send to " + exchange_.contested() + " in one tick, in no defined order");
  if (stopped_) return std::nullopt;
  return exchange_.finish();
}

void Ros2Lockstep::tell(const shoal::sim_tick_t& tick) {
  Tick told;
  {
    const std::scoped_lock lock(mutex_);
    told = exchange_.begin(tick.utime, tick.step, tick.branch, tick.last != 0);
  }
  links_.tell(told);
}

void Ros2Lockstep::count(const std::string& topic, std::uint32_t depth) {
  const std::scoped_lock lock(mutex_);
  exchange_.count(topic, depth);
}

void Ros2Lockstep::add(const std::string& topic, std::optional<TickExchange::Command> command) {
  const std::scoped_lock lock(mutex_);
  if (!exchange_.add(topic, std::move(command)) && !std::exchange(was_full_, true))
    links_.warn(topic + ": a tick has at most " + std::to_string(TickExchange::max_commands) +
                " commands; further ones are lost");
  changed_.notify_all();
}

void Ros2Lockstep::take(const Tick& answer) {
  const std::scoped_lock lock(mutex_);
  exchange_.take(answer);
  changed_.notify_all();
}

}  // namespace bridges::ros2
