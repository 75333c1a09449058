// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/bus/lcm_bus.hpp"

#include <lcm/lcm.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "bridges/base/poll_set.hpp"
#include "bridges/bus/outgoing_sender.hpp"
#include "sim/base/log.hpp"

namespace bridges {

/// Parts of LcmBus; not in an unnamed namespace, because LcmBus::Threads contains it.
namespace lcm_bus {

constexpr std::size_t max_echoes = 4096;

class ChannelMailbox;

/// Mailboxes of one channel.  They share one LCM subscription, which ends with the last of them; the channel object
/// remains, because the LCM thread may be about to use it.
struct Channel {
  Channel(std::string channel_name, std::function<void()> on_arrival, std::function<void(Channel&)> on_unused)
      : name(std::move(channel_name)), arrived(std::move(on_arrival)), unused(std::move(on_unused)) {}

  /// Delivers a message from the network.  Echoes of own messages are dropped, because deliver_own() has delivered them
  /// already.
  void deliver(std::span<const std::byte> payload);
  /// Delivers an own message immediately, so that messages of the world to itself arrive at the same step in every run.
  void deliver_own(std::span<const std::byte> payload);

  /// Requires the lock.
  void give_out(sim::Message message);

  const std::string name;
  const std::function<void()> arrived;
  const std::function<void(Channel&)> unused;
  LcmSubscription* subscription = nullptr;
  std::mutex mutex;  // also protects the contents of the mailboxes
  std::vector<ChannelMailbox*> mailboxes;
  std::deque<std::size_t> echoes;  // hashes of own messages whose echo is expected
  std::atomic<std::uint64_t> received = 0;
  std::atomic<std::uint64_t> dropped = 0;
};

class ChannelMailbox final : public sim::Mailbox {
 public:
  ChannelMailbox(Channel& channel, std::size_t capacity)
      : channel_(channel), capacity_(std::max<std::size_t>(capacity, 1)) {
    const std::lock_guard lock(channel_.mutex);
    channel_.mailboxes.push_back(this);
  }

  ~ChannelMailbox() override {
    {
      const std::lock_guard lock(channel_.mutex);
      std::erase(channel_.mailboxes, this);
      if (!channel_.mailboxes.empty()) return;
      channel_.echoes.clear();
    }
    channel_.unused(channel_);
  }

  std::optional<sim::Message> take() override {
    // Most mailboxes are empty in most steps: check that without the lock.
    if (size_.load(std::memory_order_acquire) == 0) return std::nullopt;
    const std::lock_guard lock(channel_.mutex);
    sim::Message message = std::move(messages_.front());
    messages_.pop_front();
    size_.store(messages_.size(), std::memory_order_release);
    return message;
  }

  std::uint64_t dropped() const override { return dropped_.load(std::memory_order_relaxed); }

  void raise_on_arrival(std::shared_ptr<std::atomic<bool>> flag) override {
    const std::lock_guard lock(channel_.mutex);
    if (!messages_.empty()) flag->store(true, std::memory_order_release);
    flag_ = std::move(flag);
  }

  /// Requires the lock of the channel.
  void add(sim::Message message) {
    if (messages_.size() == capacity_) {
      messages_.pop_front();
      dropped_.fetch_add(1, std::memory_order_relaxed);
      channel_.dropped.fetch_add(1, std::memory_order_relaxed);
    }
    messages_.push_back(std::move(message));
    size_.store(messages_.size(), std::memory_order_release);
    if (flag_) flag_->store(true, std::memory_order_release);
  }

