// SPDX-License-Identifier: BSD-3-Clause
#include "sim/bus/message_gate.hpp"

#include <algorithm>
#include <utility>

#include "sim/bus/message_queue.hpp"

namespace sim {

/// Channel with readers, and its mailbox on the network.
struct MessageGate::Channel {
  std::string name;
  std::size_t slot = 0;
  std::shared_ptr<std::atomic<bool>> flag;
  std::unique_ptr<Mailbox> inner;
  std::vector<GateMailbox*> mailboxes;
  std::size_t capacity = 0;  ///< of the largest mailbox
  std::size_t waiting = 0;   ///< upper bound: the user of waiting() may change it
};

class MessageGate::GateMailbox final : public Mailbox {
 public:
  GateMailbox(MessageGate& gate, Channel& channel, std::size_t capacity)
      : gate_(gate), channel_(channel), capacity_(std::max<std::size_t>(capacity, 1)) {}
  ~GateMailbox() override { gate_.close(*this); }
  GateMailbox(const GateMailbox&) = delete;
  GateMailbox& operator=(const GateMailbox&) = delete;

  std::optional<Message> take() override { return messages_.take(); }
  std::uint64_t dropped() const override { return dropped_; }
  void raise_on_arrival(std::shared_ptr<std::atomic<bool>> flag) override {
    if (!messages_.empty()) flag->store(true, std::memory_order_relaxed);
    flag_ = std::move(flag);
  }
  std::vector<Message> unread() const override { return messages_.all(); }
  void set_unread(std::vector<Message> messages) override {
    messages_.set(std::move(messages));
    if (flag_ && !messages_.empty()) flag_->store(true, std::memory_order_relaxed);
  }

  /// Adds a message; returns false when the oldest one was dropped.
  bool add(Message message) {
    messages_.push(std::move(message));
    if (flag_) flag_->store(true, std::memory_order_relaxed);
    if (messages_.size() <= capacity_) return true;
    messages_.take();
    ++dropped_;
    return false;
  }
  Channel& channel() { return channel_; }
  std::size_t capacity() const { return capacity_; }

 private:
  MessageGate& gate_;
  Channel& channel_;
  const std::size_t capacity_;
  MessageQueue messages_;
  std::shared_ptr<std::atomic<bool>> flag_;  // may be null
  std::uint64_t dropped_ = 0;
};

MessageGate::MessageGate(Bus& network) : network_(network) {}

MessageGate::~MessageGate() = default;

MessageGate::Channel* MessageGate::find_read(std::string_view channel) const {
  if (!may_be_read(channel)) return nullptr;
  const auto known = by_name_.find(channel);
  return known == by_name_.end() ? nullptr : known->second;
}

template <typename Send>
void MessageGate::publish_read(Channel& read, std::span<const std::byte> payload, const Send& send) {
  if (has_arrivals(read)) collect_from(read);  // keeps the order of earlier messages
  send();
  // The network has echoed this already, and this process cannot have published in between.
  if (has_arrivals(read)) take_from(read, [](const Message& message) { return message.from_outside; });
  give(read, payload, false);
}

void MessageGate::publish(std::string_view channel, std::span<const std::byte> payload, Time at) {
  if (watch_) watch_(channel, payload);
  Channel* const read = find_read(channel);
  if (read == nullptr) return network_.publish(channel, payload, at);
  publish_read(*read, payload, [&] { network_.publish(channel, payload, at); });
}

/// Looks its readers up when they may have changed since its last publication.
class MessageGate::GateChannel final : public OpenChannel {
 public:
  GateChannel(MessageGate& gate, const std::string& name)
      : gate_(gate), name_(name), network_(gate.network_.open_channel(name)) {}

  void publish(std::span<const std::byte> payload, Time at) override {
    if (gate_.watch_) gate_.watch_(name_, payload);
    if (looked_up_at_ != gate_.readers_changed_) {
      looked_up_at_ = gate_.readers_changed_;
      read_ = gate_.find_read(name_);
    }
    if (read_ == nullptr) return network_->publish(payload, at);
    gate_.publish_read(*read_, payload, [&] { network_->publish(payload, at); });
  }

 private:
  MessageGate& gate_;
  const std::string name_;
  const std::unique_ptr<OpenChannel> network_;
  Channel* read_ = nullptr;
  std::uint64_t looked_up_at_ = 0;  // no channel is read at 0
};

std::unique_ptr<OpenChannel> MessageGate::open_channel(const std::string& channel) {
  return std::make_unique<GateChannel>(*this, channel);
}

bool MessageGate::has_arrivals(Channel& channel) {
  return channel.flag->load(std::memory_order_relaxed) && channel.flag->exchange(false, std::memory_order_acquire);
}

/// Returns the bit of a channel.  Names are looked up only when their bit is set; the bits of most channels without a
/// reader are not set.
std::size_t MessageGate::bit_of(std::string_view channel) {
  const auto letter = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(channel[i])); };
  if (channel.empty()) return 0;
  const std::size_t last = channel.size() - 1;
  return (channel.size() * 131 + letter(last) * 31 + letter(last - last / 4) * 17 + letter(last / 2) * 7 + letter(0)) %
         max_bits;
}

