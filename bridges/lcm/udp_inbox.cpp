// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/udp_inbox.hpp"

#include <linux/filter.h>

#include <algorithm>

#include "bridges/lcm/channel_filter.hpp"

namespace bridges {
namespace {

/// Number of unmatched messages since the last change of the subscriptions above which a filter is set.
constexpr std::uint64_t min_unmatched_for_filter = 64;
/// Delay of the filter after a change, so that it is not rebuilt repeatedly while vehicles are added and removed.
constexpr std::chrono::milliseconds quiet_before_filter{100};

}  // namespace

void UdpInbox::add(const Subscription& subscription) {
  const std::lock_guard lock(mutex_);
  (subscription.channel.empty() ? to_all_ : by_channel_[subscription.channel])
      .push_back({&subscription, subscription.handler, subscription.user});
  subscriptions_changed();
}

void UdpInbox::remove(const Subscription& subscription) {
  const std::lock_guard lock(mutex_);
  const auto is_it = [&](const Call& each) { return each.of == &subscription; };
  if (subscription.channel.empty()) {
    std::erase_if(to_all_, is_it);
  } else if (const auto channel = by_channel_.find(subscription.channel); channel != by_channel_.end()) {
    std::erase_if(channel->second, is_it);
    if (channel->second.empty()) by_channel_.erase(channel);
  }
  subscriptions_changed();
}

void UdpInbox::subscriptions_changed() {
  // Remove the filter immediately: an outdated one would drop messages of new subscriptions.
  if (filtering_) receiver_.set_filter({});
  filtering_ = filter_refused_ = false;
  changed_at_ = Clock::now();
}

bool UdpInbox::handle() {
  const bool more = receiver_.receive(
      [this](std::string_view channel) {
        const bool is_subscribed = accepts(channel);
        if (!is_subscribed) ++unmatched_;
        return is_subscribed;
      },
      [this](const LcmReassembly::Message& message, std::int64_t at_us) { deliver(message, at_us); });
  received_bytes_ = receiver_.counts().bytes;
  // Datagrams without a subscriber cost a wake-up each; a filter in the kernel pays once there are many.
  if (unmatched_ - unmatched_before_ >= min_unmatched_for_filter) filter_if_worthwhile();
  return more;
}

bool UdpInbox::accepts(std::string_view channel) const {
  const std::lock_guard lock(mutex_);
  return !to_all_.empty() || by_channel_.contains(channel);
}

void UdpInbox::deliver(const LcmReassembly::Message& message, std::int64_t received_at_us) {
  called_.clear();
  {
    const std::lock_guard lock(mutex_);
    if (const auto channel = by_channel_.find(message.channel); channel != by_channel_.end()) called_ = channel->second;
    called_.insert(called_.end(), to_all_.begin(), to_all_.end());
  }
  if (called_.empty()) ++unmatched_;
  for (const Call& each : called_) each.handler({message.channel, message.payload, received_at_us}, each.user);
}

void UdpInbox::filter_if_worthwhile() {
  const std::lock_guard lock(mutex_);
  if (filtering_ || filter_refused_ || !to_all_.empty() || Clock::now() - changed_at_ < quiet_before_filter) return;
  unmatched_before_ = unmatched_;
  std::vector<std::string> channels;
  for (const auto& [channel, subscriptions] : by_channel_) channels.push_back(channel);
  auto program = channel_filter(channels);
  filtering_ = !program.empty() && receiver_.set_filter(std::move(program));
  filter_refused_ = !filtering_;
}

UdpInbox::Counts UdpInbox::counts() const {
  return {receiver_.counts().datagrams, receiver_.counts().foreign, receiver_.reassembly_counts().bad, unmatched_};
}

}  // namespace bridges
