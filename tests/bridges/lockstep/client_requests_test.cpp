// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/lockstep/client_requests.hpp"

#include <gmock/gmock.h>

namespace {

using bridges::ClientRequests;
using testing::ElementsAre;
using testing::IsEmpty;

ClientRequests::Waiting request(const std::string& client, const std::string& text, std::int32_t id = 0) {
  ClientRequests::Waiting waiting;
  waiting.request = {};
  waiting.request.client = client;
  waiting.request.command = "spawn";
  waiting.request.text = text;
  waiting.request.id = id;
  return waiting;
}

/// The texts of the requests whose turn it is.
std::vector<std::string> carried_out(ClientRequests& requests, const std::vector<std::string>& late = {}) {
  std::vector<std::string> texts;
  while (const auto next = requests.next(late)) texts.push_back(next->request.text);
  return texts;
}

TEST(ClientRequests, AreCarriedOutByClientNameInAnyOrderOfArrival) {
  ClientRequests requests;
  EXPECT_TRUE(requests.empty());
  for (const char* client : {"c", "a", "b"}) EXPECT_TRUE(requests.add(request(client, client)));
  EXPECT_TRUE(requests.has("c"));
  EXPECT_THAT(carried_out(requests), ElementsAre("a", "b", "c"));
  EXPECT_TRUE(requests.empty());
  EXPECT_FALSE(requests.has("c"));
}

TEST(ClientRequests, WaitForEachClientThatIsLate) {
  ClientRequests requests;
  requests.add(request("b", "of b"));
  EXPECT_THAT(carried_out(requests, {"a", "b"}), IsEmpty());
  EXPECT_THAT(carried_out(requests, {"b"}), ElementsAre("of b"));  // a has answered
}

TEST(ClientRequests, TakeOneOfEachClientInARound) {
  ClientRequests requests;
  for (const char* text : {"b1", "b2", "b3"}) requests.add(request("b", text));
  requests.add(request("a", "a1"));
  EXPECT_EQ(requests.next({"a", "b"})->request.text, "a1");
  // What arrives during a round belongs to the next one.
  requests.add(request("a", "a2"));
  EXPECT_EQ(requests.next({"a", "b"})->request.text, "b1");
  EXPECT_EQ(requests.next({"a", "b"})->request.text, "a2");
  EXPECT_EQ(requests.next({"a", "b"})->request.text, "b2");
  EXPECT_FALSE(requests.next({"a", "b"}));
  EXPECT_EQ(requests.next({})->request.text, "b3");
}

TEST(ClientRequests, ThatAreSentAgainAreCarriedOutOnce) {
  ClientRequests requests;
  requests.add(request("a", "box", 7));
  requests.add(request("a", "box", 7));
  requests.add(request("a", "another box", 7));
  const auto first = requests.next({});
  ASSERT_TRUE(first);
  requests.note_answer(first->request, {true, "it is there"});
  EXPECT_THAT(carried_out(requests), ElementsAre("another box"));
  const ClientRequests::Answer* answer = requests.answer_to(request("a", "box", 7).request);
  ASSERT_NE(answer, nullptr);
  EXPECT_TRUE(answer->ok);
  EXPECT_EQ(answer->text, "it is there");
  EXPECT_EQ(requests.answer_to(request("a", "box", 8).request), nullptr);
  EXPECT_EQ(requests.answer_to(request("b", "box", 7).request), nullptr);
  requests.discard("a");
  EXPECT_EQ(requests.answer_to(request("a", "box", 7).request), nullptr);
}

TEST(ClientRequests, WithoutAnIdAreNeverRepetitions) {
  ClientRequests requests;
  requests.add(request("a", "push"));
  requests.add(request("a", "push"));
  const auto first = requests.next({});
  ASSERT_TRUE(first);
  requests.note_answer(first->request, {true, ""});
  EXPECT_EQ(requests.answer_to(first->request), nullptr);
  EXPECT_THAT(carried_out(requests), ElementsAre("push"));
}

TEST(ClientRequests, AreRefusedBeyondALimit) {
  ClientRequests requests;
  for (std::size_t i = 0; i < ClientRequests::max_waiting; ++i)
    ASSERT_TRUE(requests.add(request("a", std::to_string(i))));
  EXPECT_FALSE(requests.add(request("a", "one more")));
  EXPECT_TRUE(requests.add(request("b", "of another client")));
  EXPECT_EQ(requests.take_all().size(), ClientRequests::max_waiting + 1);
  EXPECT_TRUE(requests.add(request("a", "one more")));
  EXPECT_THAT(carried_out(requests), ElementsAre("one more"));
  // The texts of all together are limited too.
  constexpr std::size_t large = 16 << 20;
  for (std::size_t i = 0; i < ClientRequests::max_waiting_bytes / large; ++i)
    ASSERT_TRUE(requests.add(request(std::string(1, static_cast<char>('a' + i)), std::string(large, ' '))));
  EXPECT_FALSE(requests.add(request("z", "x")));
  requests.discard("a");
  EXPECT_TRUE(requests.add(request("z", "x")));
}

TEST(ClientRequests, OfASessionThatIsOverAreDiscarded) {
  ClientRequests requests;
  for (const char* client : {"a", "b", "c"}) requests.add(request(client, std::string("box of ") + client));
  ASSERT_TRUE(requests.next({}));  // b and c still have their turn in this round
  requests.discard("b");
  EXPECT_FALSE(requests.has("b"));
  EXPECT_THAT(carried_out(requests), ElementsAre("box of c"));
  EXPECT_TRUE(requests.empty());
}

}  // namespace
