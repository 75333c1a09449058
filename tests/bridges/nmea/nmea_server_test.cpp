// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/nmea_server.hpp"

#include <gmock/gmock.h>

#include <mutex>
#include <random>

#include "bridges/base/bus_error.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/nmea/nmea_peer.hpp"

namespace {

using bridges::nmea::NmeaServer;
using bridges::nmea::read_endpoint;
using lcm_test::await;
using nmea_test::Peer;
using testing::Contains;
using testing::HasSubstr;

/// A server at a free port of this machine, and its notes.
class TestServer {
 public:
  explicit TestServer(NmeaServer::Options options = {}) : server_(with_notes(std::move(options))) {}
  NmeaServer* operator->() { return &server_; }
  std::vector<std::string> notes() {
    const std::lock_guard lock(mutex_);
    return notes_;
  }
  bool await_note(const std::string& text, std::size_t count = 1) {
    return await([&] {
      std::size_t found = 0;
      for (const std::string& note : notes()) found += note.find(text) != std::string::npos ? 1 : 0;
      return found >= count;
    });
  }

 private:
  NmeaServer::Options with_notes(NmeaServer::Options options) {
    if (!options.listen && !options.udp) options.listen = {"127.0.0.1", 0};
    options.log = [this](const std::string& note) {
      const std::lock_guard lock(mutex_);
      notes_.push_back(note);
    };
    return options;
  }

