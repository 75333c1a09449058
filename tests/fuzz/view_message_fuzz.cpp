// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <nlohmann/json.hpp>

#include "bridges/web/client_message.hpp"
#include "bridges/web/view_protocol.hpp"
#include "bridges/web/web_error.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "viewer/page_data/message_frame.hpp"
#include "viewer/page_data/page_request.hpp"

// Messages of a page: each line is one, to a session of the live page; a line that begins with a zero byte is binary.
// The whole input is also the payload of a message that is shown on a page.

namespace {

class FuzzLink final : public bridges::WebLink {
 public:
  int number() const override { return 1; }
  void wake() override {}
  void close(bridges::WebClose, std::string) override {}
};

void check_message(std::string_view text) {
  fuzz::allow<bridges::WebError>([&] {
    const bridges::ClientMessage message = bridges::parse_client_message(text);
    fuzz::require(!message.op.empty() && message.op.size() <= 32, "the kind of a message is bounded");
    fuzz::require(message.token.size() <= 256 && message.id.size() <= 64, "what is kept of a message is bounded");
    const auto refusal = nlohmann::json::parse(bridges::refusal_message(message.id, text));
    fuzz::require(refusal.at("id").dump() == message.id, "a refusal has the id of the message");
  });
}

/// A request for a time is read or refused, and its numbers are bounded.
void check_look(const std::string& text) {
  fuzz::allow<std::runtime_error>([&] {
    const viewer::LookRequest look = viewer::parse_look(text);
    if (look.time_us)
      fuzz::require(std::abs(static_cast<double>(*look.time_us)) <= 1e18, "the time of a look is bounded");
    fuzz::require(look.branch.value_or(0) >= 0, "a branch has a number from 0 on");
  });
}

void check_subscribe(std::string_view text) {
  fuzz::allow<viewer::PageRequestError>([&] {
    const auto subscriptions = viewer::parse_subscribe(text);
    fuzz::require(subscriptions.size() <= viewer::max_subscriptions, "the channels of a page are bounded");
    for (const viewer::Subscription& each : subscriptions) {
      fuzz::require(!each.channel.empty() && each.channel.size() <= 63, "the name of a channel is bounded");
      fuzz::require(each.rate_hz > 0 && each.rate_hz <= viewer::max_subscription_rate_hz, "a rate is bounded");
    }
  });
}

void check_series(std::string_view text) {
  fuzz::allow<viewer::PageRequestError>([&] {
    const viewer::SeriesRequest series = viewer::parse_series(text);
    fuzz::require(series.from_us <= series.to_us, "a series has a range of time");
    fuzz::require(series.points >= 2 && series.points <= viewer::max_series_points, "the points are bounded");
    fuzz::require(nlohmann::json::accept(series.id), "the id of an answer is JSON");
  });
}

/// Shows bytes as a message: as they are, and with the fingerprint of a type in place of the first eight.
void check_frame(fuzz::Input input) {
  const auto whole = std::as_bytes(input);
  std::vector<std::byte> payload(whole.begin(), whole.end());
  const auto& types = shoal::embedded_types().all();
  auto type = types.begin();
  if (!payload.empty()) std::advance(type, std::to_integer<std::size_t>(payload[0]) % types.size());
  for (std::size_t i = 0; i < std::min<std::size_t>(8, payload.size()); ++i)
    payload[i] = static_cast<std::byte>(type->second.fingerprint >> (56 - 8 * i));
  for (const auto bytes : {whole, std::as_bytes(std::span(payload))}) {
    const std::string frame = viewer::message_frame(shoal::embedded_types(), fuzz::text_of(input), bytes, 1);
    std::uint32_t header_bytes = 0;
    std::memcpy(&header_bytes, frame.data() + 4, sizeof header_bytes);
    fuzz::require(header_bytes % 8 == 0 && 32 + header_bytes <= frame.size(), "the header is within the frame");
    fuzz::require(nlohmann::json::parse(frame.substr(32, header_bytes)).contains("fields"), "a message has fields");
  }
}

}  // namespace

SHOAL_FUZZ_TARGET(view_message) {
  static const bridges::AccessToken token("0123456789abcdef");
  bridges::ViewProtocol protocol(token, false);
  protocol.set_post([](const std::function<void()>&) {});
  FuzzLink link;
  const auto session = protocol.open(link);
  std::string_view text = fuzz::text_of(input);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    check_message(line);
    check_subscribe(line);
    check_series(line);
    session->receive(line, !line.starts_with('\0'));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  check_frame(input);
  bridges::WebFrame frame;
  while (session->next(frame))
    fuzz::require(nlohmann::json::parse(*frame.bytes).is_object(), "a page gets JSON objects");
  std::size_t requests = 0;
  while (const auto request = protocol.take_request()) {
    ++requests;
    if (request->op == "look") check_look(request->text);
    const bool steers =
        request->op == "control" || request->op == "play" || request->op == "seek" || request->op == "drive";
    fuzz::require(request->may_control || !steers, "a read-only page does not steer");
  }
  fuzz::require(requests <= bridges::ViewProtocol::max_waiting_requests, "waiting requests are bounded");
}
