// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace bridges {

/// Function that runs work in the thread of the server.
using WebPost = std::function<void(std::function<void()>)>;

/// What the box of every WebExchange counts.
struct WebBox {
  std::size_t bytes = 0;      ///< that wait in the box
  std::uint64_t dropped = 0;  ///< messages that found no room
};

/// Exchange of a WebProtocol between the threads of the world, which never wait for the network, and the thread of the
/// server, in which its sessions live.  To the clients: a box under a lock, which the thread of the server empties as
/// a whole.  From the clients: a queue of requests with a quota for each client.
///
/// `Box` is a default-constructed struct with the base WebBox; `Request` has the number of its `client`.
template <class Box, class Request, class Session>
class WebExchange {
 public:
  /// `deliver` gets the content of the box in the thread of the server.  `post` may be set later, before the first
  /// client.  `max_waiting_requests`: of one client.
  WebExchange(std::function<void(Box)> deliver, std::size_t max_waiting_requests, WebPost post = {})
      : deliver_(std::move(deliver)), max_waiting_requests_(max_waiting_requests), post_(std::move(post)) {}
  void set_post(WebPost post) { post_ = std::move(post); }

  // Thread-safe:

  /// Returns the number of clients, as count_client() has it.
  int clients() const { return clients_.load(); }
  /// Runs `work(Box&)` under the lock of the box.
  template <class Work>
  auto with_box(Work work) {
    const std::lock_guard lock(box_mutex_);
    return work(box_);
  }
  /// Runs `fill(Box&)` under the lock of the box, and wakes the thread of the server unless it returns false.
  template <class Fill>
  void put(Fill fill) {
    if constexpr (std::is_void_v<std::invoke_result_t<Fill, Box&>>) {
      with_box(std::move(fill));
    } else if (!with_box(std::move(fill))) {
      return;
    }
    wake();
  }
  /// Does the same without waking: flush() does once for all, since that costs more than a message.
  template <class Fill>
  void gather(Fill fill) {
    if (with_box(std::move(fill))) gathered_ = true;
  }
  void flush() {
    if (gathered_.load() && gathered_.exchange(false)) wake();
  }
  /// Returns the next request, or std::nullopt.
  std::optional<Request> take_request() {
    if (!has_requests_.load()) return std::nullopt;
    const std::lock_guard lock(request_mutex_);
    if (requests_.empty()) return std::nullopt;
    Request request = std::move(requests_.front());
    requests_.pop_front();
    has_requests_ = !requests_.empty();
    const auto waiting = waiting_requests_.find(request.client);
    if (waiting != waiting_requests_.end() && --waiting->second == 0) waiting_requests_.erase(waiting);
    return request;
  }
  /// Queues a request.  Returns false if the quota of its client is used up, except for one that is `always` taken.
  bool add_request(Request request, bool always = false) {
    const std::lock_guard lock(request_mutex_);
    std::size_t& waiting = waiting_requests_[request.client];
    if (waiting >= max_waiting_requests_ && !always) return false;
    ++waiting;
    requests_.push_back(std::move(request));
    has_requests_ = true;
    return true;
  }

  // In the thread of the server:

  /// Passes on what is in the box now.
  void deliver() {
    awake_ = false;
    deliver_(with_box([](Box& box) { return std::exchange(box, Box{}); }));
  }
  const std::vector<Session*>& sessions() const { return sessions_; }
  void add(Session& session) { sessions_.push_back(&session); }
  void remove(const Session& session) { sessions_.erase(std::find(sessions_.begin(), sessions_.end(), &session)); }
  /// Counts a client that comes (1) or leaves (-1).  Returns the number of clients.
  int count_client(int change) { return clients_ += change; }

 private:
  void wake() {
    if (!awake_.exchange(true)) post_([this] { deliver(); });
  }

  const std::function<void(Box)> deliver_;
  const std::size_t max_waiting_requests_;
  WebPost post_;
  std::atomic<int> clients_ = 0;
  std::atomic<bool> awake_ = false, gathered_ = false;
  std::mutex box_mutex_;
  Box box_;
  std::mutex request_mutex_;
  std::deque<Request> requests_;
  std::map<int, std::size_t> waiting_requests_;  // by client
  std::atomic<bool> has_requests_ = false;
  std::vector<Session*> sessions_;
};

/// Items that wait for a client, with the sum of their bytes.
template <class Item>
class WebQueue {
 public:
  bool empty() const { return items_.empty(); }
  std::size_t size() const { return items_.size(); }
  std::size_t bytes() const { return bytes_; }
  void push(Item item, std::size_t bytes) {
    bytes_ += bytes;
    items_.push_back({std::move(item), bytes});
  }
  Item pop() {
    Item item = std::move(items_.front().item);
    bytes_ -= items_.front().bytes;
    items_.pop_front();
    return item;
  }
  /// Removes the first item for which `matches` holds, if there is one.
  template <class Matches>
  void remove(Matches matches) {
    const auto found =
        std::find_if(items_.begin(), items_.end(), [&](const Entry& entry) { return matches(entry.item); });
    if (found == items_.end()) return;
    bytes_ -= found->bytes;
    items_.erase(found);
  }
  void clear() { *this = {}; }

 private:
  struct Entry {
    Item item;
    std::size_t bytes;
  };
  std::deque<Entry> items_;
  std::size_t bytes_ = 0;
};

}  // namespace bridges
