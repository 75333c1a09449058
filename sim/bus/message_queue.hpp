// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "sim/bus/bus.hpp"

namespace sim {

/// Unread messages of a mailbox, oldest first.  An empty queue takes no memory, unlike a std::deque: a world has
/// thousands of mailboxes.
class MessageQueue {
 public:
  bool empty() const { return first_ == messages_.size(); }
  std::size_t size() const { return messages_.size() - first_; }
  void push(Message message) {
    // Move the unread messages to the front when the read ones are the larger part.
    if (first_ > 0 && 2 * first_ >= messages_.size()) set(rest());
    messages_.push_back(std::move(message));
  }
  /// Removes and returns the oldest message; none when it is empty.
  std::optional<Message> take() {
    if (empty()) return std::nullopt;
    std::optional<Message> oldest = std::move(messages_[first_++]);
    if (empty()) clear();
    return oldest;
  }
  void clear() {
    messages_.clear();
    first_ = 0;
  }
  /// Returns copies of all messages.
  std::vector<Message> all() const { return {messages_.begin() + offset(), messages_.end()}; }
  void set(std::vector<Message> messages) {
    messages_ = std::move(messages);
    first_ = 0;
  }

 private:
  std::ptrdiff_t offset() const { return static_cast<std::ptrdiff_t>(first_); }
  std::vector<Message> rest() {
    return {std::make_move_iterator(messages_.begin() + offset()), std::make_move_iterator(messages_.end())};
  }

  std::vector<Message> messages_;  // those before first_ have been taken
  std::size_t first_ = 0;
};

}  // namespace sim
