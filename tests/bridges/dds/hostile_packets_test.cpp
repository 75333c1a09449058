// SPDX-License-Identifier: BSD-3-Clause
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/dds/dds_participant.hpp"
#include "tests/bridges/dds/dds_test_support.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

// Packets of a hostile program on this machine, at the ports of a participant.  They are almost right, for others are
// dropped at their first bytes: participants and endpoints that match those of the victim, their data, acknowledgments
// and fragments, with lengths, counts and bytes that are wrong at random.

namespace {

using bridges::DdsNetwork;
using bridges::DdsParticipant;

constexpr const char* type = "std_msgs::msg::dds_::String_";

class Hostile {
 public:
  explicit Hostile(int domain) : port_(7400 + 250 * domain), socket_(socket(AF_INET, SOCK_DGRAM, 0)) {}
  ~Hostile() { close(socket_); }
  Hostile(const Hostile&) = delete;
  Hostile& operator=(const Hostile&) = delete;

  void send() {
    make();
    // The ports of discovery by multicast, and of discovery and data of the first two participants of a machine.
    static constexpr std::array<int, 5> offsets{0, 10, 11, 12, 13};
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(static_cast<std::uint16_t>(port_ + offsets[below(5)]));
    sendto(socket_, packet_.data(), packet_.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
  }

 private:
  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }
  /// The value, or sometimes any other.
  std::uint32_t about(std::uint32_t value) {
    return below(20) != 0 ? value : below(2) == 0 ? value + below(5) - 2 : static_cast<std::uint32_t>(random_());
  }
  void put(std::uint32_t value, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) packet_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  void put(std::initializer_list<int> bytes) {
    for (const int byte : bytes) packet_.push_back(static_cast<std::uint8_t>(byte));
  }
  /// Identity of an entity, as it is in RTPS.
  void put_entity(std::uint32_t entity) {
    for (int shift = 24; shift >= 0; shift -= 8) packet_.push_back(static_cast<std::uint8_t>(entity >> shift));
  }
  void put_prefix(std::uint32_t number) {
    put({1, 15, 7, 7, 7, 7, 7, 7, 7, 7, 7});
    put(number, 1);
  }
  void put_random(std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) put(static_cast<std::uint32_t>(random_()), 1);
  }
  void put_text(std::string_view text) {
    put(about(static_cast<std::uint32_t>(text.size() + 1)), 4);
    packet_.insert(packet_.end(), text.begin(), text.end());
    put(0, 1);
  }
  void put_sequence_number() {
    put(about(0), 4);
    put(about(1 + below(40)), 4);
  }
  void put_set() {
    put_sequence_number();
    const std::uint32_t bits = about(below(257));
    put(bits, 4);
    for (std::uint32_t i = 0; i < std::min(bits, 256u); i += 32) put(static_cast<std::uint32_t>(random_()), 4);
  }

