// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/view_protocol.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bridges/web/web_error.hpp"

namespace {

using bridges::AccessToken;
using bridges::ViewProtocol;
using bridges::ViewRequest;
using bridges::WebClose;
using bridges::WebFrame;
using bridges::WebSession;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::json;

const std::string right_token = "0123456789abcdef";

/// A page whose network is as slow as the test.
class Page final : public bridges::WebLink {
 public:
  Page(ViewProtocol& protocol, int number) : number_(number), session_(protocol.open(*this)) {}

  int number() const override { return number_; }
  void wake() override {}
  void close(WebClose code, std::string reason) override { closed = {code, std::move(reason)}; }

  void send(const Json& message) { send_text(message.dump()); }
  void send_text(const std::string& text) { session_->receive(text, true); }
  void send_binary(const std::string& bytes) { session_->receive(bytes, false); }
  void hello(const std::string& with = right_token) { send({{"op", "hello"}, {"token", with}}); }
  void acknowledge(unsigned sequence) { send({{"op", "ack"}, {"sequence", sequence}}); }

  /// What the page gets next: a text, `state N`, or nothing.
  std::string next() {
    WebFrame frame;
    if (!session_->next(frame)) return "";
    if (frame.is_text) return *frame.bytes;
    const int sequence = frame.bytes->at(4), flags = frame.bytes->at(1);
    return "state " + std::to_string(sequence) + (flags != 0 ? " with flags " + std::to_string(flags) : "");
  }
  std::vector<std::string> all() {
    std::vector<std::string> texts;
    for (std::string text; !(text = next()).empty();) texts.push_back(text);
    return texts;
  }
  /// The same as it is.
  std::string next_bytes() {
    WebFrame frame;
    return session_->next(frame) ? *frame.bytes : "";
  }
  std::vector<std::string> all_bytes() {
    std::vector<std::string> bytes;
    for (std::string next; !(next = next_bytes()).empty();) bytes.push_back(next);
    return bytes;
  }
  Json next_json() { return Json::parse(next()); }
  bool awaits_greeting() const { return session_->awaits_greeting(); }
  void leave() { session_.reset(); }

  std::pair<WebClose, std::string> closed{};

 private:
  int number_;
  std::unique_ptr<WebSession> session_;
};

/// The protocol with a thread that works when the test says so.
class ViewProtocolTest : public testing::Test {
 protected:
  ViewProtocolTest() { connect(protocol_); }

  void connect(ViewProtocol& protocol) {
    protocol.set_post([this](std::function<void()> work) { posted_.push_back(std::move(work)); });
  }
  void run() {
    for (const auto& work : std::exchange(posted_, {})) work();
  }
  static std::vector<std::byte> state_bytes(int sequence, int flags = 0) {
    std::vector<std::byte> bytes(32);
    bytes[1] = static_cast<std::byte>(flags);
    bytes[4] = static_cast<std::byte>(sequence);
    return bytes;
  }
  void state(int sequence, int flags = 0) {
    protocol_.send_state(state_bytes(sequence, flags));
    run();
  }
  void text(const std::string& json) {
    protocol_.send_text(json);
    run();
  }
  void message(int client, const std::string& channel, const std::string& bytes) {
    protocol_.send_message(client, channel, std::make_shared<const std::string>(bytes));
    run();
  }

