// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/line_server.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <memory>

#include "bridges/base/bus_error.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/moos/small_moosdb.hpp"

namespace {

using bridges::LineServer;
using lcm_test::await;
using namespace std::chrono_literals;

/// A client with a plain socket.
class PlainClient {
 public:
  explicit PlainClient(int port) {
    const sockaddr_in address = moos_test::loopback(port);
    if (connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("cannot connect");
  }
  ~PlainClient() { close(fd_); }
  PlainClient(const PlainClient&) = delete;

  void write(const std::string& text) const {
    [[maybe_unused]] const auto sent = send(fd_, text.data(), text.size(), MSG_NOSIGNAL);
  }
  /// What comes until there are so many bytes, or the end.
  std::string read(std::size_t size) const {
    std::string text;
    std::array<char, 65536> bytes{};
    for (ssize_t count = 1; count > 0 && text.size() < size;) {
      count = recv(fd_, bytes.data(), std::min(bytes.size(), size - text.size()), 0);
      if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return text;
  }

 private:
  int fd_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
};

class LineServerTest : public testing::Test {
 protected:
  std::atomic<int> connected_ = 0;
  LineServer server_{0, {[this] { ++connected_; }, [](const std::string& bytes) { return "got " + bytes; }}};
};

TEST_F(LineServerTest, AnswersAndSends) {
  const PlainClient client(server_.port());
  client.write("hello\n");
  EXPECT_EQ(client.read(10), "got hello\n");
  server_.send("more");
  EXPECT_EQ(client.read(4), "more");
}

TEST_F(LineServerTest, HasOneClientAtATimeAndThenTheNext) {
  auto first = std::make_unique<PlainClient>(server_.port());
  ASSERT_TRUE(await([&] { return connected_ == 1; }, 120s));
  const PlainClient second(server_.port());
  EXPECT_EQ(second.read(1), "");  // it is closed
  first.reset();
  // The server sees the end of the first in its own time.
  EXPECT_TRUE(await(
      [&] {
        const PlainClient next(server_.port());
        next.write("a\n");
        return next.read(6) == "got a\n";
      },
      120s));
}

TEST_F(LineServerTest, DropsAClientThatDoesNotRead) {
  const PlainClient client(server_.port());
  ASSERT_TRUE(await([&] { return connected_ == 1; }, 120s));
  // More than the buffers of both sockets take.
  const std::string much(1 << 16, 'x');
  for (int i = 0; i < 1000; ++i) server_.send(much);
  EXPECT_LT(client.read(std::size_t{1000} << 16).size(), std::size_t{1000} << 16);  // up to its end
}

TEST_F(LineServerTest, SaysThatItsPortIsTaken) {
  EXPECT_THROW(LineServer(server_.port(), {}), bridges::BusError);
}

}  // namespace