 private:
  Channel& channel_;
  const std::size_t capacity_;
  std::deque<sim::Message> messages_;
  std::atomic<std::size_t> size_ = 0;
  std::shared_ptr<std::atomic<bool>> flag_;  // protected by the lock of the channel
  std::atomic<std::uint64_t> dropped_ = 0;
};

std::size_t hash_of(std::span<const std::byte> payload) {
  return std::hash<std::string_view>()({reinterpret_cast<const char*>(payload.data()), payload.size()});
}

void Channel::deliver(std::span<const std::byte> payload) {
  {
    const std::lock_guard lock(mutex);
    if (!echoes.empty()) {
      // The network keeps the order, so echoes before the received one are lost.
      const auto echo = std::find(echoes.begin(), echoes.end(), hash_of(payload));
      if (echo != echoes.end()) {
        echoes.erase(echoes.begin(), echo + 1);
        return;
      }
    }
    if (mailboxes.empty()) return;
    give_out({name, sim::Bytes(payload.begin(), payload.end()), true});
  }
  arrived();
}

void Channel::deliver_own(std::span<const std::byte> payload) {
  {
    const std::lock_guard lock(mutex);
    if (mailboxes.empty()) return;
    if (echoes.size() == max_echoes) echoes.pop_front();
    echoes.push_back(hash_of(payload));
    give_out({name, sim::Bytes(payload.begin(), payload.end()), false});
  }
  arrived();
}

void Channel::give_out(sim::Message message) {
  received.fetch_add(1, std::memory_order_relaxed);
  for (std::size_t i = 0; i + 1 < mailboxes.size(); ++i) mailboxes[i]->add(message);
  mailboxes.back()->add(std::move(message));
}

void on_message(const LcmMessage& message, void* user) {
  static_cast<Channel*>(user)->deliver(message.payload);
}

}  // namespace lcm_bus

using namespace lcm_bus;

struct LcmBus::Threads final : Arrivals::Port {
  Threads(const std::string& url, const LcmBusOptions& chosen)
      : options(chosen),
        connection(url),
        outgoing(options.outgoing, [this](const OutgoingQueue::Entry& message) { send(message); }),
        stop_fd(eventfd(0, EFD_CLOEXEC)) {
    if (stop_fd < 0) throw BusError("no file descriptor is available for the bus");
    if (!options.arrivals) options.arrivals = std::make_shared<Arrivals>();
    // Added before the receiver: the first of the two wakes.
    place.emplace(*options.arrivals, *this, connection.may_block() ? -1 : connection.fd());
    readable.add(connection.fd(), this);
    readable.add(stop_fd, nullptr);
    receiver = std::thread([this] { receive_all(); });
  }

  ~Threads() {
    place.reset();
    outgoing.close([this] { cut_off(); });
    stopping = true;
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = write(stop_fd, &one, sizeof(one));
    receiver.join();
    close(stop_fd);
  }

  /// Ends a connection in which a message is stuck.  liblcm may not be called again: it would connect again, and wait
  /// for the answer of a server that may never come.
  void cut_off() {
    const std::unique_lock lock(receive_mutex, std::chrono::seconds(1));  // the receiver may be stuck too
    connected = false;
    connection.shut_down();
  }

  void send(const OutgoingQueue::Entry& message) {
    bool sent = false;
    if (connected) {
      // tcpq writes subscriptions into the same stream.
      const std::lock_guard lock(transmit_mutex);
      sent = connection.publish(message.channel.c_str(), message.payload);
    }
    if (!sent) count_refused();
  }

  void send_queued() override {
    if (connection.may_block())
      outgoing.wake();
    else
      outgoing.help();
  }

  /// Returns the channel of this name, which exists until the end.
  Channel& channel_of(const std::string& name) {
    const std::lock_guard lock(channels_mutex);
    std::unique_ptr<Channel>& channel = channels[name];
    if (!channel)
      channel = std::make_unique<Channel>(
          name, [arrivals = options.arrivals.get()] { arrivals->arrived(); },
          [this](Channel& unused) { close_channel(unused); });
    return *channel;
  }

  Channel& subscribe(const std::string& name) {
    Channel& channel = channel_of(name);
    const std::lock_guard transmit(transmit_mutex);
    if (channel.subscription == nullptr) channel.subscription = connection.subscribe(name, on_message, &channel);
    return channel;
  }

  /// Counts a message; returns false when it is too long for LCM.
  bool accept(std::string_view channel, std::span<const std::byte> payload) {
    published.fetch_add(1, std::memory_order_relaxed);
    if (payload.size() <= options.max_message_bytes) return true;
    refused.fetch_add(1);
    if (!warned_of_size.exchange(true))
      sim::log_warn("channel {}: message of {} bytes is not sent; LCM carries at most {} bytes", channel,
                    payload.size(), options.max_message_bytes);
    return false;
  }

  void close_channel(Channel& channel) {
    const std::lock_guard transmit(transmit_mutex);
    if (channel.subscription != nullptr) connection.unsubscribe(std::exchange(channel.subscription, nullptr));
  }

  Channel* find_channel(std::string_view name) const {
    const std::lock_guard lock(channels_mutex);
    const auto found = channels.find(name);
    return found == channels.end() ? nullptr : found->second.get();
  }

  void count_refused() {
    if (refused.fetch_add(1) == 0)
      sim::log_warn("LCM did not send a message on {}; further failures are only counted", connection.url());
  }

