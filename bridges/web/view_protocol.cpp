// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/view_protocol.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "bridges/web/client_message.hpp"
#include "bridges/web/web_error.hpp"

namespace bridges {

namespace {

/// After this many bytes of texts a state is sent before further texts, so that events cannot stop the motion.
constexpr std::size_t texts_between_states = 256 * 1024;

constexpr std::string_view no_token =
    "this page is read-only: open the address that was printed at the start, with its #t=";

std::shared_ptr<const std::string> shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

/// Bytes 4 to 7 of the head of a state.
std::uint32_t sequence_of_state(const std::string& state) {
  std::uint32_t sequence = 0;
  for (std::size_t i = 8; i-- > 4;)
    sequence = sequence << 8 | (i < state.size() ? static_cast<unsigned char>(state[i]) : 0u);
  return sequence;
}

/// Bit of byte 1 of the head: the time was set, so that the motion from the state before means nothing.
constexpr unsigned char jump_flag = 2;

/// Returns a state that takes the place of one that was not sent: a jump between them is not lost.
std::shared_ptr<const std::string> in_place_of(const std::shared_ptr<const std::string>& unsent,
                                               std::shared_ptr<const std::string> state) {
  const auto jumps = [](const std::string& bytes) {
    return bytes.size() > 1 && (static_cast<unsigned char>(bytes[1]) & jump_flag) != 0;
  };
  if (!unsent || !jumps(*unsent) || jumps(*state) || state->size() < 2) return state;
  std::string marked = *state;
  marked[1] = static_cast<char>(static_cast<unsigned char>(marked[1]) | jump_flag);
  return shared(std::move(marked));
}

/// Puts an element in the place of the one of its `op`, or to the end.
template <class Element>
void put_in_place(std::vector<Element>& elements, Element element) {
  const auto same =
      std::find_if(elements.begin(), elements.end(), [&](const Element& other) { return other.op == element.op; });
  if (same != elements.end())
    *same = std::move(element);
  else
    elements.push_back(std::move(element));
}

/// Requests that change what others see, or the run.
bool needs_control(const std::string& op) {
  return op == "control" || op == "play" || op == "seek" || op == "drive";
}

}  // namespace

// --- Functions for all threads

bool ViewProtocol::Box::admit(const Text& text) {
  // The thread of the server empties the box at once unless the machine is overloaded; a page that does not read must
  // not fill the memory of the run.
  const bool fits = bytes + text->size() <= max_queued_bytes;
  if (fits)
    bytes += text->size();
  else
    ++dropped;
  return fits;
}

void ViewProtocol::send_state(std::span<const std::byte> state) {
  if (clients() == 0) return;
  auto text = shared(std::string(reinterpret_cast<const char*>(state.data()), state.size()));
  exchange_.put([&](Box& box) {
    text = in_place_of(box.state, std::move(text));
    box.state.swap(text);
  });
}

void ViewProtocol::send_state_to(int client, std::span<const std::byte> state) {
  if (clients() == 0) return;
  auto text = shared(std::string(reinterpret_cast<const char*>(state.data()), state.size()));
  exchange_.put([&](Box& box) {
    if (box.bytes + text->size() > max_queued_bytes && !box.own_states.empty()) return false;  // the page asks again
    box.bytes += text->size();
    box.own_states.emplace_back(client, std::move(text));
    return true;
  });
}

void ViewProtocol::send_text(std::string json) {
  if (clients() == 0) return;
  auto text = shared(std::move(json));
  exchange_.put([&](Box& box) {
    if (box.admit(text)) box.texts.push_back(std::move(text));
  });
}

void ViewProtocol::retain(std::string_view op, std::string json) {
  Retained retained{std::string(op), nullptr, nullptr, 0};
  if (op == "hello") {
    retained.text = shared(with_control(json, false));
    retained.text_of_controller = shared(with_control(json, true));
  } else {
    retained.text = shared(std::move(json));
  }
  exchange_.put([&](Box& box) {
    put_in_place(box.retained, std::move(retained));
    // A page that says hello after this check finds the text in the box.
    return clients() > 0;
  });
}

void ViewProtocol::reply(int client, std::string json) {
  if (clients() == 0) return;
  auto text = shared(std::move(json));
  exchange_.put([&](Box& box) {
    if (box.admit(text)) box.replies.emplace_back(client, std::move(text));
  });
}

void ViewProtocol::send_message(int client, std::string_view channel, Text bytes) {
  if (clients() == 0) return;
  exchange_.put([&](Box& box) {
    // Only the newest message of a channel waits: a slow page gets fewer, never old ones.
    Text& place = box.messages[{client, std::string(channel)}];
    const std::size_t present = place ? place->size() : 0;
    if (box.bytes - present + bytes->size() > max_queued_bytes) {
      if (!place) box.messages.erase({client, std::string(channel)});
      return false;
    }
    box.bytes += bytes->size() - present;
    place = std::move(bytes);
    return true;
  });
}

// --- Functions of the thread of the server

std::unique_ptr<WebSession> ViewProtocol::open(WebLink& link) {
  auto session = std::make_unique<ViewSession>(*this, link);
  exchange_.add(*session);
  return session;
}

void ViewProtocol::deliver(const Box& box) {
  for (const Retained& retained : box.retained) keep(retained);
  if (box.state) last_state_ = box.state;
  for (ViewSession* session : exchange_.sessions()) {
    if (!session->greeted_) continue;
    session->dropped_ += box.dropped;
    for (const Text& text : box.texts) session->push(text);
    for (const auto& reply : box.replies)
      if (reply.first == session->link_.number()) session->push(reply.second);
    for (const auto& [place, bytes] : box.messages)
      if (place.first == session->link_.number()) session->set_message(place.second, bytes);
    for (const auto& own : box.own_states)
      if (own.first == session->link_.number()) session->add_own_state(own.second);
    if (box.state) session->set_state(box.state);
    session->link_.wake();
  }
}

void ViewProtocol::keep(Retained retained) {
  retained.revision = ++revision_;
  put_in_place(retained_, std::move(retained));
}

void ViewProtocol::greeted() {
  exchange_.count_client(1);
  exchange_.deliver();  // texts and states of before are not for the new page
}

void ViewProtocol::left(const ViewSession& session, bool was_greeted) {
  exchange_.remove(session);
  if (!was_greeted) return;
  exchange_.add_request({session.link_.number(), session.may_control_, "left", ""}, true);
  if (exchange_.count_client(-1) == 0) last_state_.reset();
}

// --- One page

ViewSession::~ViewSession() {
  protocol_.left(*this, greeted_);
}

void ViewSession::receive(std::string_view bytes, bool is_text) {
  try {
    if (!is_text) throw WebError("binary messages are not part of shoal.view.v1");
    const ClientMessage message = parse_client_message(bytes);
    // Nothing is sent before the greeting, which carries the token.
    if (!greeted_ && message.op != "hello")
      throw WebError("the first message must be 'hello', got '" + message.op + "'");
    if (message.op == "hello") return greet(message.token);
    if (message.op == "ack") return acknowledge(*message.sequence);
    request({link_.number(), may_control_, message.op, std::string(bytes)}, message.id);
  } catch (const WebError& error) {
    push(shared(error_message(error.what())));
    if (!greeted_) link_.close(WebClose::policy, "no valid hello");
  }
  link_.wake();
}

void ViewSession::greet(std::string_view token) {
  if (greeted_) throw WebError("a second 'hello'");
  may_control_ = protocol_.token_.matches(token);
  if (protocol_.token_to_read_ && !may_control_)
    throw WebError("the token of the address is needed: it ends with #t=...");

  // The new page first gets what is retained, then the last state
  protocol_.greeted();
  greeted_ = true;
  if (!may_control_ && !token.empty()) push(shared(error_message("wrong token: " + std::string(no_token))));
  if (protocol_.last_state_) set_state(protocol_.last_state_);
  link_.wake();
}

void ViewSession::acknowledge(std::uint32_t sequence) {
  const auto found = std::find(unacknowledged_.begin(), unacknowledged_.end(), sequence);
  if (found == unacknowledged_.end()) return;
  unacknowledged_.erase(unacknowledged_.begin(), found + 1);
  link_.wake();
}

void ViewSession::request(ViewRequest request, const std::string& id) {
  if (needs_control(request.op) && !may_control_) return push(shared(refusal_message(id, no_token)));
  if (!protocol_.exchange_.add_request(std::move(request)))
    push(shared(refusal_message(
        id, "too many requests: " + std::to_string(ViewProtocol::max_waiting_requests) + " of this page are waiting")));
}

void ViewSession::push(Text text) {
  drop_oldest(text->size());
  if (text->size() > ViewProtocol::max_queued_bytes) {
    ++dropped_;
    return;
  }
  const std::size_t bytes = text->size();
  texts_.push(std::move(text), bytes);
}

void ViewSession::drop_oldest(std::size_t room_for) {
  drop_messages(room_for);  // the next one on the channel replaces it
  while (!texts_.empty() && queued_bytes() + room_for > ViewProtocol::max_queued_bytes) {
    texts_.pop();
    ++dropped_;
  }
}

bool ViewSession::next(WebFrame& frame) {
  const bool state_first = complete_ && bytes_since_state_ >= texts_between_states;
  if (state_first)
    if (Text state = next_state()) return take(std::move(state), false, frame);
  if (Text text = next_retained()) return take(std::move(text), true, frame);
  if (Text text = next_text()) return take(std::move(text), true, frame);
  if (Text state = next_own_state()) return take(std::move(state), false, frame);
  if (Text state = next_state()) return take(std::move(state), false, frame);
  if (Text message = next_message()) return take(std::move(message), false, frame);
  return false;
}

bool ViewSession::take(Text bytes, bool is_text, WebFrame& frame) {
  bytes_since_state_ = is_text ? bytes_since_state_ + bytes->size() : 0;
  frame = {std::move(bytes), is_text};
  return true;
}

/// Returns the first retained text that the page has not got, in the order of their first retain.
ViewSession::Text ViewSession::next_retained() {
  const auto& retained = protocol_.retained_;
  if (!greeted_) return nullptr;
  if (revision_seen_ == protocol_.revision_) {
    complete_ = true;
    return nullptr;
  }
  revisions_sent_.resize(retained.size());
  for (std::size_t i = 0; i < retained.size(); ++i) {
    if (revisions_sent_[i] == retained[i].revision) continue;
    revisions_sent_[i] = retained[i].revision;
    return may_control_ && retained[i].text_of_controller ? retained[i].text_of_controller : retained[i].text;
  }
  revision_seen_ = protocol_.revision_;
  complete_ = true;
  return nullptr;
}

ViewSession::Text ViewSession::next_text() {
  if (dropped_ > 0) return shared("{\"op\":\"dropped\",\"count\":" + std::to_string(std::exchange(dropped_, 0)) + "}");
  return texts_.empty() ? nullptr : texts_.pop();
}

ViewSession::Text ViewSession::next_state() {
  if (!state_ || unacknowledged_.size() >= ViewProtocol::max_unacknowledged) return nullptr;
  unacknowledged_.push_back(sequence_of_state(*state_));
  return std::exchange(state_, nullptr);
}

void ViewSession::set_message(const std::string& channel, const Text& bytes) {
  const auto before = messages_.find(channel);
  const std::size_t present = before == messages_.end() ? 0 : before->second->size();
  if (queued_bytes() - present + bytes->size() > ViewProtocol::max_queued_bytes) return;
  message_bytes_ += bytes->size() - present;
  messages_[channel] = bytes;
}

void ViewSession::drop_messages(std::size_t room_for) {
  while (!messages_.empty() && queued_bytes() + room_for > ViewProtocol::max_queued_bytes) {
    message_bytes_ -= messages_.begin()->second->size();
    messages_.erase(messages_.begin());
  }
}

/// Takes the message of the next channel in turn, so that a busy channel does not stop the others.
ViewSession::Text ViewSession::next_message() {
  if (messages_.empty()) return nullptr;
  auto next = messages_.upper_bound(last_channel_);
  if (next == messages_.end()) next = messages_.begin();
  last_channel_ = next->first;
  Text bytes = std::move(next->second);
  messages_.erase(next);
  message_bytes_ -= bytes->size();
  return bytes;
}

void ViewSession::set_state(Text state) {
  state_ = in_place_of(state_, std::move(state));
}

void ViewSession::add_own_state(Text state) {
  if (own_states_.size() >= ViewProtocol::max_own_states) own_states_.pop_front();
  own_states_.push_back(std::move(state));
}

ViewSession::Text ViewSession::next_own_state() {
  if (own_states_.empty()) return nullptr;
  Text state = std::move(own_states_.front());
  own_states_.pop_front();
  return state;
}

}  // namespace bridges
