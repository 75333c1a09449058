// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/micromodem_packet.hpp"

#include <gmock/gmock.h>

#include "devices/comms/micromodem_protocol.hpp"
#include "tests/devices/comms/micromodem_host.hpp"

namespace {

using devices::MicromodemPacket;

TEST(MicromodemProtocol, PacketsSurviveTheWayThroughTheirText) {
  MicromodemPacket packet;
  packet.kind = MicromodemPacket::Kind::data;
  packet.source = 3, packet.destination = 127, packet.rate = 5, packet.ack = true, packet.frame_count = 2;
  packet.frames = {{true, sim::Bytes(3, std::byte{7})}, {false, sim::Bytes(256, std::byte{9})}};
  const auto again = MicromodemPacket::read(packet.code(), packet.payload());
  ASSERT_TRUE(again);
  EXPECT_EQ(again->code(), packet.code());
  EXPECT_EQ(again->frames[1].data, packet.frames[1].data);
  EXPECT_FALSE(MicromodemPacket::read(packet.code(), {}));
  EXPECT_FALSE(MicromodemPacket::read("msg 12 auv", {}));
}

}  // namespace
