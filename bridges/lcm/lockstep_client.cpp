#include "bridges/lcm/lockstep_client.hpp"

#include <unistd.h>

#include <algorithm>
#include <random>

#include "bridges/lcm/resend.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_ack_t.hpp"
#include "shoal/sim_control_reply_t.hpp"
#include "shoal/sim_control_request_t.hpp"
#include "sim/bus/crc32.hpp"
#include "sim/run/lockstep.hpp"

namespace bridges {
namespace {

using std::chrono::milliseconds;

constexpr const char* tick_channel = "sim.tick";
constexpr const char* ack_channel = "sim.ack";
constexpr const char* request_channel = "sim.control";
constexpr const char* reply_channel = "sim.control.reply";
constexpr const char* question_channel = "sim.resend";
constexpr const char* bundle_channel = "sim.resent";
/// The handshake, and what tells of it: no tick names them, and handlers are called when they come.
constexpr std::string_view unnamed_channels[] = {"sim.ack",  "sim.control", "sim.control.reply", "sim.hash", "sim.info",
                                                 "sim.mail", "sim.resend",  "sim.resent",        "sim.tick"};

constexpr milliseconds slice{50};
constexpr std::size_t most_recent = 8192;
constexpr std::size_t most_held = 100'000;
/// What a client waits, at most, for the simulator to let it go.
constexpr milliseconds time_to_leave{1000};

bool is_named(std::string_view channel) {
  return std::find(std::begin(unnamed_channels), std::end(unnamed_channels), channel) == std::end(unnamed_channels);
}

/// Nothing when the payload is not a valid M: anybody may publish anything.
template <class M>
std::optional<M> try_decode(std::span<const std::byte> payload) {
  try {
    return shoal::decode<M>(payload, shoal::Finite::required);
  } catch (const shoal::MessageError&) {
    return std::nullopt;
  }
}

/// Its own at each start, so that nobody takes it for a program that ran before it.
std::int64_t random_session() {
  std::random_device device;
  const std::uint64_t high = device();
  return static_cast<std::int64_t>((high << 30 ^ device()) & 0x1FFFFFFFFFFFFF) + 1;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

}  // namespace

LockstepClient::LockstepClient(const std::string& url, std::string name)
    : lcm_(url), name_(std::move(name)), session_(random_session()) {
  for (const char* channel : {tick_channel, reply_channel, question_channel, bundle_channel}) lcm_.listen(channel);
  // A program that was started again must not take the answer to its predecessor for its own.
  request_id_ = static_cast<std::int32_t>(getpid() % 1'000'000) * 1000;
}

void LockstepClient::subscribe(const std::string& channel, Handler handler) {
  auto& handlers = handlers_[channel];
  const bool own =
      channel == tick_channel || channel == reply_channel || channel == question_channel || channel == bundle_channel;
  // One subscription per channel, or each message would arrive twice.
  if (handlers.empty() && !own) lcm_.listen(channel);
  if (handlers.empty() && is_named(channel)) {
    receives_at_.emplace(channel, receives_.size());
    receives_.push_back({channel, {}});
  }
  handlers.push_back(std::move(handler));
}

void LockstepClient::send(std::string_view channel, std::span<const std::byte> payload) {
  if (!lcm_.publish(channel, payload))
    throw BusError("cannot publish " + std::to_string(payload.size()) + " bytes on '" + std::string(channel) + "'");
}

void LockstepClient::publish(std::string_view channel, std::span<const std::byte> payload) {
  if (!joined_ || !is_named(channel)) return send(channel, payload);
  if (published_.size() + delayed_.size() >= sim::most_named_messages)
    throw BusError("'" + name_ + "' publishes more than " + std::to_string(sim::most_named_messages) +
                   " messages between two ticks");
  Published message{std::string(channel), sim::crc32(payload), sim::Bytes(payload.begin(), payload.end())};
  if (!open_) {
    delayed_.push_back(std::move(message));
    return;
  }
  send(channel, payload);
  published_.push_back(std::move(message));
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
                             Clock::time_point deadline, bool heed_stop) {
  const std::int32_t id = ++request_id_;
  if (command == "join") join_id_ = id;
  answered_id_.reset();
  milliseconds interval = first_resend_interval;
  while (Clock::now() < deadline && !(stop_ && heed_stop)) {
    send_request(command, id, value, text);
    const auto resend = std::min(deadline, Clock::now() + interval);
    interval = next_resend_interval(interval);
    while (auto message = wait(resend, heed_stop)) {
      take(std::move(*message));
      if (answered_id_ != id) continue;
      if (!refusal_.empty()) throw BusError("the simulator refuses '" + name_ + "': " + refusal_);
      return;
    }
  }
  const std::string where = " on " + lcm_.url();
  if (stop_ && heed_stop) throw BusError("'" + name_ + "' was stopped while it waited for a simulator" + where);
  throw BusError("no simulator answered '" + name_ + "' in time" + where + "; is it running, with the same LCM URL?");
}

std::string LockstepClient::terms() const {
  std::string text = "{session: " + std::to_string(session_) + ", receives: [";
  for (const Channel& channel : receives_) text += (&channel == receives_.data() ? "" : ", ") + quoted(channel.name);
  text += "]";
  if (!options_.on_timeout.empty()) text += ", on_timeout: " + quoted(options_.on_timeout);
  if (options_.timeout_s != 0) text += ", timeout_s: " + std::to_string(options_.timeout_s);
  return text + "}";
}

void LockstepClient::ask_to_join(Clock::time_point deadline) {
  const std::size_t told = receives_.size();
  request("join", period_s_, terms(), deadline, true);
  receives_told_ = told;
}

void LockstepClient::join(double period_s, milliseconds timeout, const JoinOptions& options) {
  const bool again = joined_ && end_ != End::dropped;
  if (!again) {
    session_ = random_session();
    sequence_ = 0;
    incomplete_.reset();
    open_ = false;
    published_.clear();
    sent_.clear();
  }
  joined_ = again;
  period_s_ = period_s;
  options_ = options;
  end_ = End::none;
  ask_to_join(Clock::now() + timeout);
  // What came before was not for a member of the lockstep.
  if (!joined_)
    for (Channel& channel : receives_) channel.held.clear();
  joined_ = true;
}

std::optional<Received> LockstepClient::wait(Clock::time_point deadline, bool heed_stop) {
  while (!(stop_ && heed_stop)) {
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

bool LockstepClient::handle_message() {
  const bool forever = silence_limit_.count() == 0;
  const auto message = wait(forever ? Clock::time_point::max() : Clock::now() + silence_limit_);
  if (!message) {
    end_ = stop_ ? End::stopped : End::silence;
    return false;
  }
  call_handlers(message->channel, message->payload);
  return true;
}

void LockstepClient::take(Received message) {
  if (message.channel == tick_channel) take_tick(message.payload);
  if (message.channel == reply_channel) take_reply(message.payload);
  if (message.channel == question_channel) take_question(message.payload);
  if (message.channel == bundle_channel) take_bundle(message.payload);
  const auto named = receives_at_.find(message.channel);
  if (named == receives_at_.end()) return call_handlers(message.channel, message.payload);
  std::deque<Held>& held = receives_[named->second].held;
  held.push_back({sim::crc32(message.payload), std::move(message.payload)});
  if (held.size() > most_held) held.pop_front();  // if a tick names it, it is asked for
}

void LockstepClient::take_reply(std::span<const std::byte> payload) {
  const auto reply = try_decode<shoal::sim_control_reply_t>(payload);
  if (!reply || reply->client != name_) return;
  if (reply->id == request_id_) {
    answered_id_ = reply->id;
    refusal_ = reply->ok != 0 ? "" : reply->text.empty() ? "it does not say why" : reply->text;
  } else if (reply->id != join_id_) {
    return;
  }
  if (joined_ && reply->id == join_id_ && reply->ok == 0) {
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
  if (due == tick->client.end()) {
    // The end of the run concerns all, named or not.
    if (tick->last != 0 && joined_) {
      tick_ = std::move(*tick);
      end_ = End::last_tick;
    }
    return;
  }
  if (due->sequence == sequence_ && !open_ && sequence_ > 0)
    return send_ack();  // our answer was lost, or is on its way
  if (due->sequence <= sequence_ || (incomplete_ && incomplete_->sequence == due->sequence)) return;
  const shoal::sim_due_t own = *due;
  begin_tick(std::move(*tick), own);
}

void LockstepClient::begin_tick(shoal::sim_tick_t tick, const shoal::sim_due_t& due) {
  Incomplete incomplete;
  incomplete.sequence = due.sequence;
  incomplete.ask_at = Clock::now() + resend_grace;
  incomplete.interval = first_resend_interval;
  for (std::size_t i = 0; i < due.channel.size(); ++i) {
    const auto channel = static_cast<std::size_t>(due.channel[i]);
    if (channel >= receives_.size()) return;  // not what we asked for
    incomplete.messages.push_back({channel, static_cast<std::uint32_t>(due.crc[i]), false, {}});
  }
  incomplete.tick = std::move(tick);
  incomplete_ = std::move(incomplete);
}

void LockstepClient::take_question(std::span<const std::byte> payload) {
  const auto question = try_decode<shoal::sim_resend_t>(payload);
  if (!question || question->of_client == 0 || question->client != name_ || question->session != session_) return;
  if (question->sequence != sequence_ || open_ || question->first < 0) return;
  shoal::sim_resent_t head;
  head.utime = tick_.utime;
  head.client = name_;
  head.session = session_;
  head.sequence = sequence_;
  head.of_client = 1;
  send_bundles(
      head, static_cast<std::size_t>(question->first), sent_.size(),
      [this](std::size_t place) {
        return ResentMessage{sent_[place].channel, sent_[place].payload};
      },
      [this](const shoal::sim_resent_t& bundle) { send(bundle_channel, shoal::encode(bundle)); });
}

void LockstepClient::take_bundle(std::span<const std::byte> payload) {
  if (!incomplete_) return;
  const auto bundle = try_decode<shoal::sim_resent_t>(payload);
  if (!bundle || bundle->of_client != 0 || bundle->client != name_ || bundle->session != session_) return;
  if (bundle->sequence != incomplete_->sequence || bundle->first < 0) return;
  for (std::size_t i = 0; i < bundle->message.size(); ++i) {
    const std::size_t place = static_cast<std::size_t>(bundle->first) + i;
    if (place >= incomplete_->messages.size()) return;
    Named& named = incomplete_->messages[place];
    const std::span<const std::byte> bytes = bytes_of(bundle->message[i]);
    if (named.there || sim::crc32(bytes) != named.crc) continue;
    named.payload.assign(bytes.begin(), bytes.end());
    named.there = true;
    ++counts_.asked_for;
  }
}

bool LockstepClient::has_all() {
  bool all = true;
  for (Named& named : incomplete_->messages) {
    if (named.there) continue;
    std::deque<Held>& held = receives_[named.channel].held;
    const auto found = std::find_if(held.begin(), held.end(), [&](const Held& each) { return each.crc == named.crc; });
    if (found == held.end()) {
      all = false;
      continue;
    }
    named.payload = std::move(found->payload);
    named.there = true;
    held.erase(found);
  }
  return all;
}

void LockstepClient::ask_when_due() {
  const auto now = Clock::now();
  if (now < incomplete_->ask_at) return;
  incomplete_->ask_at = now + incomplete_->interval;
  incomplete_->interval = next_resend_interval(incomplete_->interval);
  shoal::sim_resend_t question;
  question.utime = incomplete_->tick.utime;
  question.client = name_;
  question.session = session_;
  question.sequence = incomplete_->sequence;
  question.of_client = 0;
  const auto missing = std::find_if(incomplete_->messages.begin(), incomplete_->messages.end(),
                                    [](const Named& named) { return !named.there; });
  question.first = static_cast<std::int32_t>(missing - incomplete_->messages.begin());
  send(question_channel, shoal::encode(question));
}

void LockstepClient::remember(std::size_t channel, std::uint32_t crc) {
  if (!recent_.insert({channel, crc}).second) return;
  recent_order_.emplace_back(channel, crc);
  if (recent_order_.size() <= most_recent) return;
  recent_.erase(recent_order_.front());
  early_.erase(recent_order_.front());
  recent_order_.pop_front();
}

bool LockstepClient::rewind(const shoal::sim_tick_t& tick) {
  branch_ = tick.branch;
  published_.clear();
  sent_.clear();
  delayed_.clear();
  for (Channel& channel : receives_) channel.held.clear();
  recent_.clear();
  recent_order_.clear();
  early_.clear();
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
  open_ = true;
  if (first) branch_ = tick_.branch;
  if (tick_.branch != branch_ && !rewind(tick_)) {
    // Not handled: after another join() it comes again.
    --sequence_;
    open_ = false;
    return;
  }
  for (Published& message : std::exchange(delayed_, {})) {
    send(message.channel, message.payload);
    published_.push_back(std::move(message));
  }
  for (Named& named : now.messages) {
    // One that was handled before any tick named it.
    if (const auto early = early_.find({named.channel, named.crc}); early != early_.end()) {
      early_.erase(early);
      continue;
    }
    remember(named.channel, named.crc);
    call_handlers(std::string(receives_[named.channel].name), named.payload);
  }
  handle_unnamed();
}

void LockstepClient::handle_unnamed() {
  for (std::size_t i = 0; i < receives_.size(); ++i) {
    std::deque<Held> keep;
    for (Held& held : std::exchange(receives_[i].held, {})) {
      if (recent_.contains({i, held.crc})) {
        ++counts_.repeated;
      } else if (++held.ticks < 3) {
        keep.push_back(std::move(held));
      } else {
        ++counts_.unnamed;
        remember(i, held.crc);
        if (early_.size() < most_recent) early_.insert({i, held.crc});
        call_handlers(std::string(receives_[i].name), held.payload);
      }
    }
    receives_[i].held.swap(keep);
  }
}

bool LockstepClient::next_tick(shoal::sim_tick_t& tick) {
  auto heard = Clock::now();
  while (!stop_ && end_ != End::dropped) {
    if (incomplete_ && has_all()) {
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
    if (incomplete_) ask_when_due();
    const bool forever = silence_limit_.count() == 0;
    auto until = forever ? Clock::time_point::max() : heard + silence_limit_;
    if (incomplete_) until = std::min(until, incomplete_->ask_at);
    if (auto message = wait(until)) {
      heard = Clock::now();
      take(std::move(*message));
    } else if (!stop_ && !forever && Clock::now() >= heard + silence_limit_) {
      end_ = End::silence;
      return false;
    }
  }
  if (end_ != End::dropped) end_ = End::stopped;
  return false;
}

void LockstepClient::acknowledge(const shoal::sim_tick_t&) {
  if (!open_) return;
  // The world waits, so it is the same step in every run from which it knows of new channels.
  if (receives_.size() > receives_told_) ask_to_join(Clock::now() + std::chrono::seconds(30));
  sent_ = std::exchange(published_, {});
  open_ = false;
  send_ack();
}

void LockstepClient::send_ack() {
  shoal::sim_ack_t ack{};
  ack.utime = tick_.utime;
  ack.step = tick_.step;
  ack.client = name_;
  ack.session = session_;
  ack.sequence = sequence_;
  ack.listed = 1;
  ack.count = static_cast<std::int32_t>(sent_.size());
  for (const Published& message : sent_) {
    ack.channel.push_back(message.channel);
    ack.crc.push_back(message.crc);
  }
  send(ack_channel, shoal::encode(ack));
}

void LockstepClient::leave() {
  if (!joined_) return;
  const auto deadline = Clock::now() + time_to_leave;
  if (open_) {
    sent_ = std::exchange(published_, {});
    open_ = false;
    send_ack();
  }
  joined_ = false;
  try {
    const std::string text =
        "{session: " + std::to_string(session_) + ", acknowledged: " + std::to_string(sequence_) + "}";
    request("leave", 0, text, deadline, false);
  } catch (const BusError&) {
    // The world notices when it waits for this client.
  }
}

}  // namespace bridges
