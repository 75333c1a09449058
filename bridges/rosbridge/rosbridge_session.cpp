// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/rosbridge/rosbridge_session.hpp"

#include <algorithm>
#include <utility>

#include "bridges/base/json_text.hpp"
#include "bridges/foxglove/foxglove_services.hpp"
#include "bridges/rosbridge/rosbridge_command.hpp"
#include "bridges/web/web_error.hpp"

namespace bridges::rosbridge {
namespace {

constexpr std::string_view control_is_off = "control is off: start Shoal with --rosbridge-control";
/// Overhead of a message besides its payload.
constexpr std::size_t message_bytes = 100;

/// `type`: demanded by a client; empty: any.
void require_type(const ros2::Topic& topic, const std::string& type) {
  if (!type.empty() && type != short_name(topic.type))
    throw WebError("subscribe " + topic.name + ": its type is " + topic.type + ", not " + type);
}

}  // namespace

Session::~Session() {
  while (!subscriptions_.empty()) end(subscriptions_.begin());
  protocol_.left(*this);
}

// --- From the client

void Session::receive(std::string_view bytes, bool is_text) {
  std::string id;
  try {
    if (!is_text) throw WebError("binary messages are not supported: send JSON");
    const ClientMessage message = parse_message(bytes);
    id = message.id;
    carry_out(message);
  } catch (const WebError& error) {
    report(Level::error, error.what(), id);
  }
  link_.wake();
}

void Session::carry_out(const ClientMessage& message) {
  if (message.op == "subscribe") return subscribe(message);
  if (message.op == "unsubscribe") return unsubscribe(message);
  if (message.op == "publish") return publish(message);
  if (message.op == "call_service") return call(message);
  if (message.op == "advertise") return advertise(message);
  if (message.op == "unadvertise") {
    advertised_.erase(message.topic);
  } else if (message.op == "set_level") {
    level_ = message.level;
  } else if (message.op != "status") {
    throw WebError("'" + message.op + "' is not supported");
  }
}

void Session::subscribe(const ClientMessage& message) {
  if (terms_ >= Protocol::max_subscriptions)
    throw WebError("subscribe: a client has at most " + std::to_string(Protocol::max_subscriptions) + " subscriptions");
  if (message.compression != "none")
    report(Level::warning,
           "subscribe " + message.topic + ": compression '" + message.compression +
               "' is not supported; the messages come as JSON",
           message.id);
  const auto& topics = protocol_.topics_.topics();
  const auto topic =
      std::find_if(topics.begin(), topics.end(), [&](const ros2::Topic& each) { return each.name == message.topic; });
  if (topic != topics.end()) require_type(*topic, message.type);
  const auto known = subscriptions_.try_emplace(message.topic).first;
  Subscription& subscription = known->second;
  if (!message.type.empty()) subscription.type = message.type;
  terms_ -= subscription.terms.size();
  subscription.terms.insert_or_assign(message.id,
                                      Terms{std::chrono::milliseconds(message.throttle_rate_ms), message.queue_length});
  terms_ += subscription.terms.size();
  set_terms(subscription);
  if (!subscription.bound && topic != topics.end()) bind(known, topic->number);
}

void Session::unsubscribe(const ClientMessage& message) {
  const auto known = subscriptions_.find(message.topic);
  // Without an id all of the topic end
  if (known == subscriptions_.end() || (!message.id.empty() && known->second.terms.erase(message.id) == 0))
    throw WebError("unsubscribe: there is no such subscription of " + message.topic);
  if (!message.id.empty()) --terms_;
  if (message.id.empty() || known->second.terms.empty()) return end(known);
  set_terms(known->second);
}

void Session::end(Subscriptions::iterator subscription) {
  if (!subscription->second.held.empty()) --protocol_.held_;
  terms_ -= subscription->second.terms.size();
  if (subscription->second.bound) {
    by_topic_.erase(subscription->second.topic);
    protocol_.count_subscription(subscription->second.topic, -1);
  }
  subscriptions_.erase(subscription);
}

void Session::set_terms(Subscription& subscription) {
  const auto& all = subscription.terms;
  subscription.effective = all.begin()->second;
  for (const auto& [id, terms] : all) {
    subscription.effective.throttle = std::min(subscription.effective.throttle, terms.throttle);
    subscription.effective.queue_length = std::min(subscription.effective.queue_length, terms.queue_length);
  }
}

void Session::bind(Subscriptions::iterator known, std::size_t topic) {
  Subscription& subscription = known->second;
  const ros2::Topic& found = protocol_.topics_.topics()[topic];
  if (found.encoding != "cdr") return;
  try {
    require_type(found, subscription.type);
  } catch (const WebError& error) {
    report(Level::error, error.what());
    return end(known);
  }
  subscription.bound = true;
  subscription.topic = topic;
  by_topic_.emplace(topic, &subscription);
  protocol_.count_subscription(topic, 1);
  if (found.latched) protocol_.topics_.send_latched(*this, topic);
}

void Session::bind_new_topics() {
  for (; bound_ < protocol_.topics_.topics().size(); ++bound_) {
    const auto waiting = subscriptions_.find(protocol_.topics_.topics()[bound_].name);
    if (waiting != subscriptions_.end() && !waiting->second.bound) bind(waiting, bound_);
  }
}

void Session::require_control() const {
  if (!protocol_.may_control_) throw WebError(std::string(control_is_off));
}

const CommandTopic& Session::command_topic(const std::string& topic) const {
  const auto found = protocol_.commands_.find(topic);
  if (found == protocol_.commands_.end())
    throw WebError(topic + ": nothing takes messages there; /rosapi/node_details of /shoal lists what does");
  return found->second;
}

void Session::advertise(const ClientMessage& message) {
  require_control();
  command_type_of(command_topic(message.topic), message.type);
  if (advertised_.size() >= Protocol::max_advertised && !advertised_.contains(message.topic))
    throw WebError("advertise: a client has at most " + std::to_string(Protocol::max_advertised) + " topics");
  advertised_.insert_or_assign(message.topic, message.type);
}

void Session::publish(const ClientMessage& message) {
  require_control();
  const CommandTopic& topic = command_topic(message.topic);
  const auto advertised = advertised_.find(message.topic);
  const CommandTopic::Type& type = command_type_of(topic, advertised == advertised_.end() ? "" : advertised->second);
  Request request;
  request.client = link_.number();
  request.kind = Request::Kind::command;
  request.vehicle = topic.vehicle;
  request.channel = topic.channel;
  request.payload = command_payload(protocol_.command_type(type), type, message.msg);
  if (!protocol_.exchange_.add_request(std::move(request)))
    throw WebError("publish " + message.topic + ": too many messages of this client are waiting");
}

void Session::call(const ClientMessage& message) {
  const auto respond = [&](bool ok, nlohmann::json values) {
    answer(service_response_text(message.service, message.id, ok, std::move(values)));
  };
  try {
    if (!is_rosapi(message.service)) return call_run(message);
    respond(true, answer_rosapi(protocol_.graph(), message.service, message.args));
  } catch (const WebError& error) {
    respond(false, error.what());
  }
}

/// Passes a service of the run on.  The answer comes later, from the thread that simulates.
void Session::call_run(const ClientMessage& message) {
  const auto services = foxglove::services();
  const auto service = std::find_if(services.begin(), services.end(),
                                    [&](const foxglove::Service& each) { return each.name == message.service; });
  if (service == services.end()) throw WebError("there is no service " + message.service);
  require_control();
  nlohmann::json args = message.args;
  if (args.is_array()) args = {{std::string(service->member), args.empty() ? nlohmann::json() : args.front()}};
  foxglove::ServiceArgument argument = foxglove::read_request(*service, "json", json_text(args));
  Request request;
  request.client = link_.number();
  request.command = service->command;
  request.value = argument.value;
  request.text = std::move(argument.text);
  request.service = message.service;
  request.id = message.id;
  if (!protocol_.exchange_.add_request(std::move(request)))
    throw WebError("too many requests of this client are waiting");
}

// --- To the client

void Session::answer(std::string text) {
  if (closing_) return;
  if (answers_.size() >= Protocol::max_waiting_texts || answers_.bytes() > Protocol::max_queued_bytes) {
    closing_ = true;
    answers_.clear();
    return link_.close(WebClose::policy, "answers are not read");
  }
  const std::size_t bytes = text.size();
  answers_.push(std::move(text), bytes);
}

void Session::report(Level level, std::string_view text, std::string_view id) {
  if (level_ != Level::none && level <= level_) answer(status_text(level, text, id));
}

void Session::push(const ros2::Topic& topic, const ros2::ChannelMessage& /*from*/, const Bytes& cdr) {
  Subscription& subscription = *by_topic_.at(topic.number);
  const Terms& terms = subscription.effective;
  if (terms.throttle.count() == 0) return queue(subscription, cdr);
  const Clock::time_point now = Clock::now();
  if (subscription.held.empty() && now >= subscription.due) {
    subscription.due = now + terms.throttle;
    return queue(subscription, cdr);
  }
  // Without a queue, messages in between are not sent; that is what was asked for
  if (terms.queue_length == 0) return;
  if (subscription.held.empty()) ++protocol_.held_;
  subscription.held.push_back(cdr);
  while (subscription.held.size() > terms.queue_length) subscription.held.pop_front();
}

void Session::queue(Subscription& subscription, const Bytes& cdr) {
  const std::size_t length = subscription.effective.queue_length;
  if (length > 0 && subscription.waiting >= length) {
    data_.remove([&](const Data& data) { return data.topic == subscription.topic; });
    --subscription.waiting;
  }
  const std::size_t bytes = cdr->size() + message_bytes;
  while (!data_.empty() &&
         (data_.size() >= Protocol::max_queued_messages || data_.bytes() + bytes > Protocol::max_queued_bytes)) {
    take_first();
    count_dropped(1);
  }
  data_.push({subscription.topic, cdr}, bytes);
  ++subscription.waiting;
}

Session::Data Session::take_first() {
  Data data = data_.pop();
  if (const auto of = by_topic_.find(data.topic); of != by_topic_.end() && of->second->waiting > 0)
    --of->second->waiting;
  return data;
}

void Session::release_due() {
  if (protocol_.held_.load() == 0) return;
  const Clock::time_point now = Clock::now();
  for (auto& [name, subscription] : subscriptions_) {
    if (subscription.held.empty() || now < subscription.due) continue;
    subscription.due = now + subscription.effective.throttle;
    queue(subscription, subscription.held.front());
    subscription.held.pop_front();
    if (subscription.held.empty()) --protocol_.held_;
  }
}

void Session::count_dropped(std::uint64_t count) {
  dropped_ += count;
  if (count > 0) protocol_.warn_of_drops();
}

bool Session::next(WebFrame& frame) {
  if (!answers_.empty()) {
    frame = {std::make_shared<const std::string>(answers_.pop()), true};
    return true;
  }
  if (std::string text = next_drop_report(); !text.empty()) {
    frame = {std::make_shared<const std::string>(std::move(text)), true};
    return true;
  }
  release_due();
  while (!data_.empty()) {
    const Data data = take_first();
    if (!by_topic_.contains(data.topic)) continue;
    frame = {protocol_.publish_text(data.topic, data.cdr), true};
    return true;
  }
  return false;
}

std::string Session::next_drop_report() {
  constexpr std::chrono::seconds interval{2};
  if (dropped_ == 0 || level_ == Level::none || level_ < Level::warning) return "";
  const Clock::time_point now = Clock::now();
  if (now < next_drop_report_) return "";
  next_drop_report_ = now + interval;
  return status_text(Level::warning,
                     std::to_string(std::exchange(dropped_, 0)) +
                         " messages were dropped, because they come faster than this client reads them");
}

}  // namespace bridges::rosbridge
