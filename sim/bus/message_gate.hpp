// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <bitset>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "sim/bus/bus.hpp"

namespace sim {

/// Flags of devices, such as those whose mailboxes may have messages: one per device, contiguous in memory.
class ArrivalFlags {
 public:
  /// Returns the flag of a device by its number; it exists as long as any owner holds it.
  std::shared_ptr<std::atomic<bool>> of(int device) {
    const auto number = static_cast<std::size_t>(device);
    while (blocks_.size() <= number / flags_per_block) blocks_.push_back(std::make_shared<Block>());
    const std::shared_ptr<Block>& block = blocks_[number / flags_per_block];
    return {block, &(*block)[number % flags_per_block]};
  }

 private:
  static constexpr std::size_t flags_per_block = 4096;
  using Block = std::array<std::atomic<bool>, flags_per_block>;
  std::vector<std::shared_ptr<Block>> blocks_;
};

/// Bus between a network and a world.  Messages from outside are queued until admit(), which the run calls once at the
/// start of each step: all readers of a channel receive a message in the same step and in a defined order.  A message
/// published through the gate is in its mailboxes immediately, and is not delivered again when the network echoes it.
/// A message published on the network directly, not through the gate, counts as a message from outside, even when this
/// process publishes it.  Not thread-safe.
class MessageGate final : public Bus {
 public:
  /// `network` must outlive the gate.
  explicit MessageGate(Bus& network);
  ~MessageGate() override;
  MessageGate(const MessageGate&) = delete;
  MessageGate& operator=(const MessageGate&) = delete;

  struct Delivery {
    std::string channel;
    Bytes payload;
  };

  void publish(std::string_view channel, std::span<const std::byte> payload, Time at) override;
  std::unique_ptr<OpenChannel> open_channel(const std::string& channel) override;
  std::unique_ptr<Mailbox> open_mailbox(const std::string& channel,
                                        std::size_t capacity = default_mailbox_capacity) override;
  void end_of_step() override { network_.end_of_step(); }
  /// Returns the counts of the network plus the messages dropped by the gate.
  BusCounts counts() const override;

  /// Collects the messages from outside on channels that have a reader.  Returns true when messages are waiting.  The
  /// queue of a channel is limited to the capacity of its largest mailbox; beyond it, the oldest message is dropped and
  /// counted.
  bool collect();
  /// Messages that were collected and not admitted yet: by channel in the order in which the channels were first read,
  /// within a channel in the order of arrival.  The caller may reorder the list and add to it.
  std::vector<Delivery>& waiting() { return waiting_; }
  /// Collects messages and delivers all waiting ones to the mailboxes of their channels.  Returns the delivered
  /// messages, which are valid until the next call.  Messages on channels without a reader are dropped.
  const std::vector<Delivery>& admit();
  /// Like admit(), but delivers `messages` in place of those from outside, which are collected, put in order and
  /// returned in `messages`.  For a run that repeats its record while programs follow it.
  const std::vector<Delivery>& admit_instead(std::vector<Delivery>& messages);

  /// Callback of admit() between collection and delivery; may reorder, add and remove messages.
  using Order = std::function<void(std::vector<Delivery>& messages)>;
  void set_order(Order order) { order_ = std::move(order); }
  /// Returns whether this channel has a reader at the gate.
  bool reads(std::string_view channel) const { return by_name_.contains(channel); }
  /// Returns the number of mailboxes of this channel.
  std::size_t readers(std::string_view channel) const;

  /// Callback for every publication, called before the message is sent to the network; empty: none.
  using Watch = std::function<void(std::string_view channel, std::span<const std::byte> payload)>;
  void set_watch(Watch watch) { watch_ = std::move(watch); }

 private:
  class GateMailbox;
  class GateChannel;
  struct Channel;
  struct NameHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view name) const { return std::hash<std::string_view>()(name); }
  };

  /// Returns the channel of this name with readers; null: it has none.
  Channel* find_read(std::string_view channel) const;
  /// Publishes on a channel with readers; `send` publishes on the network.
  template <typename Send>
  void publish_read(Channel& read, std::span<const std::byte> payload, const Send& send);
  void collect_from(Channel& channel);
  template <typename Accepts>
  void take_from(Channel& channel, const Accepts& accepts);
  /// Returns true when a message may have arrived since the previous call.
  static bool has_arrivals(Channel& channel);
  static constexpr std::size_t max_bits = 1024;
  static std::size_t bit_of(std::string_view channel);
  bool may_be_read(std::string_view channel) const { return bits_[bit_of(channel)]; }
  void drop_oldest(Channel& channel);
  void deliver_admitted();
  void give(Channel& channel, std::span<const std::byte> payload, bool from_outside);
  void close(GateMailbox& mailbox);

  Bus& network_;
  Watch watch_;
  Order order_;
  ArrivalFlags flags_;                              // one for each slot: a message may have arrived
  std::vector<std::unique_ptr<Channel>> channels_;  // by slot; null: the slot is free
  std::vector<std::size_t> free_slots_;
  std::unordered_map<std::string, Channel*, NameHash, std::equal_to<>> by_name_;  // for look-ups, never iterated
  std::uint64_t readers_changed_ = 0;                                             // counts changes of by_name_
  std::bitset<max_bits> bits_;  // of the names that have or had a reader
  std::vector<Delivery> waiting_, admitted_;
  std::uint64_t dropped_ = 0;
};

}  // namespace sim
