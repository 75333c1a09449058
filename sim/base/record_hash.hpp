// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace sim {

namespace record_hash_detail {

inline constexpr std::size_t max_words = 18;

/// Finalizer of SplitMix64.
constexpr std::uint64_t mixed(std::uint64_t word) {
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9ULL;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebULL;
  return word ^ (word >> 31);
}

/// Keys of the words: the sequence of splitmix64.
inline constexpr std::array<std::uint64_t, max_words> keys = [] {
  std::array<std::uint64_t, max_words> all{};
  std::uint64_t state = 0;
  for (std::uint64_t& key : all) key = mixed(state += 0x9e3779b97f4a7c15ULL);
  return all;
}();

/// Both halves of a product of 128 bits, folded.
constexpr std::uint64_t folded(std::uint64_t a, std::uint64_t b) {
  __extension__ using Wide = unsigned __int128;
  const Wide product = static_cast<Wide>(a) * b;
  return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}

}  // namespace record_hash_detail

/// Sum of products of pairs of words with keys, in the manner of the hash NH (Black et al., UMAC, 1999).  The products
/// do not wait for each other, which a chain would.  Not cryptographic.
template <std::size_t count>
constexpr std::uint64_t product_hash(const std::uint64_t (&words)[count]) {
  using record_hash_detail::folded, record_hash_detail::keys;
  static_assert(count % 2 == 0 && count <= record_hash_detail::max_words);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < count; i += 2) sum += folded(words[i] ^ keys[i], words[i + 1] ^ keys[i + 1]);
  return sum;
}

/// Hash of a record of a set.  That of the set is the sum over its records, which is updated when one is added, removed
/// or changed, and does not depend on their order.  Mixed, so that an exchange of words between records changes the
/// sum.
template <std::size_t count>
constexpr std::uint64_t record_hash(const std::uint64_t (&words)[count]) {
  return record_hash_detail::mixed(product_hash(words) + 0x9e3779b97f4a7c15ULL);
}

inline std::uint64_t word_of(double number) {
  return std::bit_cast<std::uint64_t>(number);
}
/// Two numbers of 32 bits in a word.
constexpr std::uint64_t word_of(int high, int low) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(high)) << 32 | static_cast<std::uint32_t>(low);
}

}  // namespace sim
