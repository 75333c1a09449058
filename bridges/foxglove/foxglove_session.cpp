// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/foxglove/foxglove_session.hpp"

#include <algorithm>
#include <utility>

#include "bridges/foxglove/foxglove_services.hpp"
#include "bridges/web/web_error.hpp"

namespace bridges::foxglove {
namespace {

constexpr std::string_view control_is_off = "control is off: start Shoal with --foxglove-control";
/// Overhead of a message besides its payload.
constexpr std::size_t message_bytes = 100;

}  // namespace

Session::~Session() {
  for (const auto& [id, topic] : topic_of_) protocol_.count_subscription(topic, -1);
  protocol_.left(*this);
}

// --- From the client

void Session::receive(std::string_view bytes, bool is_text) {
  try {
    if (is_text)
      receive_text(bytes);
    else
      receive_binary(bytes);
  } catch (const WebError& error) {
    report(StatusLevel::error, error.what());
  }
  link_.wake();
}

void Session::receive_text(std::string_view bytes) {
  const ClientText message = parse_text(bytes);
  if (message.op == "subscribe") {
    for (const Subscription& each : message.subscriptions) subscribe(each);
  } else if (message.op == "unsubscribe") {
    for (const std::uint32_t id : message.subscription_ids) unsubscribe(id);
  } else if (message.op == "getParameters" && may(Control::run)) {
    answer(parameters_text(protocol_.state_, message.names, message.id));
  } else if (message.op == "setParameters" && may(Control::run)) {
    set_parameters(message);
  } else if (message.op == "subscribeParameterUpdates" && may(Control::run)) {
    gets_parameters_ = true;
    parameters_.insert(message.names.begin(), message.names.end());
  } else if (message.op == "unsubscribeParameterUpdates" && may(Control::run)) {
    for (const std::string& name : message.names) parameters_.erase(name);
    // An empty list unsubscribes from all parameters.
    gets_parameters_ = !parameters_.empty() && !message.names.empty();
  } else if (message.op.find("Parameter") != std::string::npos) {
    // The operation is known, but this connection may not use it.
    report(StatusLevel::error, message.op + ": " + std::string(control_is_off));
  } else {
    report(StatusLevel::warning, "'" + message.op + "' is not supported");
  }
}

void Session::receive_binary(std::string_view bytes) {
  auto message = parse_binary(bytes);
  if (auto* const service = std::get_if<ServiceCall>(&message)) return call(std::move(*service));
  if (!may(Control::playback)) throw WebError("playback: " + std::string(control_is_off) + ", with a log");
  Request playback;
  playback.kind = Request::Kind::playback;
  playback.playback = std::get<PlaybackRequest>(message);
  request(std::move(playback));
}

void Session::subscribe(const Subscription& subscription) {
  const std::size_t topic = subscription.channel;
  const std::string who = "subscription " + std::to_string(subscription.id) + ": ";
  if (topic >= advertised_ || protocol_.topics_.topics()[topic].encoding != "cdr")
    return report(StatusLevel::error, who + "no channel " + std::to_string(topic));
  if (topic_of_.contains(subscription.id)) return report(StatusLevel::error, who + "its id is in use");
  if (by_topic_.contains(topic))
    return report(StatusLevel::error, who + "channel " + std::to_string(topic) + " has one already");
  topic_of_.emplace(subscription.id, topic);
  by_topic_.emplace(topic, subscription.id);
  protocol_.count_subscription(topic, 1);
  if (protocol_.topics_.topics()[topic].latched) protocol_.topics_.send_latched(*this, topic);
}

void Session::unsubscribe(std::uint32_t id) {
  const auto found = topic_of_.find(id);
  if (found == topic_of_.end()) return report(StatusLevel::warning, "no subscription " + std::to_string(id));
  const std::size_t topic = found->second;
  by_topic_.erase(topic);
  topic_of_.erase(found);
  protocol_.count_subscription(topic, -1);
}

void Session::call(ServiceCall call) {
  const auto refuse = [&](std::string_view why) { answer(service_failure_text(call.service, call.call, why)); };
  if (!may(Control::run)) return refuse(control_is_off);
  const Service* service = find_service(call.service);
  if (service == nullptr) return refuse("there is no service " + std::to_string(call.service));
  try {
    ServiceArgument argument = read_request(*service, call.encoding, call.payload);
    Request made;
    made.command = service->command;
    made.value = argument.value;
    made.text = std::move(argument.text);
    made.call = {call.service, call.call, call.encoding, ""};
    made.client = link_.number();
    // The answer comes later, from the thread that simulates.
    if (!protocol_.exchange_.add_request(std::move(made))) refuse("too many requests of this client are waiting");
  } catch (const WebError& error) {
    refuse(error.what());
  }
}

void Session::set_parameters(const ClientText& message) {
  std::vector<Request> requests;
  std::vector<std::string> names;
  // Requests of the run; all are checked before the first is made
  for (const Parameter& each : message.parameters) {
    Request made;
    made.kind = Request::Kind::parameter;
    const bool* const flag = std::get_if<bool>(&each.value);
    const double* const number = std::get_if<double>(&each.value);
    if (each.name == "paused") {
      if (flag == nullptr) throw WebError("parameter 'paused' must be true or false");
      made.command = *flag ? "pause" : "resume";
    } else if (each.name == "speed") {
      if (number == nullptr) throw WebError("parameter 'speed' must be a number");
      made.command = "speed";
      made.value = *number;
    } else {
      throw WebError("unknown parameter '" + each.name + "'; known: paused, speed");
    }
    names.push_back(each.name);
    requests.push_back(std::move(made));
  }

  // The last one answers for all
  if (requests.empty()) return;
  requests.back().id = message.id;
  requests.back().names = std::move(names);
  for (Request& each : requests) request(std::move(each));
}

void Session::request(Request request) {
  request.client = link_.number();
  if (!protocol_.exchange_.add_request(std::move(request)))
    report(StatusLevel::error,
           "too many requests: " + std::to_string(Protocol::max_waiting_requests) + " of this client are waiting");
}

// --- To the client

void Session::answer(std::string bytes, bool is_text) {
  if (closing_) return;
  if (answers_.size() >= Protocol::max_waiting_texts) {
    closing_ = true;
    answers_.clear();
    return link_.close(WebClose::policy, "answers are not read");
  }
  answers_.push_back({std::make_shared<const std::string>(std::move(bytes)), is_text});
}

void Session::push(const ros2::Topic& topic, const ros2::ChannelMessage& from, const Bytes& cdr) {
  Data data{by_topic_.at(topic.number), from.utime, cdr, topic.latched ? from.channel : ""};
  if (topic.latched) return push_latched(std::move(data));
  const std::size_t bytes = cdr->size() + message_bytes;
  while (!data_.empty() &&
         (data_.size() >= Protocol::max_queued_messages || data_.bytes() + bytes > Protocol::max_queued_bytes)) {
    data_.pop();
    count_dropped(1);
  }
  data_.push(std::move(data), bytes);
}

/// A newer message of the same channel replaces the one that waits, except for assets, which add to a scene.
void Session::push_latched(Data data) {
  latched_.remove([&](const Data& other) {
    return other.channel == data.channel && other.subscription == data.subscription && data.channel != "sim.asset";
  });
  const std::size_t bytes = data.payload->size() + message_bytes;
  while (!latched_.empty() && latched_.bytes() + bytes > Protocol::max_latched_bytes) {
    latched_.pop();
    count_dropped(1);
  }
  latched_.push(std::move(data), bytes);
}

void Session::count_dropped(std::uint64_t count) {
  dropped_ += count;
  if (count > 0) protocol_.warn_of_drops();
}

void Session::jump(std::int64_t utime) {
  data_.clear();
  latched_.clear();
  time_ = utime;
}

void Session::show_parameters(const PlaybackState& state) {
  if (!gets_parameters_) return;
  answer(parameters_text(state, {parameters_.begin(), parameters_.end()}, std::nullopt));
}

bool Session::next(WebFrame& frame) {
  const auto give = [&](std::string bytes, bool is_text) {
    frame = {std::make_shared<const std::string>(std::move(bytes)), is_text};
    return true;
  };
  // Introduction
  if (!protocol_.info_) return false;
  if (!introduced_) {
    introduced_ = true;
    if (may(Control::run)) answer(advertise_services_text());
    return give(server_info_text(*protocol_.info_), true);
  }
  if (std::string text = next_advertisement(); !text.empty()) return give(std::move(text), true);

  // Answers, time, and messages, of which the latched ones come first
  if (!answers_.empty()) {
    frame = {answers_.front().bytes, answers_.front().is_text};
    answers_.pop_front();
    return true;
  }
  if (std::string text = next_drop_report(); !text.empty()) return give(std::move(text), true);
  if (time_) return give(time_data(*std::exchange(time_, std::nullopt)), false);
  for (WebQueue<Data>* const queue : {&latched_, &data_})
    while (!queue->empty()) {
      const Data data = queue->pop();
      if (topic_of_.contains(data.subscription))
        return give(message_data(data.subscription, data.utime, *data.payload), false);
    }
  return false;
}

/// Returns the next part of the topics that the client does not know; empty: it knows all.
std::string Session::next_advertisement() {
  constexpr std::size_t at_once = 100;
  const std::vector<ros2::Topic>& topics = protocol_.topics_.topics();
  std::vector<const ros2::Topic*> fresh;
  for (; advertised_ < topics.size() && fresh.size() < at_once; ++advertised_)
    if (topics[advertised_].encoding == "cdr") fresh.push_back(&topics[advertised_]);
  return fresh.empty() ? "" : advertise_text(fresh);
}

std::string Session::next_drop_report() {
  constexpr std::chrono::seconds interval{2};
  if (dropped_ == 0) return "";
  const auto now = std::chrono::steady_clock::now();
  if (now < next_drop_report_) return "";
  next_drop_report_ = now + interval;
  return status_text(StatusLevel::warning,
                     "Send buffer limit reached: " + std::to_string(std::exchange(dropped_, 0)) +
                         " messages were dropped, because they come faster than this client reads them",
                     "dropped");
}

}  // namespace bridges::foxglove
