#include "bridges/lcm/lcm_listener.hpp"

#include <lcm/lcm.h>

#include <algorithm>

namespace bridges {
namespace {

// Every LCM program says this to itself when it starts.
constexpr std::string_view self_test_channel = "LCM_SELF_TEST";

void keep(const lcm_recv_buf_t* buffer, const char* channel, void* user) {
  if (channel == self_test_channel) return;
  const auto* data = static_cast<const std::byte*>(buffer->data);
  static_cast<std::deque<Received>*>(user)->push_back(
      {channel, sim::Bytes(data, data + buffer->data_size), buffer->recv_utime});
}

}  // namespace

LcmListener::LcmListener(const std::string& url) : connection_(url) {}

void LcmListener::listen(const std::string& channel) {
  connection_.subscribe(literal_channel_pattern(channel), keep, &arrived_);
}

void LcmListener::listen_to_all() {
  connection_.subscribe(".*", keep, &arrived_);
}

std::optional<Received> LcmListener::next(std::chrono::milliseconds timeout) {
  using std::chrono::steady_clock;
  const auto deadline = steady_clock::now() + timeout;
  std::chrono::milliseconds left = timeout;
  while (arrived_.empty() && wait_readable(connection_.fd(), -1, left)) {
    if (!connection_.handle()) throw BusError("the connection to " + url() + " is lost");
    left = std::max(std::chrono::ceil<std::chrono::milliseconds>(deadline - steady_clock::now()), left * 0);
  }
  if (arrived_.empty()) return std::nullopt;
  Received message = std::move(arrived_.front());
  arrived_.pop_front();
  return message;
}

bool LcmListener::publish(std::string_view channel, std::span<const std::byte> payload) {
  if (channel.empty() || channel.size() > sim::Bus::max_channel_length || payload.size() > max_lcm_message_bytes)
    return false;
  return connection_.publish(std::string(channel).c_str(), payload);
}

}  // namespace bridges
