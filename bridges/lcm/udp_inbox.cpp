// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/udp_inbox.hpp"

#include <linux/filter.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "bridges/lcm/lcm_reassembly.hpp"

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

namespace {

// The filter sees the UDP header, then the datagram.
constexpr std::uint32_t udp_header_bytes = 8;
constexpr std::uint32_t short_channel_at = udp_header_bytes + 8;
constexpr std::uint32_t fragment_number_at = udp_header_bytes + 16;
constexpr std::uint32_t fragment_channel_at = udp_header_bytes + 20;
constexpr std::uint32_t max_words = 4;
// FNV-1a, by words of 4 bytes.
constexpr std::uint32_t hash_start = 2166136261u;
constexpr std::uint32_t hash_factor = 16777619u;
/// Return value to accept: 0x40000, more bytes than a datagram has, so that all of it passes.
constexpr std::uint32_t pass = 0x40000;
constexpr std::size_t hashes_per_leaf = 8;

/// Computes the hash in the same way as the filter.
std::uint32_t hash_of(std::string_view channel) {
  std::uint32_t hash = hash_start;
  for (std::uint32_t word = 0; word < max_words; ++word) {
    std::uint32_t value = 0;
    for (std::size_t i = 4 * word; i < 4 * word + 4; ++i)
      value = value << 8 | (i < channel.size() ? static_cast<unsigned char>(channel[i]) : 0u);
    hash = (hash ^ value) * hash_factor;
    if (channel.size() < 4 * word + 4) break;
  }
  return hash;
}

class Program {
 public:
  void add(int code, std::uint32_t value = 0) { add_jump(code, value, 0, 0); }
  void add_jump(int code, std::uint32_t value, std::size_t if_true, std::size_t if_false) {
    steps.push_back({static_cast<std::uint16_t>(code), static_cast<std::uint8_t>(if_true),
                     static_cast<std::uint8_t>(if_false), value});
  }
  void load_word(std::uint32_t offset) { add(BPF_LD | BPF_W | BPF_ABS, offset); }
  void answer(std::uint32_t bytes) { add(BPF_RET | BPF_K, bytes); }
  /// Returns `pass` when the datagram (with its UDP header) is shorter.
  void pass_if_shorter(std::uint32_t bytes) {
    add(BPF_LD | BPF_W | BPF_LEN);
    add_jump(BPF_JMP | BPF_JGE | BPF_K, bytes, 1, 0);
    answer(pass);
  }
  void add_to_hash() {
    add(BPF_ALU | BPF_XOR | BPF_X);
    add(BPF_ALU | BPF_MUL | BPF_K, hash_factor);
  }
  void hash_channel_at(std::uint32_t offset);
  void pass_if_one_of(std::span<const std::uint32_t> sorted);

