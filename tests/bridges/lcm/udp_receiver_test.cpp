#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "bridges/lcm/lcm_listener.hpp"
#include "datagrams.hpp"
#include "lcm_test_support.hpp"

namespace bridges {
namespace {

using lcm_test::bytes_of;
using lcm_test::DatagramSocket;
using lcm_test::fragment_datagram;
using lcm_test::own_url;
using lcm_test::short_datagram;
using lcm_test::text_of;
using namespace std::chrono_literals;

DatagramSocket socket_to(const std::string& url) {
  const LcmEndpoint endpoint = lcm_endpoint(resolve_lcm_url(url));
  return {endpoint.address, endpoint.port};
}

/// How a process that listens to "a" ends when it gets these datagrams, and then the message "after them": 0 when it
/// hears this one.
int listener_after(const std::vector<sim::Bytes>& datagrams) {
  const std::string url = own_url();
  const pid_t child = fork();
  if (child == 0) {
    try {
      LcmListener listener(url);
      listener.listen("a");
      while (const auto message = listener.next(10s))
        if (text_of(message->payload) == "after them") _exit(0);
    } catch (const BusError& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    _exit(1);
  }
  const DatagramSocket out = socket_to(url);
  int status = 0;
  // Until it is up the datagrams are lost; it hears them when it hears the last.
  for (int i = 0; i < 1000 && waitpid(child, &status, WNOHANG) == 0; ++i) {
    for (const sim::Bytes& datagram : datagrams) EXPECT_TRUE(out.send(datagram));
    EXPECT_TRUE(out.send(short_datagram("a", "after them")));
    std::this_thread::sleep_for(10ms);
  }
  if (!WIFEXITED(status) && !WIFSIGNALED(status)) kill(child, SIGKILL);
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

TEST(UdpReceiver, AFragmentFarBeyondItsMessageDoesNoHarm) {
  const auto fragment = fragment_datagram({.message_bytes = 100'000,
                                           .offset = 0xffffffff,
                                           .number = 0,
                                           .count = 2,
                                           .channel = "a",
                                           .payload = std::string(50, 'x')});
  EXPECT_EQ(fragment.size(), 72u);
  EXPECT_EQ(listener_after({fragment}), 0) << "negative: the signal that killed it";
}

}  // namespace
}  // namespace bridges
