// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep_client/lockstep_client.hpp"

#include <algorithm>
#include <random>
#include <utility>

#include "bridges/lockstep_client/lockstep_terms.hpp"
#include "bridges/lockstep_client/resend.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "shoal/sim_resend_t.hpp"
#include "shoal/sim_resent_t.hpp"

namespace bridges {
namespace {

using std::chrono::milliseconds;

constexpr const char* tick_channel = "sim.tick";
constexpr const char* ack_channel = "sim.ack";
constexpr const char* request_channel = "sim.control";
constexpr const char* reply_channel = "sim.control.reply";
constexpr const char* question_channel = "sim.resend";
constexpr const char* bundle_channel = "sim.resent";
constexpr const char* vehicle_channel = "sim.vehicle";

constexpr milliseconds slice{50};
/// Maximum number of requests of a following program to be notified of the end of the run.
constexpr int max_requests = 20;
/// Maximum wait for the confirmation of a leave.
constexpr milliseconds time_to_leave{1000};
/// Maximum wait for the messages of a last tick: the simulator may have ended, and answers no more.
constexpr milliseconds time_to_end{5000};

/// Decodes a message; none when the payload is not a valid M, which any program may publish.
template <class M>
std::optional<M> try_decode(std::span<const std::byte> payload) {
  try {
    return shoal::decode<M>(payload, shoal::Finite::required);
  } catch (const shoal::MessageError&) {
    return std::nullopt;
  }
}

/// Returns a new random number for each start, so that replies to an earlier instance are recognized as stale.
std::int64_t random_session() {
  std::random_device device;
  const std::uint64_t high = device();
  return static_cast<std::int64_t>((high << 30 ^ device()) & 0x1FFFFFFFFFFFFF) + 1;
}

}  // namespace

LockstepClient::LockstepClient(const std::string& url, std::string name)
    : lcm_(url),
      name_(std::move(name)),
      session_(random_session()),
      outbox_(name_, [this](std::string_view channel, std::span<const std::byte> payload) { send(channel, payload); }) {
  for (const char* channel : {tick_channel, reply_channel, question_channel, bundle_channel}) lcm_.listen(channel);
  if (const auto key = run_key_from_environment()) signer_.emplace(*key, name_);
  // A restarted program must not accept the answer to its predecessor.
  request_id_ = static_cast<std::int32_t>(std::random_device()() >> 2);
}

void LockstepClient::subscribe(const std::string& channel, Handler handler) {
  auto& handlers = handlers_[channel];
  const bool own = channel == tick_channel || channel == reply_channel || channel == question_channel ||
                   channel == bundle_channel || (channel == vehicle_channel && hears_vehicles_);
  // One subscription per channel: otherwise each message would arrive twice.
  if (handlers.empty() && !own) lcm_.listen(channel);
  if (ClientInbox::is_named(channel)) inbox_.add_channel(channel);
  handlers.push_back(std::move(handler));
}

void LockstepClient::send(std::string_view channel, std::span<const std::byte> payload) {
  sim::Bytes signed_payload;
  if (signer_ && is_control_channel(channel)) {
    signed_payload = signer_->sign(channel, payload);
    payload = signed_payload;
  }
  if (!lcm_.publish(channel, payload))
    throw BusError("cannot publish " + std::to_string(payload.size()) + " bytes on '" + std::string(channel) + "'");
}

void LockstepClient::publish(std::string_view channel, std::span<const std::byte> payload) {
  if (joined_ && ClientInbox::is_named(channel))
    outbox_.publish(channel, payload);
  else
    send(channel, payload);
}

void LockstepClient::send_request(const std::string& command, std::int32_t id, double value, const std::string& text) {
  shoal::sim_control_request_t request{};
  request.id = id;
  request.client = name_;
  request.command = command;
  request.value = value;
  request.text = text;
  send(request_channel, shoal::encode(request));
}

void LockstepClient::request(const std::string& command, double value, const std::string& text,
                             Clock::time_point deadline, const std::function<bool()>& is_complete) {
  const std::int32_t id = ++request_id_;
  if (command == "join") join_id_ = id;
  answered_id_.reset();
  milliseconds interval = first_resend_interval;
  // UDP loses messages, so the request is repeated, less and less often, with the same id: a late answer to an
  // earlier copy still counts.
  while (Clock::now() < deadline && !stop_) {
    send_request(command, id, value, text);
    const auto resend = std::min(deadline, Clock::now() + interval);
    interval = next_resend_interval(interval);
    while (auto message = wait(resend)) {
      take(std::move(*message));
      if (answered_id_ != id) continue;
      if (!refusal_.empty()) throw BusError("the simulator rejects '" + name_ + "': " + refusal_);
      if (is_complete()) return;
    }
    if (command == "spawn" && (is_last_tick() || end_ == End::dropped))
      throw BusError("the run of '" + name_ + "' was over before its '" + command + "' was answered");
  }
  const std::string where = " on " + lcm_.url();
  if (stop_) throw BusError("'" + name_ + "' was stopped while it waited for a simulator" + where);
  if (command == "spawn")
    throw BusError("the 'spawn' of '" + name_ + "' was not answered in time" + where +
                   "; the world may wait for another client");
  throw BusError("no simulator answered '" + name_ + "' in time" + where + "; is it running, with the same LCM URL?");
}

void LockstepClient::wait_for(const std::string& what) {
  wait_warning_.emplace("'" + name_ + "' waits for " + what + ", at " + lcm_.url(), warning_after_);
}

bool LockstepClient::await_tick(Clock::time_point deadline) {
  while (!outbox_.is_open() && !incomplete_ && end_ == End::none) {
    auto message = wait(deadline);
    if (!message) return false;
    take(std::move(*message));
  }
  return end_ == End::none;
}

shoal::sim_vehicle_t LockstepClient::spawn(const std::string& text, milliseconds timeout) {
  const auto deadline = Clock::now() + timeout;
  if (!std::exchange(hears_vehicles_, true) && !handlers_.contains(vehicle_channel)) lcm_.listen(vehicle_channel);
  if (!await_tick(deadline) && end_ == End::none && !stop_)
    throw BusError("'" + name_ + "' got no tick on 'sim.tick' in time at " + lcm_.url() +
                   "; a paused run or missing clients may delay it");
  if (end_ != End::none || is_last_tick()) throw BusError("the run of '" + name_ + "' is over");
  spawned_.clear();
  // The report is published before the reply, and both again when the request is repeated.
  const auto name = [this] { return granted_.substr(0, granted_.find(':')); };
  request("spawn", 0, text, deadline, [&] { return spawned_.contains(name()); });
  return spawned_.at(name());
}

void LockstepClient::request_join(Clock::time_point deadline) {
  const std::size_t reported = inbox_.channels().size();
  const sim::LockstepTerms terms{.session = session_,
                                 .receives = inbox_.channels(),
                                 .on_timeout = options_.on_timeout.value_or(sim::OnTimeout::end_run),
                                 .timeout_s = options_.timeout_s,
                                 .agreed = options_.on_timeout.has_value()};
  request("join", period_s_, text_of(terms), deadline);
  channels_reported_ = reported;
}

void LockstepClient::join(double period_s, milliseconds timeout, const JoinOptions& options) {
  const bool again = joined_ && end_ != End::dropped;
  if (!again) {
    session_ = random_session();
    sequence_ = 0;
    incomplete_.reset();
    outbox_.restart();
  }
  joined_ = again;
  following_ = false;
  period_s_ = period_s;
  options_ = options;
  end_ = End::none;
  wait_for("a simulator to answer its join on 'sim.control.reply'");
  request_join(Clock::now() + timeout);
  mark_received();
  // Discard messages from before the join.
  if (!joined_) inbox_.drop_held();
  joined_ = true;
}

std::optional<Received> LockstepClient::wait(Clock::time_point deadline, bool heed_stop) {
  while (!(stop_ && heed_stop)) {
    if (wait_warning_) wait_warning_->look();
    const auto left = std::chrono::ceil<milliseconds>(deadline - Clock::now());
    if (auto message = lcm_.next(std::clamp(left, milliseconds(0), slice))) return message;
    if (Clock::now() >= deadline) break;
  }
  return std::nullopt;
}

void LockstepClient::call_handlers(const std::string& channel, std::span<const std::byte> payload) {
  const auto found = handlers_.find(channel);
  if (found == handlers_.end()) return;
  const std::size_t count = found->second.size();
  for (std::size_t i = 0; i < count; ++i) found->second[i](payload);
}

void LockstepClient::follow() {
  following_ = true;
  end_ = End::none;
  join_id_ = ++request_id_;  // number of the request: follow() replaces join()
  answered_id_.reset();
  requests_left_ = max_requests;
  ask_at_ = Clock::now();
  request_interval_ = first_resend_interval;
}

void LockstepClient::request_end_notification() {
  if (requests_left_ == 0 || answered_id_ == join_id_ || Clock::now() < ask_at_) return;
  --requests_left_;
  ask_at_ = Clock::now() + request_interval_;
  request_interval_ = next_resend_interval(request_interval_);
  send_request("follow", join_id_, 0, text_of(sim::FollowTerms{session_}));
}

bool LockstepClient::handle_message() {
  const bool forever = silence_limit_.count() == 0;
  // Clock::now() + limit would overflow for 'forever'.
  const auto deadline = forever ? Clock::time_point::max() : Clock::now() + silence_limit_;
  while (true) {
    auto until = deadline;
    if (following_) {
      request_end_notification();
      // The request for a notification of the end may be lost on UDP; it is repeated until answered.
      if (requests_left_ > 0 && answered_id_ != join_id_) until = std::min(until, ask_at_);
    }
    const auto message = wait(until);
    if (message) {
      if (following_ && message->channel == reply_channel) take_reply(message->payload);
      if (following_ && message->channel == tick_channel) take_tick(message->payload);
      call_handlers(message->channel, message->payload);
      return end_ != End::last_tick;
    }
    if (!stop_ && Clock::now() < deadline) continue;
    end_ = stop_ ? End::stopped : End::silence;
    return false;
  }
}

void LockstepClient::take(Received message) {
  if (message.channel == tick_channel) take_tick(message.payload);
  if (message.channel == reply_channel) take_reply(message.payload);
  if (message.channel == question_channel) take_request(message.payload);
  if (message.channel == bundle_channel) take_bundle(message.payload);
  if (message.channel == vehicle_channel) take_vehicle(message.payload);
  if (!inbox_.hold(message)) call_handlers(message.channel, message.payload);
}

void LockstepClient::take_vehicle(std::span<const std::byte> payload) {
  constexpr std::size_t max_reports = 1000;  // any program may publish them
  if (!hears_vehicles_ || spawned_.size() >= max_reports) return;
  auto report = try_decode<shoal::sim_vehicle_t>(payload);
  if (report && report->present != 0 && report->client == name_) spawned_[report->vehicle] = std::move(*report);
}

void LockstepClient::take_reply(std::span<const std::byte> payload) {
  const auto reply = try_decode<shoal::sim_control_reply_t>(payload);
  if (!reply || reply->client != name_) return;
  // Another client may have the same name and request number.  The answer to an unreadable request has no session.
  const bool ours = reply->session == session_;
  if (!ours && reply->session != 0) return;
  if (reply->id == request_id_) {
    answered_id_ = reply->id;
    refusal_ = reply->ok != 0 ? "" : reply->text.empty() ? "no reason given" : reply->text;
    granted_ = reply->ok != 0 ? reply->text : "";
  } else if (reply->id != join_id_) {
    return;
  }
  if (ours && joined_ && reply->id == join_id_ && reply->ok == 0) {
    end_ = End::dropped;
    reason_ = reply->text;
  }
}

void LockstepClient::take_tick(std::span<const std::byte> payload) {
  auto tick = try_decode<shoal::sim_tick_t>(payload);
  if (!tick) return;
  const auto due = std::find_if(tick->client.begin(), tick->client.end(), [&](const shoal::sim_due_t& each) {
    return each.name == name_ && each.session == session_;
  });
  if (due == tick->client.end()) return;  // also for a last tick: the end of another run
  if (following_) {
    if (tick->last != 0) end_ = End::last_tick;
    return;
  }
  if (due->sequence == sequence_ && !outbox_.is_open())
    return send_ack();  // the answer was lost or is in transit, or the simulator checks whether this client is alive
  if (due->sequence <= sequence_ || (incomplete_ && incomplete_->sequence == due->sequence)) return;
  const shoal::sim_due_t own = *due;
  start_tick(std::move(*tick), own);
}

void LockstepClient::start_tick(shoal::sim_tick_t tick, const shoal::sim_due_t& due) {
  if (!inbox_.expect(due)) return;  // a list that was not requested
  incomplete_ = {std::move(tick), due.sequence, Clock::now() + resend_grace, first_resend_interval};
}

void LockstepClient::take_request(std::span<const std::byte> payload) {
  const auto question = try_decode<shoal::sim_resend_t>(payload);
  if (!question || question->of_client == 0 || question->client != name_ || question->session != session_) return;
  // An open outbox belongs to the next tick; its messages are not listed yet.
  if (question->sequence != sequence_ || outbox_.is_open()) return;
  shoal::sim_resent_t head{};
  head.utime = tick_.utime;
  head.client = name_;
  head.session = session_;
  head.sequence = sequence_;
  head.of_client = 1;
  asked_ = Clock::now();
  outbox_.send_again(head, question->first,
                     [this](const shoal::sim_resent_t& bundle) { send(bundle_channel, shoal::encode(bundle)); });
}

void LockstepClient::take_bundle(std::span<const std::byte> payload) {
  if (!incomplete_) return;
  const auto bundle = try_decode<shoal::sim_resent_t>(payload);
  if (!bundle || bundle->of_client != 0 || bundle->client != name_ || bundle->session != session_) return;
  if (bundle->sequence == incomplete_->sequence) inbox_.add(bundle->first, bundle->message);
}

void LockstepClient::request_when_due() {
  const auto now = Clock::now();
  // Messages may be late rather than lost: asking at once would load a network that is busy already.
  if (now < incomplete_->ask_at) return;
  incomplete_->ask_at = now + incomplete_->interval;
  incomplete_->interval = next_resend_interval(incomplete_->interval);
  shoal::sim_resend_t question{};
  question.utime = incomplete_->tick.utime;
  question.client = name_;
  question.session = session_;
  question.sequence = incomplete_->sequence;
  question.of_client = 0;
  question.first = inbox_.first_missing();
  send(question_channel, shoal::encode(question));
}

bool LockstepClient::rewind(const shoal::sim_tick_t& tick) {
  branch_ = tick.branch;
  outbox_.clear();
  inbox_.discard();
  if (!rewound_) {
    end_ = End::rewound;
    return false;
  }
  rewound_(tick);
  return true;
}

void LockstepClient::handle_tick() {
  Incomplete now = std::move(*incomplete_);
  incomplete_.reset();
  const bool first = sequence_ == 0;
  sequence_ = now.sequence;
  tick_ = std::move(now.tick);
  outbox_.open();
  if (first) branch_ = tick_.branch;
  if (tick_.branch != branch_ && !rewind(tick_)) {
    // Not handled: it is sent again after another join().
    --sequence_;
    outbox_.close();
    return;
  }
  outbox_.release();
  inbox_.hand_over(
      [this](const std::string& channel, std::span<const std::byte> payload) { call_handlers(channel, payload); });
}

bool LockstepClient::next_tick(shoal::sim_tick_t& tick) {
  auto received = Clock::now();
  if (sequence_ == 0 && !wait_warning_)
    wait_for("its first tick on 'sim.tick' (it has joined; a paused run or missing clients may delay it)");
  while (!stop_ && end_ != End::dropped) {
    // Handle the tick when all its messages have arrived.
    if (incomplete_ && inbox_.complete()) {
      mark_received();
      handle_tick();
      if (end_ == End::rewound) return false;
      tick = tick_;
      if (tick.last == 0) return true;
      acknowledge(tick);
      end_ = End::last_tick;
    }
    if (end_ == End::last_tick) {
      tick = tick_;
      return false;
    }
    // Request missing messages, and wait for the next message.
    if (incomplete_) request_when_due();
    milliseconds limit = silence_limit_;
    if (is_last_tick()) limit = limit.count() == 0 ? time_to_end : std::min(limit, time_to_end);
    const bool forever = limit.count() == 0;
    auto until = forever ? Clock::time_point::max() : received + limit;
    if (incomplete_) until = std::min(until, incomplete_->ask_at);
    if (auto message = wait(until)) {
      // Its own requests for missing messages come back from the network.
      if (message->channel != question_channel) received = Clock::now();
      take(std::move(*message));
    } else if (!stop_ && !forever && Clock::now() >= received + limit) {
      end_ = End::silence;
      return false;
    }
  }
  if (end_ != End::dropped) end_ = End::stopped;
  return false;
}

void LockstepClient::acknowledge(const shoal::sim_tick_t&) {
  if (!outbox_.is_open()) return;
  // The world waits now, so that new channels take effect at the same step in every run.
  if (inbox_.channels().size() > channels_reported_) request_join(Clock::now() + std::chrono::seconds(30));
  outbox_.close();
  send_ack();
}

void LockstepClient::send_ack() {
  shoal::sim_ack_t ack{};
  ack.utime = tick_.utime;
  ack.step = tick_.step;
  ack.client = name_;
  ack.session = session_;
  ack.sequence = sequence_;
  outbox_.name_all(ack);
  send(ack_channel, shoal::encode(ack));
}

void LockstepClient::leave(const std::string& reason) {
  if (!joined_) return;
  request_leave(reason, Clock::now() + time_to_leave);
}

void LockstepClient::leave_at_next_tick(const std::string& reason, milliseconds timeout) {
  if (!joined_) return;
  const auto deadline = Clock::now() + timeout;
  // The request to leave is valid at a tick, so the world must not wait for this one.
  acknowledge(tick_);
  const bool is_awaited = await_tick(deadline);
  if (!is_last_tick()) {
    const auto briefly = Clock::now() + time_to_leave;
    return request_leave(reason, is_awaited ? std::max(deadline, briefly) : briefly);
  }
  tick_ = incomplete_->tick;
  sequence_ = incomplete_->sequence;
  outbox_.open();
  acknowledge(tick_);
  end_ = End::last_tick;
  joined_ = false;
}

void LockstepClient::request_leave(const std::string& reason, Clock::time_point deadline) {
  if (outbox_.is_open()) outbox_.close();
  joined_ = false;
  const auto start = Clock::now();
  const std::int32_t id = ++request_id_;
  answered_id_.reset();
  const std::string text = text_of(sim::LeaveTerms{session_, sequence_, reason});
  // Without back-off, and together with the last answer, which the world waits for and may be lost as well.  While the
  // simulator requests messages, it is not ready to release this client.
  while (Clock::now() < std::max(deadline, std::min(asked_ + time_to_leave, start + 10 * time_to_leave))) {
    if (sequence_ > 0) send_ack();
    send_request("leave", id, 0, text);
    const auto resend = Clock::now() + first_resend_interval;
    while (auto message = wait(resend, false)) {
      take(std::move(*message));
      if (answered_id_ == id) return;  // if it is refused, the world detects it when it waits for this client
    }
  }
}

}  // namespace bridges
