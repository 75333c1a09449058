// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lcm/tcpq_server.hpp"

#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "bridges/lcm/lcm_listener.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace bridges;
using namespace std::chrono_literals;
using lcm_test::await;
using lcm_test::bytes_of;
using testing::ElementsAre;
using testing::HasSubstr;

/// A server in its own thread, on a port that the kernel chooses.
class TcpqServerTest : public testing::Test {
 protected:
  void serve(TcpqServer::Options options = {}) {
    options.port = 0;
    server_ = std::make_unique<TcpqServer>(options, [this](const std::string& line) {
      const std::lock_guard lock(mutex_);
      lines_.push_back(line);
    });
    thread_ = std::thread([this] { server_->run(); });
  }
  ~TcpqServerTest() override {
    server_->stop();
    thread_.join();
  }
  std::string url() const { return "tcpq://127.0.0.1:" + std::to_string(server_->port()); }
  std::vector<std::string> lines() {
    const std::lock_guard lock(mutex_);
    return lines_;
  }
  /// Waits until the server takes a subscription: its answers to messages come back.
  void await_subscription(LcmListener& listener, const std::string& channel) {
    ASSERT_TRUE(await([&] {
      listener.publish(channel, bytes_of("first"));
      return listener.next(100ms).has_value();
    }));
    while (listener.next(200ms)) {
    }
  }

  std::unique_ptr<TcpqServer> server_;
  std::thread thread_;
  std::mutex mutex_;
  std::vector<std::string> lines_;
};