  std::vector<sock_filter> steps;
};

/// Leaves the hash in the accumulator.
void Program::hash_channel_at(std::uint32_t offset) {
  constexpr std::array<std::uint32_t, 4> byte_masks{0xff000000, 0xff0000, 0xff00, 0xff};
  add(BPF_LDX | BPF_W | BPF_IMM, hash_start);
  // Hash whole words until one contains the end of the name.
  std::vector<std::array<std::size_t, 4>> ends;  // for each word: the jumps taken when byte 0, 1, 2, 3 ends the name
  for (std::uint32_t word = 0; word < max_words; ++word) {
    pass_if_shorter(offset + 4 * word + 4);
    load_word(offset + 4 * word);
    std::array<std::size_t, 4> jumps{};
    for (std::size_t i = 0; i < 4; ++i) {
      jumps[i] = steps.size();
      add_jump(BPF_JMP | BPF_JSET | BPF_K, byte_masks[i], 0, 0);
    }
    ends.push_back(jumps);
    add_to_hash();
    add(BPF_MISC | BPF_TAX);
  }
  // Hash the last, partial word: one block for each position of the end.
  std::vector<std::size_t> done{steps.size()};  // jumps to the end, with the hash in the accumulator
  add(BPF_JMP | BPF_JA);
  for (std::size_t i = 0; i < 4; ++i) {
    for (const auto& jumps : ends) steps[jumps[i]].jf = static_cast<std::uint8_t>(steps.size() - jumps[i] - 1);
    std::uint32_t before = 0;
    for (std::size_t byte = 0; byte < i; ++byte) before |= byte_masks[byte];
    add(BPF_ALU | BPF_AND | BPF_K, before);
    add_to_hash();
    done.push_back(steps.size());
    add(BPF_JMP | BPF_JA);
  }
  // Resolve the jumps to the end.
  for (const std::size_t jump : done) steps[jump].k = static_cast<std::uint32_t>(steps.size() - jump - 1);
}

/// Adds a binary search for the value of the accumulator.
void Program::pass_if_one_of(std::span<const std::uint32_t> sorted) {
  if (sorted.size() <= hashes_per_leaf) {
    for (std::size_t i = 0; i < sorted.size(); ++i)
      add_jump(BPF_JMP | BPF_JEQ | BPF_K, sorted[i], sorted.size() - i, 0);
    answer(0);
    return answer(pass);
  }
  const std::size_t middle = sorted.size() / 2;
  add_jump(BPF_JMP | BPF_JGE | BPF_K, sorted[middle], 0, 1);
  const std::size_t to_upper = steps.size();
  add(BPF_JMP | BPF_JA);
  pass_if_one_of(sorted.first(middle));
  steps[to_upper].k = static_cast<std::uint32_t>(steps.size() - to_upper - 1);
  pass_if_one_of(sorted.subspan(middle));
}

}  // namespace

std::vector<sock_filter> channel_filter(const std::vector<std::string>& channels) {
  std::vector<std::uint32_t> hashes;
  // Compute the sorted hashes of the channels.
  for (const std::string& channel : channels) hashes.push_back(hash_of(channel));
  std::sort(hashes.begin(), hashes.end());
  hashes.erase(std::unique(hashes.begin(), hashes.end()), hashes.end());

  // Drop datagrams that are not LCM or too short for a message; pass later fragments, which do not name their channel.
  Program program;
  program.add(BPF_LD | BPF_W | BPF_LEN);
  program.add_jump(BPF_JMP | BPF_JGE | BPF_K, short_channel_at + 2, 1, 0);
  program.answer(0);
  program.load_word(udp_header_bytes);
  program.add_jump(BPF_JMP | BPF_JEQ | BPF_K, short_magic, 3, 0);
  program.add_jump(BPF_JMP | BPF_JEQ | BPF_K, fragment_magic, 1, 0);
  program.answer(0);
  program.add_jump(BPF_JMP | BPF_JEQ | BPF_K, short_magic, 0, 1);
  const std::size_t to_short = program.steps.size();
  program.add(BPF_JMP | BPF_JA);
  // Fragments: pass later ones, and hash the channel of the first.
  program.pass_if_shorter(fragment_channel_at);
  program.add(BPF_LD | BPF_H | BPF_ABS, fragment_number_at);
  program.add_jump(BPF_JMP | BPF_JEQ | BPF_K, 0, 1, 0);
  program.answer(pass);
  program.hash_channel_at(fragment_channel_at);
  const std::size_t to_search = program.steps.size();
  program.add(BPF_JMP | BPF_JA);
  // Short messages: hash the channel.
  program.steps[to_short].k = static_cast<std::uint32_t>(program.steps.size() - to_short - 1);
  program.hash_channel_at(short_channel_at);
  program.steps[to_search].k = static_cast<std::uint32_t>(program.steps.size() - to_search - 1);
  // Pass datagrams with a hash in the list.
  program.pass_if_one_of(hashes);
  if (program.steps.size() > BPF_MAXINSNS) return {};
  return std::move(program.steps);
}

}  // namespace bridges
