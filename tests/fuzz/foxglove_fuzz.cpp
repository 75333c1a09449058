// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "bridges/foxglove/foxglove_message.hpp"
#include "bridges/foxglove/foxglove_protocol.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/utime_t.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Messages of a Foxglove client to a session with a topic: first byte what it may control; then each message: a byte
// whether it is binary, two with its length.

namespace {

using bridges::foxglove::Control;
using bridges::foxglove::Protocol;
using bridges::foxglove::Request;

class FoxgloveLink final : public bridges::WebLink {
 public:
  int number() const override { return 1; }
  void wake() override {}
  void close(bridges::WebClose, std::string) override {}
};

void read_all(bridges::WebSession& session) {
  bridges::WebFrame frame;
  while (session.next(frame)) {
    fuzz::require(!frame.bytes->empty(), "a client gets no empty message");
    if (frame.is_text) fuzz::require(nlohmann::json::parse(*frame.bytes).contains("op"), "texts have an 'op'");
  }
}

}  // namespace

SHOAL_FUZZ_TARGET(foxglove) {
  fuzz::Reader reader(input);
  const auto control = static_cast<Control>(reader.below(3));
  std::vector<std::function<void()>> posted;
  Protocol protocol([&](std::function<void()> work) { posted.push_back(std::move(work)); });
  const auto run = [&] {
    protocol.flush();
    for (const auto& work : std::exchange(posted, {})) work();
  };
  protocol.introduce({"fuzz", "session", {}, control, 0, 1});
  protocol.message(0, "a.clock", shoal::encode(shoal::utime_t{1}));
  run();
  FoxgloveLink link;
  const auto session = protocol.open(link);
  read_all(*session);
  // Messages, the replies to their requests, and a message of the topic
  const std::string_view text = fuzz::text_of(reader.rest());
  for (std::size_t at = 0; at + 3 <= text.size();) {
    const bool is_binary = (text[at] & 1) != 0;
    const std::size_t size = static_cast<unsigned char>(text[at + 1]) + 256u * static_cast<unsigned char>(text[at + 2]);
    session->receive(text.substr(at + 3, size), !is_binary);
    at += 3 + size;
    std::size_t requests = 0;
    while (const auto request = protocol.take_request()) {
      ++requests;
      fuzz::require(control != Control::none, "a client without permission makes no request");
      fuzz::require((request->kind == Request::Kind::playback) == (control == Control::playback), "logs are played");
      protocol.reply(*request, true, "");
    }
    fuzz::require(requests <= Protocol::max_waiting_requests, "waiting requests are bounded");
    protocol.message(1, "a.clock", shoal::encode(shoal::utime_t{1}));
    run();
    read_all(*session);
  }
}