/// A client that sends any bytes.
class RawClient {
 public:
  explicit RawClient(std::uint16_t port) : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    EXPECT_EQ(connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~RawClient() { close(fd_); }
  void send(const std::string& bytes) const {
    EXPECT_EQ(::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
  }
  /// Whether the server ends the connection after what it still has sent.
  bool is_closed() const {
    std::array<char, 4096> part{};
    ssize_t size = 0;
    while ((size = recv(fd_, part.data(), part.size(), 0)) > 0) {
    }
    return size == 0 || errno == ECONNRESET;
  }

 private:
  int fd_;
};

std::string number(std::uint32_t value) {
  value = htonl(value);
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

const std::string hello = number(0x287617fb) + number(0x0100);

std::string subscription(const std::string& pattern) {
  return number(2) + number(static_cast<std::uint32_t>(pattern.size())) + pattern;
}

TEST_F(TcpqServerTest, EveryMessageOfAFastSenderArrivesCompleteAndInOrder) {
  serve();
  LcmListener sender(url()), receiver(url());
  receiver.listen("a.b");
  await_subscription(receiver, "a.b");
  constexpr int count = 20'000;
  std::thread sends([&] {
    for (int i = 0; i < count; ++i) sender.publish("a.b", bytes_of(std::to_string(i) + std::string(700, 'x')));
  });
  int next = 0;
  while (next < count) {
    const auto message = receiver.next(60s);
    if (!message) break;
    const std::string text(reinterpret_cast<const char*>(message->payload.data()), message->payload.size());
    if (text.size() < 700) continue;  // one of the first
    ASSERT_EQ(text, std::to_string(next) + std::string(700, 'x'));
    ++next;
  }
  sends.join();
  EXPECT_EQ(next, count);
  EXPECT_THAT(lines(), testing::IsEmpty());
}

TEST_F(TcpqServerTest, ARoundTripDoesNotWaitForAcknowledgementsOfTheKernel) {
  serve();
  LcmListener client(url());
  client.listen("a");
  await_subscription(client, "a");
  // The delayed acknowledgement of Linux is 40 ms; some are quick even on a busy machine.
  int quick = 0;
  for (int i = 0; i < 1000 && quick < 5; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    client.publish("a", bytes_of("x"));
    ASSERT_TRUE(client.next(60s));
    if (std::chrono::steady_clock::now() - begin < 10ms) ++quick;
  }
  EXPECT_GE(quick, 5);
}

TEST_F(TcpqServerTest, AClientThatDoesNotReadIsCutWithOneLineAndTheOthersGetAll) {
  TcpqServer::Options options;
  options.max_waiting_bytes = 4'000'000;
  serve(options);
  const RawClient frozen(server_->port());
  frozen.send(hello + subscription(".*"));
  LcmListener receiver(url());
  receiver.listen("a");
  await_subscription(receiver, "a");
  // More than its limit and the buffers of the kernel, which end at 10 MB
  constexpr int count = 200;
  const std::string large(100'000, 'x');
  for (int i = 0; i < count; ++i) {
    receiver.publish("a", bytes_of(large));
    ASSERT_TRUE(receiver.next(60s)) << i;
  }
  ASSERT_TRUE(await([&] { return !lines().empty(); }));
  EXPECT_THAT(lines(), ElementsAre(testing::MatchesRegex("client 127.0.0.1:[0-9]+ is disconnected: it did not read "
                                                         "[0-9]+ bytes that wait for it .limit 4000000.")));
}

TEST_F(TcpqServerTest, ForeignBytesEndTheirConnectionWithTheReason) {
  serve();
  const std::pair<std::string, const char*> foreign[] = {
      {"GET / HTTP/1.1\r\n\r\n", "it does not speak tcpq"},
      {hello + number(9) + number(1) + "a", "unknown request 9"},
      {hello + number(1) + number(64), "a channel must have at most 63 bytes, got 64"},
      {hello + number(1) + number(1) + "a" + number(0xffffffff),
       "a message must have at most 16777216 bytes, got 4294967295"},
      {hello + number(2) + number(257), "a pattern must have at most 256 bytes, got 257"},
      {hello + subscription("(a"), "a pattern is not an extended regular expression"},
      {hello + subscription("a{2}"), "a pattern must have no '{', no back reference and no zero byte"}};
  std::size_t known = 0;
  for (const auto& [bytes, reason] : foreign) {
    const RawClient client(server_->port());
    client.send(bytes);
    EXPECT_TRUE(client.is_closed());
    ASSERT_TRUE(await([&] { return lines().size() > known; })) << reason;
    EXPECT_THAT(lines()[known++], HasSubstr(std::string(" is disconnected: ") + reason));
  }
}

TEST_F(TcpqServerTest, LiblcmGetsTheNumericAddressOfAName) {
  serve();
  const std::string port = std::to_string(server_->port());
  EXPECT_EQ(require_tcp_server("", {"tcpq", "localhost", server_->port()}), "tcpq://127.0.0.1:" + port);
  LcmListener client("tcpq://localhost:" + port);
  client.listen("a");
  await_subscription(client, "a");
}

TEST_F(TcpqServerTest, TooManyClientsAreRefused) {
  TcpqServer::Options options;
  options.max_clients = 1;
  serve(options);
  const RawClient first(server_->port());
  const RawClient second(server_->port());
  EXPECT_TRUE(second.is_closed());
  ASSERT_TRUE(await([&] { return !lines().empty(); }));
  EXPECT_THAT(lines().back(), HasSubstr("the limit of 1 clients is reached"));
}

TEST(TcpqServer, APortThatIsTakenIsAnErrorThatNamesIt) {
  TcpqServer::Options options;
  options.port = 0;
  const TcpqServer server(options, [](const std::string&) {});
  options.port = server.port();
  try {
    const TcpqServer second(options, [](const std::string&) {});
    FAIL();
  } catch (const BusError& error) {
    EXPECT_EQ(std::string(error.what()),
              "tcpq server: cannot listen on 127.0.0.1:" + std::to_string(options.port) + ": Address already in use");
  }
  options.host = "localhost";
  EXPECT_THROW(TcpqServer(options, [](const std::string&) {}), BusError);
}

TEST(ChannelPatterns, AreForTheWholeNameAndCountHowOftenTheyWereAdded) {
  ChannelPatterns patterns;
  EXPECT_EQ(patterns.add("rover1\\.(gps|imu)"), std::nullopt);
  EXPECT_EQ(patterns.add("a.*"), std::nullopt);
  EXPECT_EQ(patterns.add("a.*"), std::nullopt);
  EXPECT_TRUE(patterns.matches("rover1.imu"));
  EXPECT_FALSE(patterns.matches("rover1.imu.truth"));
  EXPECT_FALSE(patterns.matches("rover1ximu"));
  EXPECT_TRUE(patterns.remove("a.*"));
  EXPECT_TRUE(patterns.matches("abc"));
  EXPECT_TRUE(patterns.remove("a.*"));
  EXPECT_FALSE(patterns.matches("abc"));
  EXPECT_FALSE(patterns.remove("a.*"));
  EXPECT_NE(patterns.add("(a)\\1"), std::nullopt);
  EXPECT_EQ(patterns.add("a\\.1"), std::nullopt);
}

}  // namespace
