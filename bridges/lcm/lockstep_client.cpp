#include "bridges/lcm/lockstep_client.hpp"

#include <unistd.h>

#include <algorithm>

#include "shoal/message_codec.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"

namespace bridges {
namespace {

using std::chrono::steady_clock;

constexpr const char* tick_channel = "sim.tick";
constexpr const char* ack_channel = "sim.ack";
constexpr const char* request_channel = "sim.control";
constexpr const char* reply_channel = "sim.control.reply";
constexpr std::chrono::milliseconds resend_after{200};
constexpr std::chrono::milliseconds slice{50};

/// Nothing when the payload is not a valid M: anybody may publish anything.
template <class M>
std::optional<M> try_decode(std::span<const std::byte> payload) {
  try {
    return shoal::decode<M>(payload, shoal::Finite::required);
  } catch (const shoal::MessageError&) {
    return std::nullopt;
  }
}

}  // namespace

LockstepClient::LockstepClient(const std::string& url, std::string name) : lcm_(url), name_(std::move(name)) {
  lcm_.listen(tick_channel);
  lcm_.listen(reply_channel);
  // A program that was started again must not take the answer to its predecessor for its own.
  request_id_ = static_cast<std::int32_t>(getpid() % 1'000'000) * 1000;
}

void LockstepClient::subscribe(const std::string& channel, Handler handler) {
  auto& handlers = handlers_[channel];
  // One subscription per channel, or each message would arrive twice.
  if (handlers.empty() && channel != tick_channel && channel != reply_channel) lcm_.listen(channel);
  handlers.push_back(std::move(handler));
}

void LockstepClient::publish(std::string_view channel, std::span<const std::byte> payload) {
  if (!lcm_.publish(channel, payload))
    throw BusError("cannot publish " + std::to_string(payload.size()) + " bytes on '" + std::string(channel) + "'");
}

void LockstepClient::request(const std::string& command, std::int32_t id, double value) {
  shoal::sim_control_request_t request{};
  request.id = id;
  request.client = name_;
  request.command = command;
  request.value = value;
  publish(request_channel, shoal::encode(request));
}

void LockstepClient::join(double period_s, std::chrono::milliseconds timeout) {
  const std::int32_t id = ++request_id_;
  const auto deadline = steady_clock::now() + timeout;
  while (steady_clock::now() < deadline && !stop_) {
    request("join", id, period_s);
    const auto resend = std::min(deadline, steady_clock::now() + resend_after);
    while (auto message = wait(resend)) {
      if (message->channel == reply_channel) {
        const auto reply = try_decode<shoal::sim_control_reply_t>(message->payload);
        if (reply && reply->id == id && reply->client == name_) {
          if (reply->ok == 0) throw BusError("the simulator refuses '" + name_ + "': " + reply->text);
          return;
        }
      }
      early_.push_back(std::move(*message));
    }
  }
  if (stop_) throw BusError("'" + name_ + "' was stopped while it waited for a simulator on " + lcm_.url());
  throw BusError("no simulator answered '" + name_ + "' within " + std::to_string(timeout.count()) + " ms on " +
                 lcm_.url() + "; is it running, with the same LCM URL?");
}

std::optional<Received> LockstepClient::wait(steady_clock::time_point deadline) {
  while (!stop_) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - steady_clock::now());
    if (auto message = lcm_.next(std::clamp(left, std::chrono::milliseconds(0), slice))) return message;
    if (steady_clock::now() >= deadline) break;
  }
  return std::nullopt;
}

std::optional<Received> LockstepClient::next_handled() {
  std::optional<Received> message;
  if (!early_.empty() && !stop_) {
    message = std::move(early_.front());
    early_.pop_front();
  } else {
    const bool forever = silence_limit_.count() == 0;
    message = wait(forever ? steady_clock::time_point::max() : steady_clock::now() + silence_limit_);
  }
  if (!message) {
    end_ = stop_ ? End::stopped : End::silence;
    return std::nullopt;
  }
  if (const auto found = handlers_.find(message->channel); found != handlers_.end()) {
    const std::size_t count = found->second.size();
    for (std::size_t i = 0; i < count; ++i) found->second[i](message->payload);
  }
  return message;
}

bool LockstepClient::next_tick(shoal::sim_tick_t& tick) {
  while (true) {
    const std::optional<Received> message = next_handled();
    if (!message) return false;
    if (message->channel != tick_channel) continue;
    auto received = as_new_tick(*message);
    if (!received) continue;
    tick = std::move(*received);
    if (tick.last == 0) return true;
    acknowledge(tick);
    end_ = End::last_tick;
    return false;
  }
}

std::optional<shoal::sim_tick_t> LockstepClient::as_new_tick(const Received& message) {
  auto tick = try_decode<shoal::sim_tick_t>(message.payload);
  if (!tick) return std::nullopt;
  // The end of the run concerns all, named or not, and may come at a step that was already acknowledged.
  if (tick->last != 0) return tick;
  if (std::find(tick->client.begin(), tick->client.end(), name_) == tick->client.end()) return std::nullopt;
  if (acknowledged_utime_ == tick->utime) {
    acknowledge(*tick);  // the simulator asks again: our answer was lost, or crossed with the question
    return std::nullopt;
  }
  return tick;
}

void LockstepClient::acknowledge(const shoal::sim_tick_t& tick) {
  shoal::sim_ack_t ack{};
  ack.utime = tick.utime;
  ack.step = tick.step;
  ack.client = name_;
  publish(ack_channel, shoal::encode(ack));
  acknowledged_utime_ = tick.utime;
}

void LockstepClient::leave() {
  request("leave", ++request_id_, 0);
}

}  // namespace bridges
