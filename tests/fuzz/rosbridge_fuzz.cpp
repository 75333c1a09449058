// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "bridges/rosbridge/rosbridge_command.hpp"
#include "bridges/rosbridge/rosbridge_protocol.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/utime_t.hpp"
#include "tests/fuzz/fuzz_input.hpp"

// Messages of a rosbridge client to a session with topics and commands: first byte whether it may control; then lines.

namespace {

using bridges::rosbridge::Protocol;

class RosbridgeLink final : public bridges::WebLink {
 public:
  int number() const override { return 1; }
  void wake() override {}
  void close(bridges::WebClose, std::string) override {}
};

void read_answers(bridges::WebSession& session) {
  bridges::WebFrame frame;
  while (session.next(frame)) {
    fuzz::require(frame.is_text, "a client of rosbridge gets JSON");
    fuzz::require(nlohmann::json::parse(*frame.bytes).contains("op"), "texts have an 'op'");
  }
}

}  // namespace

SHOAL_FUZZ_TARGET(rosbridge) {
  fuzz::Reader reader(input);
  const bool may_control = reader.below(2) == 1;
  std::vector<std::function<void()>> posted;
  Protocol protocol([&](std::function<void()> work) { posted.push_back(std::move(work)); }, may_control);
  const auto run = [&] {
    protocol.flush();
    for (const auto& work : std::exchange(posted, {})) work();
  };
  protocol.set_commands(bridges::rosbridge::command_topics(
      "a", {"a.drive.cmd", "a.joints.cmd"},
      {"shoal.twist_command_t, shoal.waypoints_command_t", "shoal.joint_frames_t, shoal.led_t, shoal.image_t"},
      [](std::string_view) { return true; }));
  protocol.message(0, "sim.clock", shoal::encode(shoal::utime_t{1}));
  run();
  RosbridgeLink link;
  const auto session = protocol.open(link);
  std::string_view text = fuzz::text_of(reader.rest());
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    session->receive(text.substr(0, end), true);
    text.remove_prefix(std::min(end + 1, text.size()));
    while (const auto request = protocol.take_request()) {
      fuzz::require(may_control, "a client without permission makes no request");
      if (request->kind == bridges::rosbridge::Request::Kind::service) protocol.reply(*request, true, "");
    }
    protocol.message(1, "sim.clock", shoal::encode(shoal::utime_t{1}));
    run();
    read_answers(*session);
  }
}