  void receive_all() {
    GatherPauses pauses(connection);
    while (!stopping) {
      const bool has_arrivals = readable.wait(pauses.wait()).count > 0;
      if (stopping || (has_arrivals && !receive())) return;
      // A thread that waits for messages still receives them immediately.
      if (pauses.due(has_arrivals)) wait_readable(stop_fd, -1, GatherPauses::length);
    }
  }

  bool receive() override {
    const std::lock_guard lock(receive_mutex);
    // Notify once: a waiting thread then reads its mailboxes while the messages are in the cache.
    if (connected && connection.handle() == LcmConnection::Handled::lost) {
      connected = false;
      sim::log_warn("the connection to {} is lost; messages are dropped from now on", connection.url());
    }
    return connected;
  }

  LcmBusOptions options;
  std::map<std::string, std::unique_ptr<Channel>, std::less<>> channels;  // outlives the handlers of the connection
  LcmConnection connection;
  std::mutex transmit_mutex;
  std::timed_mutex receive_mutex;
  mutable std::mutex channels_mutex;
  std::atomic<bool> stopping = false;
  std::atomic<bool> connected = true;
  std::atomic<bool> warned_of_size = false;
  std::atomic<std::uint64_t> published = 0;
  std::atomic<std::uint64_t> refused = 0;
  OutgoingSender outgoing;  // its thread uses the members above
  std::optional<Arrivals::Place> place;
  PollSet readable;
  int stop_fd = -1;
  std::thread receiver;
};

LcmBus::LcmBus(const std::string& url, const LcmBusOptions& options)
    : threads_(std::make_unique<Threads>(url, options)) {}

LcmBus::~LcmBus() = default;

namespace lcm_bus {

void check_channel(std::string_view channel) {
  if (channel.empty() || channel.size() > sim::Bus::max_channel_length)
    throw std::invalid_argument("a channel must have 1 to 63 characters, got '" + std::string(channel) + "'");
}

}  // namespace lcm_bus

void LcmBus::publish(std::string_view channel, std::span<const std::byte> payload, sim::Time) {
  check_channel(channel);
  if (!threads_->accept(channel, payload)) return;
  // Deliver before sending: the echo must not arrive first.
  if (Channel* own = threads_->find_channel(channel)) own->deliver_own(payload);
  threads_->outgoing.push(channel, payload);
}

class LcmBus::LookedUpChannel final : public sim::OpenChannel {
 public:
  LookedUpChannel(Threads& threads, Channel& own) : threads_(threads), own_(own) {}

  void publish(std::span<const std::byte> payload, sim::Time) override {
    if (!threads_.accept(own_.name, payload)) return;
    own_.deliver_own(payload);
    threads_.outgoing.push(own_.name, payload);
  }

 private:
  Threads& threads_;
  Channel& own_;
};

std::unique_ptr<sim::OpenChannel> LcmBus::open_channel(const std::string& channel) {
  check_channel(channel);
  return std::make_unique<LookedUpChannel>(*threads_, threads_->channel_of(channel));
}

std::unique_ptr<sim::Mailbox> LcmBus::open_mailbox(const std::string& channel, std::size_t capacity) {
  check_channel(channel);
  return std::make_unique<ChannelMailbox>(threads_->subscribe(channel), capacity);
}

void LcmBus::end_of_step() {
  threads_->outgoing.wake();
}

sim::BusCounts LcmBus::counts() const {
  sim::BusCounts counts;
  counts.published = threads_->published.load();
  counts.dropped_outgoing = threads_->outgoing.dropped() + threads_->refused.load();
  const std::lock_guard lock(threads_->channels_mutex);
  for (const auto& [name, channel] : threads_->channels) {
    counts.received += channel->received.load();
    counts.dropped_incoming += channel->dropped.load();
  }
  return counts;
}

bool LcmBus::wait_for_message(std::chrono::milliseconds timeout) {
  return threads_->options.arrivals->wait(timeout);
}

bool LcmBus::flush(std::chrono::milliseconds timeout) {
  return threads_->outgoing.wait_until_sent(timeout);
}

const std::string& LcmBus::url() const {
  return threads_->connection.url();
}

bool LcmBus::connected() const {
  return threads_->connected;
}

std::string lcm_version() {
  return std::to_string(LCM_MAJOR_VERSION) + "." + std::to_string(LCM_MINOR_VERSION) + "." +
         std::to_string(LCM_MICRO_VERSION);
}

}  // namespace bridges