  std::mutex mutex_;
  std::vector<std::string> notes_;
  NmeaServer server_;
};

/// Waits for the lines that clients send.
std::vector<std::string> await_lines(TestServer& server, std::size_t count) {
  std::vector<std::string> lines;
  await([&] {
    for (auto& line : server->take_lines()) lines.push_back(line.text);
    return lines.size() >= count;
  });
  return lines;
}

TEST(NmeaServer, SendsToAllClientsAndTakesTheirLines) {
  TestServer server;
  Peer one(server->port()), two(server->port());
  ASSERT_TRUE(server.await_note(" connected", 2));
  server->send({"$A*41", "$B*42"});
  for (Peer* peer : {&one, &two}) {
    EXPECT_EQ(peer->line(), "$A*41");
    EXPECT_EQ(peer->line(), "$B*42");
  }
  one.send("$ON");
  one.send("E\r\n\r\n$ONE2\n");
  EXPECT_THAT(await_lines(server, 2), testing::ElementsAre("$ONE", "$ONE2"));
  two.send("$TWO\r");
  EXPECT_THAT(await_lines(server, 1), testing::ElementsAre("$TWO"));
}

TEST(NmeaServer, AClientThatGoesLeavesTheOthers) {
  TestServer server;
  Peer stays(server->port());
  {
    const Peer leaves(server->port());
    ASSERT_TRUE(server.await_note(" connected", 2));
  }
  ASSERT_TRUE(server.await_note(" disconnected"));
  server->send({"$A*41"});
  EXPECT_EQ(stays.line(), "$A*41");
}

TEST(NmeaServer, ASlowClientIsCutWithOneNoteAndTheOthersGoOn) {
  TestServer server;
  Peer slow(server->port(), 4096), good(server->port());
  ASSERT_TRUE(server.await_note(" connected", 2));
  // What the kernel keeps for a connection, and what the server keeps, are some megabytes at most.
  const std::vector<std::string> lines(100, std::string(80, 'x'));
  bool is_cut = false;
  for (int i = 0; i < 10'000 && !is_cut; ++i) {
    server->send(lines);
    for (std::size_t taken = 0; taken < lines.size(); ++taken) ASSERT_TRUE(good.line());
    is_cut = !server.notes().empty() && server.notes().back().find("is cut") != std::string::npos;
  }
  EXPECT_TRUE(is_cut);
  server->send({"$LAST"});
  EXPECT_EQ(good.line(), "$LAST");
  const auto notes = server.notes();
  EXPECT_EQ(notes.size(), 3u);
  EXPECT_THAT(notes.back(), HasSubstr("is cut: it does not take what it is sent"));
}

TEST(NmeaServer, RefusesMoreClientsThanItsLimit) {
  TestServer server;
  std::vector<std::unique_ptr<Peer>> peers;
  for (std::size_t i = 0; i < NmeaServer::max_clients; ++i) peers.push_back(std::make_unique<Peer>(server->port()));
  ASSERT_TRUE(server.await_note(" connected", NmeaServer::max_clients));
  Peer more(server->port());
  EXPECT_EQ(more.line(), std::nullopt);
  EXPECT_TRUE(server.await_note("is refused: there are 32 clients"));
  peers.pop_back();
  ASSERT_TRUE(server.await_note(" disconnected"));
  Peer again(server->port());
  ASSERT_TRUE(server.await_note(" connected", NmeaServer::max_clients + 1));
  server->send({"$A*41"});
  EXPECT_EQ(again.line(), "$A*41");
}

TEST(NmeaServer, CutsAClientThatSendsTooMuchAndKeepsFewLines) {
  TestServer server;
  Peer flood(server->port());
  const std::string lines = "$XXHDT,1,T\n$\xff\xfe\n";
  std::string many;
  while (many.size() < 64 << 10) many += lines;
  for (int i = 0; i < 1000 && flood.send(many); ++i) continue;
  EXPECT_TRUE(server.await_note("is cut: it sent more than 65536 bytes in a second"));
  EXPECT_LE(server->take_lines().size(), NmeaServer::max_lines);
}

TEST(NmeaServer, SurvivesAnyBytesOfAHostilePeer) {
  TestServer server;
  std::minstd_rand random(7);
  for (int round = 0; round < 50; ++round) {
    Peer hostile(server->port());
    std::string bytes(1 + random() % 4000, '\0');
    for (char& c : bytes) c = random() % 8 == 0 ? '\n' : static_cast<char>(random());
    hostile.send(bytes);
    for (const auto& line : server->take_lines()) EXPECT_LE(line.text.size(), sim::NmeaLines::longest);
  }
  Peer good(server->port());
  ASSERT_TRUE(server.await_note(" connected", 51));
  server->send({"$A*41"});
  EXPECT_EQ(good.line(), "$A*41");
}

TEST(NmeaServer, SendsADatagramForEachLineAndTakesThoseOfItsPeer) {
  const bridges::FileDescriptor peer(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in own = nmea_test::loopback(0);
  socklen_t size = sizeof own;
  auto* address = reinterpret_cast<sockaddr*>(&own);
  ASSERT_EQ(bind(peer.number(), address, size), 0);
  ASSERT_EQ(getsockname(peer.number(), address, &size), 0);
  NmeaServer::Options options;
  options.udp = {"127.0.0.1", ntohs(own.sin_port)};
  TestServer server(options);
  EXPECT_EQ(server->port(), 0);
  server->send({"$A*41", "$B*42"});
  sockaddr_in from{};
  for (const char* text : {"$A*41\r\n", "$B*42\r\n"}) {
    pollfd readable{peer.number(), POLLIN, 0};
    ASSERT_EQ(poll(&readable, 1, 60'000), 1);
    char bytes[200];
    size = sizeof from;
    const ssize_t count = recvfrom(peer.number(), bytes, sizeof bytes, 0, reinterpret_cast<sockaddr*>(&from), &size);
    EXPECT_EQ(std::string(bytes, static_cast<std::size_t>(std::max<ssize_t>(count, 0))), text);
  }
  // A line in a datagram needs no end.  Those of others are not taken.
  const bridges::FileDescriptor other(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sendto(other.number(), "$OTHER\n", 7, 0, reinterpret_cast<sockaddr*>(&from), size);
  sendto(peer.number(), "$MINE", 5, 0, reinterpret_cast<sockaddr*>(&from), size);
  EXPECT_THAT(await_lines(server, 1), testing::ElementsAre("$MINE"));
}

TEST(NmeaServer, SaysWhyItCannotListen) {
  TestServer first;
  NmeaServer::Options options;
  options.listen = {"127.0.0.1", first->port()};
  try {
    const NmeaServer second(options);
    FAIL();
  } catch (const bridges::BusError& error) {
    EXPECT_EQ(error.what(),
              "NMEA: cannot listen at 127.0.0.1:" + std::to_string(first->port()) + ": Address already in use");
  }
}

TEST(NmeaServer, ReadsHostAndPort) {
  EXPECT_EQ(read_endpoint("127.0.0.1:10110").host, "127.0.0.1");
  EXPECT_EQ(read_endpoint("127.0.0.1:10110").port, 10110);
  EXPECT_EQ(read_endpoint("[::1]:7").host, "::1");
  for (const char* bad : {"", "10110", ":10110", "a:", "a:65536", "a:-1", "a:1x", "::1:7", "[]:7"})
    EXPECT_THROW(read_endpoint(bad), std::invalid_argument) << bad;
}

}  // namespace
