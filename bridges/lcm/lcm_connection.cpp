// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/lcm_connection.hpp"

#include <lcm/lcm.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

#include "bridges/lcm/udp_inbox.hpp"

namespace bridges {
namespace {

using namespace std::chrono_literals;

// Self test that every LCM program publishes at its start.
constexpr std::chrono::seconds self_test_limit{10};
constexpr int max_liblcm_batch = 25;

/// Returns the regular expression that matches this channel only.
std::string literal_channel_pattern(const std::string& channel) {
  std::string pattern;
  for (const char c : channel) {
    if (std::strchr("\\.[]{}()*+?^$|", c) != nullptr) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

void ignore_message(const lcm_recv_buf_t*, const char*, void*) {}

}  // namespace

struct LcmSubscription {
  UdpInbox::Subscription wish;
  lcm_subscription_t* of_liblcm = nullptr;
};

namespace {

void from_liblcm(const lcm_recv_buf_t* buffer, const char* channel, void* user) {
  const auto& wish = static_cast<const LcmSubscription*>(user)->wish;
  wish.handler({channel, {static_cast<const std::byte*>(buffer->data), buffer->data_size}, buffer->recv_utime},
               wish.user);
}

}  // namespace

struct LcmConnection::Subscriptions {
  std::mutex mutex;
  std::map<LcmSubscription*, std::unique_ptr<LcmSubscription>> all;
};

void LcmConnection::LcmDeleter::operator()(lcm_t* lcm) const {
  lcm_destroy(lcm);
}

LcmConnection::LcmConnection(const std::string& url)
    : url_(resolve_lcm_url(url)), subscriptions_(std::make_unique<Subscriptions>()) {
  const LcmEndpoint endpoint = lcm_endpoint(url_);
  is_tcp_ = endpoint.kind == "tcpq";
  // Checked here, so that the error of a missing server says how to start one.
  const std::string url_of_liblcm = is_tcp_ ? require_tcp_server(url_, endpoint) : url_;
  lcm_.reset(lcm_create(url_of_liblcm.c_str()));
  if (!lcm_) refuse_url(url_, "LCM cannot be used: no route for multicast, or the port is taken; run `shoal doctor`");
  if (endpoint.kind == "udpm")
    open_udp(endpoint);
  else
    open_liblcm_receiver();
}

LcmConnection::~LcmConnection() = default;

void LcmConnection::open_udp(const LcmEndpoint& endpoint) {
  try {
    udp_ = std::make_unique<UdpInbox>(UdpReceiver::Options{.group = endpoint.address,
                                                           .port = endpoint.port,
                                                           .buffer_bytes = endpoint.recv_buf_bytes,
                                                           .this_machine_only = endpoint.ttl == 0});
  } catch (const BusError& error) {
    refuse_url(url_, std::string("LCM cannot receive: ") + error.what() + "; run `shoal doctor`");
  }
  fd_ = udp_->fd();
  test_itself();
}

void LcmConnection::test_itself() {
  // Subscribe to the test channel with a unique text.
  struct Test {
    std::string reported = "shoal " + std::to_string(getpid()) + " " +
                           std::to_string(std::chrono::steady_clock::now().time_since_epoch().count());
    bool received = false;
  } test;
  LcmSubscription* own = subscribe(
      self_test_channel,
      [](const LcmMessage& message, void* user) {
        auto& waiting = *static_cast<Test*>(user);
        const std::string_view text(reinterpret_cast<const char*>(message.payload.data()), message.payload.size());
        waiting.received |= text == waiting.reported;
      },
      &test);
  // Publish the text until it is received.
  const auto deadline = std::chrono::steady_clock::now() + self_test_limit;
  while (!test.received && std::chrono::steady_clock::now() < deadline) {
    publish(self_test_channel, std::as_bytes(std::span(test.reported)));
    // Repeat, because it may be lost among other messages.
    const auto again = std::chrono::steady_clock::now() + 100ms;
    while (!test.received && std::chrono::steady_clock::now() < again)
      if (wait_readable(fd_, -1, 100ms)) handle();
  }
  unsubscribe(own);
  if (!test.received)
    refuse_url(
        url_,
        "LCM cannot receive its own messages (a firewall, or an interface without multicast); run `shoal doctor`");
}

void LcmConnection::open_liblcm_receiver() {
  // The first subscription starts the receiver of liblcm.
  lcm_subscription_t* probe = lcm_subscribe(lcm_.get(), "shoal\\.probe", ignore_message, nullptr);
  fd_ = probe == nullptr ? -1 : lcm_get_fileno(lcm_.get());
  if (fd_ < 0) refuse_url(url_, "LCM cannot receive; run `shoal doctor`");
  lcm_unsubscribe(lcm_.get(), probe);
}

LcmSubscription* LcmConnection::subscribe(const std::string& channel, Handler handler, void* user) {
  if (channel.empty()) throw BusError("LCM cannot subscribe to a channel without a name");
  return add(channel, handler, user);
}

LcmSubscription* LcmConnection::subscribe_to_all(Handler handler, void* user) {
  return add({}, handler, user);
}

LcmSubscription* LcmConnection::add(const std::string& channel, Handler handler, void* user) {
  auto subscription = std::make_unique<LcmSubscription>();
  subscription->wish = {channel, handler, user};
  LcmSubscription* added = subscription.get();
  {
    const std::lock_guard lock(subscriptions_->mutex);
    subscriptions_->all.emplace(added, std::move(subscription));
  }
  if (udp_) {
    udp_->add(added->wish);
    return added;
  }
  // liblcm takes channels as regular expressions.
  const std::string pattern = channel.empty() ? ".*" : literal_channel_pattern(channel);
  added->of_liblcm = lcm_subscribe(lcm_.get(), pattern.c_str(), from_liblcm, added);
  if (added->of_liblcm == nullptr)
    throw BusError("LCM cannot subscribe to '" + pattern + "' on " + url_ + "; run `shoal doctor`");
  // 0 is unlimited in liblcm: messages wait in Shoal's own queues, which count what they drop.
  lcm_subscription_set_queue_capacity(added->of_liblcm, 0);
  return added;
}

void LcmConnection::unsubscribe(LcmSubscription* subscription) {
  // Keep the object, because the liblcm thread may still use it.
  if (!udp_) return static_cast<void>(lcm_unsubscribe(lcm_.get(), subscription->of_liblcm));
  udp_->remove(subscription->wish);
  const std::lock_guard lock(subscriptions_->mutex);
  subscriptions_->all.erase(subscription);
}

bool LcmConnection::publish(const char* channel, std::span<const std::byte> payload) {
  return lcm_publish(lcm_.get(), channel, payload.data(), static_cast<unsigned>(payload.size())) == 0;
}

LcmConnection::Handled LcmConnection::handle() {
  if (udp_) return udp_->handle() ? Handled::more : Handled::all;
  for (int i = 0; i < max_liblcm_batch; ++i) {
    // Poll first: liblcm would wait for a message, which another thread may have taken.
    if (!wait_readable(fd_, -1, 0ms)) return Handled::all;
    if (lcm_handle(lcm_.get()) != 0 && lcm_get_fileno(lcm_.get()) < 0) return Handled::lost;
  }
  return Handled::more;
}

std::uint64_t LcmConnection::received_bytes() const {
  return udp_ ? udp_->received_bytes() : 0;
}

bool GatherPauses::due(bool has_arrivals) {
  const std::uint64_t bytes = connection_.received_bytes();
  const bool few = bytes - std::exchange(bytes_, bytes) <= max_bytes_of_check;
  polls_ = has_arrivals && few ? polls_ + 1 : 0;
  if (polls_ < polls_before_pause || connection_.may_block()) return false;
  polls_ = 0;
  return true;
}

void LcmConnection::shut_down() {
  if (is_tcp_) shutdown(fd_, SHUT_RDWR);
}

bool wait_readable(int first, int second, std::chrono::milliseconds timeout) {
  std::array<pollfd, 2> waiting{pollfd{first, POLLIN, 0}, pollfd{second, POLLIN, 0}};
  return poll(waiting.data(), second < 0 ? 1 : 2, static_cast<int>(timeout.count())) > 0;
}

}  // namespace bridges
