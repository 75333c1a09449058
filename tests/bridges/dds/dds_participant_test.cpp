// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/dds/dds_participant.hpp"

#include <arpa/inet.h>
#include <dds/dds.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <string>
#include <thread>

#include "tests/bridges/dds/dds_test_support.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using bridges::DdsNetwork;
using bridges::DdsParticipant;
using dds_test::next;
using dds_test::own_network;

constexpr const char* type = "std_msgs::msg::dds_::String_";

/// Little-endian CDR with these bytes behind the header.
std::vector<std::byte> message(std::size_t size, std::uint8_t value) {
  std::vector<std::byte> bytes(4 + size, std::byte{value});
  bytes[0] = bytes[2] = bytes[3] = std::byte{0};
  bytes[1] = std::byte{1};
  return bytes;
}

/// Sends back what comes, until a message of one byte comes.
bool echo(const DdsNetwork& network) {
  DdsParticipant participant(network, "");
  const auto back = participant.add_writer("rt/back", type, {});
  const auto out = participant.add_reader("rt/out", type, {});
  if (!lcm_test::await([&] { return participant.has_readers(back); })) return false;
  for (;;) {
    const auto bytes = next(participant, out);
    if (!participant.write(back, bytes)) return false;
    if (bytes.size() == 8 && bytes[4] == std::byte{255}) break;
  }
  // A writer that goes takes along what was not read: the other one goes first.
  return lcm_test::await([&] { return !participant.has_readers(back); });
}

TEST(DdsParticipantTest, MessagesOfAnySizeReachAnotherProcessAsTheyAre) {
  const DdsNetwork network = own_network();
  dds_test::Peer peer([&] { return echo(network); });
  {
    DdsParticipant participant(network, "enclave=/;");
    const auto out = participant.add_writer("rt/out", type, {});
    const auto back = participant.add_reader("rt/back", type, {});
    ASSERT_TRUE(lcm_test::await([&] { return participant.has_readers(out); }));
    std::uint8_t value = 1;
    for (const std::size_t size : {4u, 60u, 1500u, 15'996u, 70'000u, 900'000u}) {
      ASSERT_TRUE(participant.write(out, message(size, value)));
      EXPECT_EQ(next(participant, back), message(size, value)) << size;
      ++value;
    }
    // RTPS pads to four bytes.
    ASSERT_TRUE(participant.write(out, message(5, value)));
    auto padded = next(participant, back);
    ASSERT_EQ(padded.size(), 12u);
    padded.resize(9);
    EXPECT_EQ(padded, message(5, value));
    ASSERT_TRUE(participant.write(out, message(4, 255)));
    EXPECT_EQ(next(participant, back), message(4, 255));
  }
  EXPECT_TRUE(peer.wait());
}

TEST(DdsParticipantTest, ALaterReaderGetsTheLastMessageOfALatchedTopic) {
  const DdsNetwork network = own_network();
  dds_test::Peer peer([&] {
    DdsParticipant participant(network, "");
    const auto reader = participant.add_reader("rt/latched", type, {1, true, ""});
    return next(participant, reader) == message(8, 7);
  });
  DdsParticipant participant(network, "");
  const auto writer = participant.add_writer("rt/latched", type, {1, true, ""});
  EXPECT_FALSE(participant.has_readers(writer));
  EXPECT_TRUE(participant.write(writer, message(8, 6)));
  EXPECT_TRUE(participant.write(writer, message(8, 7)));
  EXPECT_TRUE(peer.wait());
}

/// As a program of ROS 2 whose user has set nothing: at the interface that Cyclone DDS takes, with its own ports.
/// Finds the writer of a topic, which arrives only after both have found each other.
bool find_with_default_settings(const std::string& topic) {
  unsetenv("CYCLONEDDS_URI");
  const auto domain = static_cast<dds_domainid_t>(dds_test::own_domain());
  const dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
  const dds_entity_t writers = dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  const bool found = lcm_test::await([&] {
    void* sample = nullptr;
    dds_sample_info_t info{};
    bool is_it = false;
    while (dds_take(writers, &sample, &info, 1, 1) == 1) {
      is_it = is_it || (info.valid_data && static_cast<dds_builtintopic_endpoint_t*>(sample)->topic_name == topic);
      dds_return_loan(writers, &sample, 1);
    }
    return is_it;
  });
  dds_delete(participant);
  return found;
}

TEST(DdsParticipantTest, AParticipantWithDefaultSettingsFindsIt) {
  const DdsNetwork network = own_network();
  dds_test::Peer peer([] { return find_with_default_settings("rt/out"); });
  DdsParticipant participant(network, "");
  participant.add_writer("rt/out", type, {});
  EXPECT_TRUE(peer.wait());
}

TEST(DdsParticipantTest, StopEndsTheWait) {
  DdsParticipant participant(own_network(), "");
  std::thread waits([&] { EXPECT_FALSE(participant.wait()); });
  participant.stop();
  waits.join();
}

TEST(DdsParticipantTest, AnEndpointThatWasRemovedIsNoLongerWritten) {
  DdsParticipant participant(own_network(), "");
  const auto writer = participant.add_writer("rt/a", type, {});
  EXPECT_TRUE(participant.write(writer, message(4, 1)));
  participant.remove(writer);
  EXPECT_FALSE(participant.write(writer, message(4, 1)));
}

/// Where the sockets of this process receive: their addresses and interfaces.
std::vector<std::string> receiving() {
  std::vector<std::string> places;
  for (int fd = 0; fd < 1024; ++fd) {
    sockaddr_in name{};
    socklen_t size = sizeof name;
    if (getsockname(fd, reinterpret_cast<sockaddr*>(&name), &size) != 0 || name.sin_family != AF_INET) continue;
    std::array<char, 32> address{}, device{};
    size = device.size();
    getsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, device.data(), &size);
    places.push_back(std::string(inet_ntop(AF_INET, &name.sin_addr, address.data(), address.size())) + " " +
                     device.data());
  }
  return places;
}

TEST(DdsParticipantTest, WithoutPeersNoSocketIsOpenToOtherMachines) {
  const DdsParticipant participant(own_network(), "");
  EXPECT_THAT(receiving(), testing::AllOf(testing::SizeIs(testing::Ge(3)), testing::Each(testing::EndsWith(" lo"))));
}

}  // namespace
