// SPDX-License-Identifier: BSD-3-Clause
#include "shoal/client.hpp"

#include <cmath>
#include <iostream>

#include "bridges/base/bus_error.hpp"
#include "bridges/lockstep_client/lockstep_client.hpp"
#include "bridges/lockstep_client/lockstep_terms.hpp"
#include "shoal/sim_vehicle_t.hpp"
#include "shoal/utime_t.hpp"

namespace shoal {

struct Client::Connection {
  Connection(const std::string& client, const std::string& url) : name(client), lcm(url, client) {
    lcm.set_silence_limit(std::chrono::minutes(10));
  }

  void follow_clock(std::int64_t new_period_us);
  std::optional<std::int64_t> next_joined_tick();
  std::optional<std::int64_t> next_free_tick();

  std::string name;
  bridges::LockstepClient lcm;
  Counts counts;
  bool joined = false;
  std::optional<shoal::sim_tick_t> unanswered;
  std::int64_t period_us = 0;  ///< period without lockstep; 0: in lockstep
  std::optional<std::int64_t> clock_utime;
  std::optional<std::int64_t> due_utime;
  End end = End::none;
  std::string reason_to_leave;
};

namespace {

/// Converts errors to ClientError, the only error type of the public library.
template <class Work>
auto with_own_errors(const Work& work) {
  try {
    return work();
  } catch (const bridges::BusError& error) {
    throw ClientError(error.what());
  }
}

Client::End end_of(bridges::LockstepClient::End end) {
  switch (end) {
    case bridges::LockstepClient::End::none:
      return Client::End::none;
    case bridges::LockstepClient::End::last_tick:
      return Client::End::last_tick;
    case bridges::LockstepClient::End::stopped:
      return Client::End::stopped;
    case bridges::LockstepClient::End::rewound:
      return Client::End::rewound;
    case bridges::LockstepClient::End::dropped:
      return Client::End::dropped;
    case bridges::LockstepClient::End::silence:
      break;
  }
  return Client::End::silence;
}

}  // namespace

Client::Client(const std::string& name, const std::string& lcm_url)
    : connection_(with_own_errors([&] { return std::make_unique<Connection>(name, lcm_url); })) {}

Client::~Client() {
  if (!connection_->joined || connection_->end == End::last_tick || connection_->end == End::dropped) return;
  try {
    connection_->lcm.leave(connection_->reason_to_leave);
  } catch (const std::exception&) {
    // The world detects this after lockstep.timeout_s.
  }
}

void Client::set_reason_to_leave(const std::string& reason) {
  connection_->reason_to_leave = reason;
}

void Client::subscribe_bytes(const std::string& channel, BytesHandler handler) {
  Counts& counts = connection_->counts;
  with_own_errors([&] {
    connection_->lcm.subscribe(channel, [&counts, channel, handler = std::move(handler),
                                         reported = false](std::span<const std::byte> payload) mutable {
      ++counts.received;
      try {
        handler(payload);
      } catch (const MessageError& error) {
        ++counts.bad;
        // A sender of another version would fill the terminal with one line per message.
        if (!reported) std::cerr << channel << ": " << error.what() << " (ignored; further ones are only counted)\n";
        reported = true;
      }
    });
  });
}

void Client::publish_bytes(std::string_view channel, std::span<const std::byte> payload) {
  with_own_errors([&] { connection_->lcm.publish(channel, payload); });
  ++connection_->counts.published;
}

void Client::join(double period_s, std::chrono::milliseconds timeout) {
  JoinOptions options;
  options.timeout = timeout;
  join(period_s, options);
}

void Client::join(double period_s, const JoinOptions& options) {
  with_own_errors([&] {
    connection_->lcm.join(period_s, options.timeout, {bridges::on_timeout_of(options.on_timeout), options.timeout_s});
  });
  connection_->end = End::none;
  connection_->joined = true;  // an open tick remains open, in the same session
}

void Client::follow(double period_s) {
  if (!(period_s >= 1e-6) || !(period_s < 1e9)) throw ClientError("the period must be 1e-6 to 1e9 s");
  with_own_errors([&] { connection_->follow_clock(std::llround(period_s * 1e6)); });
}

void Client::Connection::follow_clock(std::int64_t new_period_us) {
  if (period_us == 0)
    lcm.subscribe("sim.clock", [this](std::span<const std::byte> payload) {
      try {
        const std::int64_t utime = shoal::decode<shoal::utime_t>(payload, Finite::any).utime;
        // Ignore the clock of another run, or of one that was rewound: only the followed run itself can announce its
        // end.
        if (!clock_utime || utime < *clock_utime) lcm.follow();
        clock_utime = utime;
      } catch (const MessageError&) {
        // Ignore invalid messages, which any program may publish.
      }
    });
  period_us = new_period_us;
  due_utime.reset();
}

void Client::handle_in_batches(std::function<void()> after_batch) {
  connection_->lcm.take_in_batches(std::move(after_batch));
}

std::optional<std::int64_t> Client::next_tick() {
  // After silence another client may still arrive.
  if (connection_->end != End::none && connection_->end != End::silence) return std::nullopt;
  if (connection_->joined) return with_own_errors([&] { return connection_->next_joined_tick(); });
  if (connection_->period_us == 0) throw std::logic_error("shoal::Client: join() or follow() comes before next_tick()");
  return with_own_errors([&] { return connection_->next_free_tick(); });
}

std::optional<std::int64_t> Client::Connection::next_joined_tick() {
  if (unanswered) lcm.acknowledge(*unanswered);
  unanswered.reset();
  shoal::sim_tick_t tick{};
  if (!lcm.next_tick(tick)) {
    end = end_of(lcm.end());
    return std::nullopt;
  }
  unanswered = tick;
  return tick.utime;
}

std::optional<std::int64_t> Client::Connection::next_free_tick() {
  const std::optional<std::int64_t> before = clock_utime;
  if (!clock_utime) lcm.wait_for("the time on 'sim.clock', which a simulator publishes during its run");
  while (true) {
    if (!lcm.handle_message()) {
      end = end_of(lcm.end());
      return std::nullopt;
    }
    if (!clock_utime) continue;
    lcm.mark_received();
    // A clock with an earlier time belongs to a new run.
    if (!due_utime || (before && *clock_utime < *before)) due_utime = *clock_utime;
    if (*clock_utime < *due_utime) continue;
    due_utime = (*clock_utime / period_us + 1) * period_us;
    return clock_utime;
  }
}

std::optional<std::int64_t> Client::wait_until(std::int64_t utime) {
  auto now = next_tick();
  while (now && *now < utime) now = next_tick();
  return now;
}

std::map<std::string, DeviceChannels> Client::spawn(const std::string& text, std::chrono::milliseconds timeout) {
  if (!connection_->joined) throw std::logic_error("shoal::Client: join() comes before spawn()");
  const shoal::sim_vehicle_t vehicle = with_own_errors([&] { return connection_->lcm.spawn(text, timeout); });
  std::map<std::string, DeviceChannels> channels;
  for (std::size_t i = 0; i < vehicle.device.size(); ++i)
    channels[vehicle.device[i]] = {vehicle.device_type[i], vehicle.report_channel[i],  vehicle.report_type[i],
                                   vehicle.rate_hz[i],     vehicle.command_channel[i], vehicle.command_types[i]};
  return channels;
}

void Client::leave(std::chrono::milliseconds timeout) {
  if (!connection_->joined || connection_->end == End::last_tick || connection_->end == End::dropped) return;
  with_own_errors([&] { connection_->lcm.leave_at_next_tick(connection_->reason_to_leave, timeout); });
  connection_->unanswered.reset();
  connection_->joined = false;
  const bool is_over = connection_->lcm.end() == bridges::LockstepClient::End::last_tick;
  connection_->end = is_over ? End::last_tick : End::left;
}

void Client::stop() noexcept {
  connection_->lcm.stop();
}

Client::End Client::end() const {
  return connection_->end;
}

void Client::set_silence_limit(std::chrono::milliseconds limit) {
  connection_->lcm.set_silence_limit(limit);
}

void Client::set_wait_warning(std::chrono::milliseconds after) {
  connection_->lcm.set_warning_after(after);
}

const std::string& Client::reason() const {
  return connection_->lcm.reason();
}

void Client::on_rewind(std::function<void(std::int64_t utime)> handler) {
  connection_->lcm.on_rewind([handler = std::move(handler)](const shoal::sim_tick_t& tick) { handler(tick.utime); });
}

std::int32_t Client::branch() const {
  return connection_->lcm.branch();
}

Client::Counts Client::counts() const {
  Counts counts = connection_->counts;
  counts.requested = connection_->lcm.counts().requested;
  counts.repeated = connection_->lcm.counts().repeated;
  return counts;
}

}  // namespace shoal