  AccessToken token_{right_token};
  ViewProtocol protocol_{token_, false};
  std::vector<std::function<void()>> posted_;
};

TEST_F(ViewProtocolTest, ALateClientGetsWhatIsRetainedInTheOrderOfTheFirstRetain) {
  protocol_.retain("scene", R"({"op":"scene","revision":1})");
  protocol_.retain("status", R"({"op":"status","step":1})");
  protocol_.retain("scene", R"({"op":"scene","revision":2})");
  Page page(protocol_, 1);
  page.hello();
  text(R"({"op":"events"})");
  EXPECT_THAT(page.all(),
              ElementsAre(R"({"op":"scene","revision":2})", R"({"op":"status","step":1})", R"({"op":"events"})"));
}

TEST_F(ViewProtocolTest, ARetainedTextIsSentAgainWhenItChanges) {
  Page page(protocol_, 1);
  page.hello();
  protocol_.retain("status", R"({"op":"status","step":1})");
  run();
  EXPECT_THAT(page.all(), ElementsAre(R"({"op":"status","step":1})"));
  protocol_.retain("status", R"({"op":"status","step":2})");
  protocol_.retain("status", R"({"op":"status","step":3})");
  run();
  EXPECT_THAT(page.all(), ElementsAre(R"({"op":"status","step":3})"));
  EXPECT_THAT(page.all(), IsEmpty());
}

TEST_F(ViewProtocolTest, AJumpIsNotLostWithTheStateThatANewerOneReplaces) {
  Page page(protocol_, 1);
  page.hello();
  const int jump = 2;
  // In the box of the server.
  protocol_.send_state(state_bytes(1, jump));
  state(2);
  EXPECT_EQ(page.next(), "state 2 with flags 2");
  // Behind two states that the page has not acknowledged.
  state(3);
  EXPECT_EQ(page.next(), "state 3");
  state(4, jump);
  state(5);
  state(6);
  page.acknowledge(2);
  EXPECT_EQ(page.next(), "state 6 with flags 2");
  page.acknowledge(6);
  state(7);
  EXPECT_EQ(page.next(), "state 7");
}

TEST_F(ViewProtocolTest, AStateForOnePageNeedsNoAcknowledgementAndGoesToNoOther) {
  Page page(protocol_, 1), other(protocol_, 2);
  page.hello();
  other.hello();
  const int past = 4;
  for (int i = 1; i <= 6; ++i) protocol_.send_state_to(1, state_bytes(i, past));
  run();
  // The oldest ones of too many are dropped.
  EXPECT_THAT(page.all(), ElementsAre("state 3 with flags 4", "state 4 with flags 4", "state 5 with flags 4",
                                      "state 6 with flags 4"));
  EXPECT_THAT(other.all(), IsEmpty());
  state(7);
  EXPECT_EQ(page.next(), "state 7");
}

TEST_F(ViewProtocolTest, HelloSaysWhoMayControl) {
  protocol_.retain("hello", R"({"op":"hello","version":1})");
  Page owner(protocol_, 1), visitor(protocol_, 2), guesser(protocol_, 3);
  owner.hello();
  visitor.send({{"op", "hello"}});
  guesser.hello("0123456789abcdeF");
  EXPECT_EQ(owner.next_json()["control"], true);
  EXPECT_EQ(visitor.next_json()["control"], false);
  EXPECT_EQ(visitor.next(), "");
  EXPECT_EQ(guesser.next_json()["control"], false);
  const Json error = guesser.next_json();
  EXPECT_EQ(error["op"], "error");
  EXPECT_THAT(error["text"].get<std::string>(), HasSubstr("wrong token"));
}

TEST_F(ViewProtocolTest, NothingIsSentBeforeHello) {
  protocol_.retain("scene", "{}");
  Page page(protocol_, 1);
  EXPECT_TRUE(page.awaits_greeting());
  EXPECT_EQ(protocol_.clients(), 0);
  state(1);
  text("{}");
  EXPECT_EQ(page.next(), "");
  page.hello();
  EXPECT_FALSE(page.awaits_greeting());
  EXPECT_EQ(protocol_.clients(), 1);
  EXPECT_THAT(page.all(), ElementsAre("{}"));
}

TEST_F(ViewProtocolTest, AnotherFirstMessageClosesTheConnection) {
  Page page(protocol_, 1);
  page.send({{"op", "ack"}, {"sequence", 1}});
  EXPECT_EQ(page.closed.first, WebClose::policy);
  EXPECT_EQ(page.next_json()["text"], "the first message must be 'hello', got 'ack'");
}

TEST_F(ViewProtocolTest, APortOpenToOthersNeedsTheTokenToRead) {
  ViewProtocol open(token_, true);
  connect(open);
  open.retain("hello", R"({"op":"hello"})");
  Page visitor(open, 1), owner(open, 2);
  visitor.send({{"op", "hello"}});
  EXPECT_EQ(visitor.closed.first, WebClose::policy);
  EXPECT_EQ(visitor.next_json()["op"], "error");
  EXPECT_EQ(visitor.next(), "");
  EXPECT_EQ(open.clients(), 0);
  owner.hello();
  EXPECT_EQ(owner.next_json()["control"], true);
}

TEST_F(ViewProtocolTest, TwoStatesAreSentUnacknowledgedThenOnlyTheNewest) {
  Page page(protocol_, 1);
  page.hello();
  std::vector<std::string> got;
  for (int sequence = 1; sequence <= 9; ++sequence) {
    state(sequence);
    for (const std::string& text : page.all()) got.push_back(text);
  }
  EXPECT_THAT(got, ElementsAre("state 1", "state 2"));
  page.acknowledge(1);
  EXPECT_THAT(page.all(), ElementsAre("state 9"));
  page.acknowledge(7);  // never sent
  state(10);
  EXPECT_THAT(page.all(), IsEmpty());
  page.acknowledge(9);  // and so 2
  EXPECT_THAT(page.all(), ElementsAre("state 10"));
}

TEST_F(ViewProtocolTest, ANewPageGetsTheLastState) {
  Page first(protocol_, 1);
  first.hello();
  state(1);
  Page second(protocol_, 2);
  second.hello();
  EXPECT_THAT(second.all(), ElementsAre("state 1"));
}

TEST_F(ViewProtocolTest, AnOldStateIsNotKeptWithoutPages) {
  Page first(protocol_, 1);
  first.hello();
  state(1);
  first.leave();
  Page second(protocol_, 2);
  second.hello();
  EXPECT_THAT(second.all(), IsEmpty());
}

TEST_F(ViewProtocolTest, WithoutPagesNothingIsKeptOfStatesAndTexts) {
  state(1);
  text("{}");
  protocol_.reply(1, "{}");
  EXPECT_THAT(posted_, IsEmpty());
  protocol_.retain("status", "{}");
  EXPECT_THAT(posted_, IsEmpty());
}

TEST_F(ViewProtocolTest, APageThatDoesNotReadLosesTheOldestTextsAndIsToldOnce) {
  Page page(protocol_, 1), other(protocol_, 2);
  page.hello();
  other.hello();
  // 9 texts of 1 MiB; 8 of them fit into 8 MiB
  for (char c = '1'; c <= '9'; ++c) {
    text(std::string(std::size_t{1} << 20, c));
    EXPECT_EQ(other.next().front(), c);
  }
  EXPECT_EQ(page.next(), R"({"op":"dropped","count":1})");
  for (char c = '2'; c <= '9'; ++c) EXPECT_EQ(page.next().front(), c);
  EXPECT_EQ(page.next(), "");
  EXPECT_EQ(other.next(), "");
}

TEST_F(ViewProtocolTest, ATextThatIsTooLargeIsDropped) {
  Page page(protocol_, 1);
  page.hello();
  text(std::string(ViewProtocol::max_queued_bytes + 1, 'x'));
  EXPECT_THAT(page.all(), ElementsAre(R"({"op":"dropped","count":1})"));
}

TEST_F(ViewProtocolTest, AFullBoxOfTheThreadIsBounded) {
  Page page(protocol_, 1);
  page.hello();
  for (int i = 0; i < 20; ++i) protocol_.send_text(std::string(std::size_t{1} << 20, 'x'));  // the thread does not run
  EXPECT_EQ(posted_.size(), 1u);
  run();
  EXPECT_EQ(page.next(), R"({"op":"dropped","count":12})");
  EXPECT_EQ(page.all().size(), 8u);
}

TEST_F(ViewProtocolTest, ManyTextsDoNotStopTheStates) {
  Page page(protocol_, 1);
  page.hello();
  for (int i = 0; i < 8; ++i) protocol_.send_text(std::string(std::size_t{1} << 17, 'x'));  // 1 MiB
  state(1);
  state(2);
  const auto all = page.all();
  ASSERT_EQ(all.size(), 9u);
  EXPECT_EQ(all[2], "state 2");  // after 2 texts, 256 KiB
}

TEST_F(ViewProtocolTest, RequestsCarryTheirClientAndItsRight) {
  Page owner(protocol_, 7), visitor(protocol_, 8);
  owner.hello();
  visitor.send({{"op", "hello"}});
  const std::string pause = R"({"op":"control","id":1,"command":"pause"})";
  owner.send_text(pause);
  visitor.send({{"op", "history"}, {"from", 0}});
  const auto first = protocol_.take_request(), second = protocol_.take_request();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(std::tie(first->client, first->may_control, first->op, first->text),
            std::make_tuple(7, true, std::string("control"), pause));
  EXPECT_EQ(second->client, 8);
  EXPECT_FALSE(second->may_control);
  EXPECT_FALSE(protocol_.take_request());
}

TEST_F(ViewProtocolTest, AReadOnlyPageCannotSteer) {
  Page page(protocol_, 1);
  page.send({{"op", "hello"}});
  for (const char* op : {"control", "play", "seek"}) {
    page.send({{"op", op}, {"id", "a\"b"}});
    const Json reply = page.next_json();
    EXPECT_EQ(reply["op"], "reply");
    EXPECT_EQ(reply["id"], "a\"b");
    EXPECT_EQ(reply["ok"], false);
    EXPECT_THAT(reply["text"].get<std::string>(), HasSubstr("read-only"));
  }
  EXPECT_FALSE(protocol_.take_request());
}

TEST_F(ViewProtocolTest, TheRequestsOfAPageAreBounded) {
  Page page(protocol_, 1), other(protocol_, 2);
  page.hello();
  other.hello();
  for (std::size_t i = 0; i <= ViewProtocol::max_waiting_requests; ++i) page.send({{"op", "control"}, {"id", i}});
  EXPECT_EQ(
      page.next_json(),
      Json({{"op", "reply"}, {"id", 32}, {"ok", false}, {"text", "too many requests: 32 of this page are waiting"}}));
  EXPECT_EQ(page.next(), "");
  other.send({{"op", "control"}});
  page.leave();
  std::vector<std::string> taken;
  while (const auto request = protocol_.take_request()) taken.push_back(std::to_string(request->client) + request->op);
  ASSERT_EQ(taken.size(), 34u);
  EXPECT_EQ(taken[31], "1control");
  EXPECT_EQ(taken[32], "2control");
  EXPECT_EQ(taken[33], "1left");
}

TEST_F(ViewProtocolTest, AReplyGoesToItsPageOnly) {
  Page first(protocol_, 1), second(protocol_, 2);
  first.hello();
  second.hello();
  protocol_.reply(2, R"({"op":"reply"})");
  protocol_.reply(3, "nobody");
  run();
  EXPECT_EQ(first.next(), "");
  EXPECT_THAT(second.all(), ElementsAre(R"({"op":"reply"})"));
}

TEST_F(ViewProtocolTest, InvalidMessagesAreAnsweredAndChangeNothing) {
  Page page(protocol_, 1);
  page.hello();
  page.send_binary("abc");
  EXPECT_EQ(page.next_json()["text"], "binary messages are not part of shoal.view.v1");
  page.send_text("{\"op\":");
  EXPECT_EQ(page.next_json()["text"], "message is not JSON: error at byte 7");
  page.hello();
  EXPECT_EQ(page.next_json()["text"], "a second 'hello'");
  page.send({{"op", "ack"}, {"sequence", -1}});
  EXPECT_EQ(page.next_json()["text"], "'sequence' of ack must be an integer from 0 to 4294967295");
  EXPECT_EQ(page.closed.first, WebClose{});
  EXPECT_FALSE(protocol_.take_request());
}

TEST_F(ViewProtocolTest, AHelloThatIsNoObjectIsAnError) {
  EXPECT_THROW(protocol_.retain("hello", "[]"), bridges::WebError);
}

TEST_F(ViewProtocolTest, AJumpInTimeIsNotLostWithTheStateThatItCameWith) {
  Page page(protocol_, 1);
  page.hello();
  std::vector<std::byte> jump(32), after(32);
  jump[1] = std::byte{2};
  after[1] = std::byte{1};
  after[4] = std::byte{7};
  protocol_.send_state(jump);
  run();
  protocol_.send_state(after);
  run();
  const std::string got = page.next_bytes();
  EXPECT_EQ(got[1], 3);
  EXPECT_EQ(got[4], 7);
}

// --- Messages of channels

TEST_F(ViewProtocolTest, OnlyTheNewestMessageOfAChannelWaits) {
  Page page(protocol_, 1);
  page.hello();
  message(1, "a", "a1");
  message(1, "b", "b1");
  message(1, "a", "a2");
  EXPECT_THAT(page.all_bytes(), ElementsAre("a2", "b1"));
}

TEST_F(ViewProtocolTest, AMessageGoesToThePageThatSubscribed) {
  Page page(protocol_, 1), other(protocol_, 2);
  page.hello();
  other.hello();
  message(2, "a", "a1");
  EXPECT_THAT(page.all_bytes(), IsEmpty());
  EXPECT_THAT(other.all_bytes(), ElementsAre("a1"));
}

TEST_F(ViewProtocolTest, AStateGoesBeforeMessages) {
  Page page(protocol_, 1);
  page.hello();
  message(1, "a", "a1");
  state(7);
  EXPECT_EQ(page.next(), "state 7");
  EXPECT_THAT(page.all_bytes(), ElementsAre("a1"));
}

TEST_F(ViewProtocolTest, ABusyChannelDoesNotStopTheOthers) {
  Page page(protocol_, 1);
  page.hello();
  message(1, "a", "a1");
  message(1, "b", "b1");
  EXPECT_EQ(page.next_bytes(), "a1");
  message(1, "a", "a2");
  EXPECT_THAT(page.all_bytes(), ElementsAre("b1", "a2"));
}

TEST_F(ViewProtocolTest, APageThatDoesNotReadLosesMessagesAndNotTexts) {
  Page page(protocol_, 1);
  page.hello();
  text(R"({"op":"events"})");
  for (int i = 0; i < 20; ++i) message(1, "image" + std::to_string(i), std::string(1 << 20, 'x'));
  const auto got = page.all_bytes();
  EXPECT_EQ(got.size(), 1u + 7);
  EXPECT_EQ(got[0], R"({"op":"events"})");
}

TEST_F(ViewProtocolTest, TextsTakeTheRoomOfMessages) {
  Page page(protocol_, 1);
  page.hello();
  message(1, "image", std::string(7 << 20, 'x'));
  text(R"({"op":")" + std::string(2 << 20, 'y') + "\"}");
  EXPECT_EQ(page.next().substr(0, 7), R"({"op":")");
  EXPECT_THAT(page.all_bytes(), IsEmpty());
}

TEST_F(ViewProtocolTest, AMessageOfMoreThanTheBoundIsLost) {
  Page page(protocol_, 1);
  page.hello();
  message(1, "image", std::string(9 << 20, 'x'));
  EXPECT_THAT(page.all_bytes(), IsEmpty());
  message(1, "image", "small");
  EXPECT_THAT(page.all_bytes(), ElementsAre("small"));
}

}  // namespace