std::unique_ptr<Mailbox> MessageGate::open_mailbox(const std::string& channel, std::size_t capacity) {
  const auto known = by_name_.find(channel);
  Channel* read = known == by_name_.end() ? nullptr : known->second;
  // Open the channel on the network for its first reader.
  if (read == nullptr) {
    auto inner = network_.open_mailbox(channel, default_mailbox_capacity);  // checks the name
    const std::size_t slot = free_slots_.empty() ? channels_.size() : free_slots_.back();
    if (free_slots_.empty())
      channels_.emplace_back();
    else
      free_slots_.pop_back();
    channels_[slot] = std::make_unique<Channel>();
    read = channels_[slot].get();
    read->name = channel;
    read->slot = slot;
    read->flag = flags_.of(static_cast<int>(slot));
    read->flag->store(false, std::memory_order_relaxed);
    read->inner = std::move(inner);
    read->inner->raise_on_arrival(read->flag);
    by_name_.emplace(channel, read);
    ++readers_changed_;
    bits_.set(bit_of(channel));
  }
  // Add the mailbox of the reader.
  auto mailbox = std::make_unique<GateMailbox>(*this, *read, capacity);
  read->mailboxes.push_back(mailbox.get());
  read->capacity = std::max(read->capacity, mailbox->capacity());
  return mailbox;
}

void MessageGate::close(GateMailbox& mailbox) {
  Channel& channel = mailbox.channel();
  std::erase(channel.mailboxes, &mailbox);
  channel.capacity = 0;
  // The channel keeps as much as its largest mailbox, which may just have gone.
  for (const GateMailbox* other : channel.mailboxes) channel.capacity = std::max(channel.capacity, other->capacity());
  if (!channel.mailboxes.empty()) return;
  const std::size_t slot = channel.slot;
  by_name_.erase(channel.name);
  ++readers_changed_;
  channels_[slot].reset();
  free_slots_.push_back(slot);
}

std::size_t MessageGate::readers(std::string_view channel) const {
  const auto known = by_name_.find(channel);
  return known == by_name_.end() ? 0 : known->second->mailboxes.size();
}

bool MessageGate::collect() {
  for (const auto& channel : channels_)
    if (channel && has_arrivals(*channel)) collect_from(*channel);
  return !waiting_.empty();
}

void MessageGate::collect_from(Channel& channel) {
  take_from(channel, [](const Message&) { return true; });
}

/// Takes as many messages as the network mailbox holds at the call, so that a continuous sender cannot delay the step.
template <typename Accepts>
void MessageGate::take_from(Channel& channel, const Accepts& accepts) {
  std::size_t left = default_mailbox_capacity;
  for (; left > 0; --left) {
    auto message = channel.inner->take();
    if (!message) break;
    if (!accepts(*message)) continue;
    waiting_.push_back({std::move(message->channel), std::move(message->payload)});
    ++channel.waiting;
  }
  if (left == 0) channel.flag->store(true, std::memory_order_relaxed);  // there may be more messages
  if (channel.waiting > channel.capacity) drop_oldest(channel);
}

/// Drops all excess messages in one pass.
void MessageGate::drop_oldest(Channel& channel) {
  const auto is_of_channel = [&](const Delivery& arrivals) { return arrivals.channel == channel.name; };
  // The user of waiting() may have removed some.
  channel.waiting = static_cast<std::size_t>(std::count_if(waiting_.begin(), waiting_.end(), is_of_channel));
  if (channel.waiting <= channel.capacity) return;
  std::size_t too_many = channel.waiting - channel.capacity;
  channel.waiting = channel.capacity;
  dropped_ += std::erase_if(waiting_, [&](const Delivery& arrivals) {
    if (too_many == 0 || !is_of_channel(arrivals)) return false;
    --too_many;
    return true;
  });
}

const std::vector<MessageGate::Delivery>& MessageGate::admit() {
  collect();
  admitted_.clear();
  admitted_.swap(waiting_);
  if (order_) order_(admitted_);
  deliver_admitted();
  return admitted_;
}

const std::vector<MessageGate::Delivery>& MessageGate::admit_instead(std::vector<Delivery>& messages) {
  collect();
  admitted_.clear();
  admitted_.swap(messages);
  messages.swap(waiting_);
  if (order_) order_(messages);
  deliver_admitted();
  return admitted_;
}

void MessageGate::deliver_admitted() {
  std::erase_if(admitted_, [&](const Delivery& arrivals) {
    const auto known = by_name_.find(arrivals.channel);
    if (known == by_name_.end()) return true;
    known->second->waiting = 0;
    give(*known->second, arrivals.payload, true);
    return false;
  });
}

void MessageGate::give(Channel& channel, std::span<const std::byte> payload, bool from_outside) {
  for (GateMailbox* mailbox : channel.mailboxes)
    if (!mailbox->add({channel.name, Bytes(payload.begin(), payload.end()), from_outside})) ++dropped_;
}

BusCounts MessageGate::counts() const {
  BusCounts counts = network_.counts();
  counts.dropped_incoming += dropped_;
  return counts;
}

}  // namespace sim