  /// Begins a part with its length, which end() writes.
  void begin(std::uint32_t id, std::uint32_t flags, std::size_t bytes) {
    put(id, bytes == 4 ? 1 : 2);
    if (bytes == 4) put(flags, 1);
    put(0, 2);
    begun_.push_back(packet_.size());
  }
  void end() {
    while ((packet_.size() - begun_.back()) % 4 != 0) put(0, 1);
    const std::uint32_t length = about(static_cast<std::uint32_t>(packet_.size() - begun_.back()));
    packet_[begun_.back() - 2] = static_cast<std::uint8_t>(length);
    packet_[begun_.back() - 1] = static_cast<std::uint8_t>(length >> 8);
    begun_.pop_back();
  }
  template <class Content>
  void parameter(std::uint32_t id, const Content& content) {
    if (below(30) == 0) return;
    begin(id, 0, 2);
    content();
    end();
  }
  void parameters(std::uint32_t writer) {
    put({0, 3, 0, 0});
    const auto guid = [&](std::uint32_t entity) {
      return [this, entity] {
        put_prefix(prefix_);
        put_entity(about(entity));
      };
    };
    const auto locator = [this] {
      put(about(1), 4);
      put(about(static_cast<std::uint32_t>(port_ + 100)), 4);
      put({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 127, 0, 0, 1});
    };
    parameter(0x15, [&] { put({2, 3, 0, 0}); });
    parameter(0x16, [&] { put({1, 15, 0, 0}); });
    if (writer == 0x100c2) {
      parameter(0x50, guid(0x1c1));
      for (const std::uint32_t id : {0x31u, 0x32u}) parameter(id, locator);
      parameter(0x02, [&] { put(about(20), 4), put(0, 4); });
      parameter(0x58, [&] { put(about(0xc3f), 4); });
    } else {
      parameter(0x5a, guid(writer == 0x3c2 ? 0x1203 : 0x1304));
      parameter(0x50, guid(0x1c1));
      parameter(0x05, [&] { put_text(writer == 0x3c2 ? "rt/in" : "rt/out"); });
      parameter(0x07, [&] { put_text(type); });
      parameter(0x1a, [&] { put(about(2), 4), put(0, 4), put(0, 4); });
      parameter(0x1d, [&] { put(about(below(2)), 4); });
      parameter(0x73, [&] { put(about(1), 4), put(0, 4); });
    }
    for (std::uint32_t i = below(4); i > 0; --i)
      parameter(about(below(0x80) | (below(8) == 0 ? 0x8000 : 0)), [&] { put_random(below(60)); });
    put(about(1), 2);
    put(0, 2);
  }
  std::uint32_t any_entity() {
    static constexpr std::array<std::uint32_t, 12> all{0x100c2, 0x100c7, 0x3c2, 0x3c7, 0x4c2,  0x4c7,
                                                       0x200c2, 0x200c7, 0x103, 0x104, 0x1203, 0x1304};
    return all[below(all.size())];
  }
  void data() {
    static constexpr std::array<std::uint32_t, 5> writers{0x100c2, 0x3c2, 0x4c2, 0x200c2, 0x1203};
    const std::uint32_t writer = writers[below(writers.size())];
    const bool is_fragment = below(6) == 0, has_qos = below(5) == 0;
    begin(is_fragment ? 0x16 : 0x15, about(is_fragment ? 1u | (has_qos ? 2 : 0) : 5u | (has_qos ? 2 : 0)), 4);
    put(0, 2);
    put(about(is_fragment ? 28 : 16), 2);
    put_entity(0);
    put_entity(writer);
    put_sequence_number();
    if (is_fragment) {
      put(about(1 + below(3)), 4);
      put(about(1), 2);
      put(about(1000), 2);
      put(about(3000), 4);
    }
    if (has_qos) {
      parameter(0x71, [&] { put({0, 0, 0, static_cast<int>(below(4))}); });
      put(about(1), 4);
    }
    if (writer == 0x1203 || writer == 0x200c2) {
      put({0, 1, 0, 0});
      put_random(below(2000));
    } else {
      parameters(writer);
    }
    end();
  }
  void part() {
    const std::uint32_t kind = below(10);
    if (kind < 5) return data();
    static constexpr std::array<std::uint32_t, 9> ids{0x06, 0x07, 0x08, 0x09, 0x0c, 0x0e, 0x12, 0x13, 0x01};
    const std::uint32_t id = about(ids[below(ids.size())]);
    begin(id, about(1 | (below(2) << 1)), 4);
    if (id == 0x09) {
      put_random(8);
    } else if (id == 0x0e || id == 0x0c) {
      put_prefix(below(8));
    } else {
      put_entity(any_entity());
      put_entity(any_entity());
      if (id == 0x06 || id == 0x08 || id == 0x12) put_set();
      put_sequence_number();
      put_sequence_number();
      put(below(1000), 4);
      if (id == 0x08) put_set();
    }
    end();
  }
  void make() {
    packet_.clear();
    begun_.clear();
    prefix_ = below(8);
    if (below(50) == 0) return put_random(below(1500));
    put({'R', 'T', 'P', 'S', 2, 3, 1, 15});
    put_prefix(prefix_);
    for (std::uint32_t i = 1 + below(4); i > 0; --i) part();
    if (below(4) == 0)
      for (std::uint32_t i = 1 + below(8); i > 0; --i)
        packet_[below(static_cast<std::uint32_t>(packet_.size()))] = static_cast<std::uint8_t>(random_());
  }

  const int port_, socket_;
  std::mt19937 random_{1};
  std::uint32_t prefix_ = 0;
  std::vector<std::uint8_t> packet_;
  std::vector<std::size_t> begun_;
};

std::vector<std::byte> message(int value) {
  return {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}, static_cast<std::byte>(value),
          std::byte{0}, std::byte{0}, std::byte{0}};
}

const std::vector<std::byte> sign_of_life = message(42), end_of_test = message(43);

/// Answers whatever comes, until the end of the test.
bool outlive(const DdsNetwork& network) {
  DdsParticipant participant(network, "");
  const auto in = participant.add_reader("rt/in", type, {});
  const auto out = participant.add_writer("rt/out", type, {});
  while (dds_test::next(participant, in) != end_of_test) participant.write(out, sign_of_life);
  return true;
}

/// SHOAL_HOSTILE_PACKETS sets the number of packets.
TEST(HostilePacketsTest, AParticipantOutlivesThem) {
  const DdsNetwork network = dds_test::own_network();
  dds_test::Peer victim([&] { return outlive(network); });
  DdsParticipant participant(network, "");
  const auto in = participant.add_writer("rt/in", type, {});
  const auto out = participant.add_reader("rt/out", type, {});
  ASSERT_TRUE(lcm_test::await([&] { return participant.has_readers(in); }));
  Hostile hostile(network.domain);
  const char* wanted = std::getenv("SHOAL_HOSTILE_PACKETS");
  for (long left = wanted == nullptr ? 20'000 : std::atol(wanted); left > 0; --left) hostile.send();
  EXPECT_TRUE(lcm_test::await([&] {
    participant.write(in, sign_of_life);
    return participant.take(out) == sign_of_life;
  }));
  participant.write(in, end_of_test);
  EXPECT_TRUE(victim.wait());
}

}  // namespace
