// SPDX-License-Identifier: BSD-3-Clause
#include "sim/bus/in_process_bus.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sim/bus/message_queue.hpp"

namespace sim {

namespace {

void check_channel(std::string_view channel) {
  if (channel.empty()) throw std::invalid_argument("a channel name must not be empty");
  if (channel.size() > Bus::max_channel_length)
    throw std::invalid_argument("channel '" + std::string(channel) + "' has " + std::to_string(channel.size()) +
                                " characters; at most " + std::to_string(Bus::max_channel_length) + " are allowed");
}

}  // namespace

struct InProcessBus::Queue {
  MessageQueue messages;
  std::size_t capacity = 0;
  std::uint64_t dropped = 0;
  bool closed = false;                      ///< its mailbox was destroyed
  std::shared_ptr<std::atomic<bool>> flag;  ///< may be null
};

class InProcessBus::QueueMailbox final : public Mailbox {
 public:
  explicit QueueMailbox(std::shared_ptr<Queue> queue) : queue_(std::move(queue)) {}
  ~QueueMailbox() override {
    queue_->closed = true;
    queue_->messages.clear();
  }
  QueueMailbox(const QueueMailbox&) = delete;
  QueueMailbox& operator=(const QueueMailbox&) = delete;

  std::optional<Message> take() override { return queue_->messages.take(); }
  std::uint64_t dropped() const override { return queue_->dropped; }
  void raise_on_arrival(std::shared_ptr<std::atomic<bool>> flag) override {
    if (!queue_->messages.empty()) flag->store(true, std::memory_order_relaxed);
    queue_->flag = std::move(flag);
  }

  std::vector<Message> unread() const override { return queue_->messages.all(); }
  void set_unread(std::vector<Message> messages) override {
    queue_->messages.set(std::move(messages));
    if (queue_->flag && !queue_->messages.empty()) queue_->flag->store(true, std::memory_order_relaxed);
  }

 private:
  std::shared_ptr<Queue> queue_;
};

class InProcessBus::QueuesChannel final : public OpenChannel {
 public:
  QueuesChannel(InProcessBus& bus, std::pair<const std::string, Queues>& entry) : bus_(bus), entry_(entry) {}

  void publish(std::span<const std::byte> payload, Time) override {
    ++bus_.counts_.published;
    if (!entry_.second.empty()) bus_.give(entry_.first, entry_.second, payload);
  }

 private:
  InProcessBus& bus_;
  std::pair<const std::string, Queues>& entry_;
};

InProcessBus::InProcessBus() = default;
InProcessBus::~InProcessBus() = default;

void InProcessBus::publish(std::string_view channel, std::span<const std::byte> payload, Time) {
  check_channel(channel);
  ++counts_.published;
  if (const auto found = queues_.find(channel); found != queues_.end()) give(found->first, found->second, payload);
}

void InProcessBus::give(const std::string& channel, Queues& queues, std::span<const std::byte> payload) {
  std::erase_if(queues, [](const auto& queue) { return queue->closed; });
  for (const std::shared_ptr<Queue>& queue : queues) {
    queue->messages.push({channel, Bytes(payload.begin(), payload.end()), false});
    ++counts_.received;
    if (queue->flag) queue->flag->store(true, std::memory_order_relaxed);
    // The oldest message gives way: a reader that falls behind wants the latest state.
    if (queue->messages.size() <= queue->capacity) continue;
    queue->messages.take();
    ++queue->dropped;
    ++counts_.dropped_incoming;
  }
}

std::unique_ptr<OpenChannel> InProcessBus::open_channel(const std::string& channel) {
  check_channel(channel);
  return std::make_unique<QueuesChannel>(*this, *queues_.try_emplace(channel).first);
}

std::unique_ptr<Mailbox> InProcessBus::open_mailbox(const std::string& channel, std::size_t capacity) {
  check_channel(channel);
  auto queue = std::make_shared<Queue>();
  queue->capacity = capacity;
  auto& queues = queues_[channel];
  std::erase_if(queues, [](const auto& other) { return other->closed; });
  queues.push_back(queue);
  return std::make_unique<QueueMailbox>(std::move(queue));
}

BusCounts InProcessBus::counts() const {
  return counts_;
}

}  // namespace sim
