// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "shoal/modem_send_t.hpp"
#include "tests/viewer/server/log_page.hpp"

// Who received from whom by radio, on the page of a log.

namespace {

/// A log of three rovers with radios of 100 m: a and b 60 m apart, c 60 m behind b, so that a and c receive only from
/// b.  In 10 s a sends five messages to all, b four to c, c three to a.
struct RadioLog {
  RadioLog() {
    std::string yaml =
        "shoal: 1\nname: radios\nphysics: {step_s: 0.01}\n"
        "objects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\nvehicles:\n";
    for (int i = 0; i < 3; ++i)
      yaml += std::string("  - {name: ") + "abc"[i] + ", file: rover.yaml, position_m: [0, " + std::to_string(60 * i) +
              ", 0]}\n";
    test::RecordedRun run(yaml, path);
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    run.run(1000, [&](std::int64_t step) {
      view.after_step();
      if (step % 200 == 0) send(run, "a", "");
      if (step % 250 == 1) send(run, "b", "c");
      if (step % 300 == 2 && step < 900) send(run, "c", "a");
    });
  }
  static void send(test::RecordedRun& run, const std::string& from, const std::string& to) {
    shoal::modem_send_t message{};
    message.destination = to;
    message.size = 3;
    message.data = {1, 2, 3};
    run.send(from + ".modem.cmd", message);
  }
  test_support::ScratchFolder folder;
  const std::string path = folder.file("radios.lcm");
};

TEST(RadioLinks, AreBetweenVehiclesThatHeardEachOther) {
  const RadioLog log;
  test::LogPage page(log);
  page.pause();
  page.seek(page.index.end_us());
  const auto json = page.text_when("links", [&](const auto& links) { return links["time_us"] == page.index.end_us(); });
  const auto link = [](const char* from, const char* to, int sent, int received) {
    return web_test::Json{
        {"from", from}, {"to", to}, {"sent", sent}, {"received", received}, {"lost", web_test::Json::object()}};
  };
  // a and c are 120 m apart: neither what a sends to all nor what c sends to a arrives there.
  EXPECT_EQ(json["items"], web_test::Json::array({link("a", "b", 5, 5), link("b", "c", 4, 4)}));
}

TEST(RadioLinks, CountUpToTheTimeShown) {
  const RadioLog log;
  test::LogPage page(log);
  page.pause();
  page.seek(5'000'000);
  const auto json = page.text_when("links", [](const auto& links) { return links["time_us"] == 5'000'000; });
  ASSERT_EQ(json["items"].size(), 2u);
  EXPECT_EQ(json["items"][0]["received"], 3) << "sent at 0, 2 and 4 s";
  EXPECT_EQ(json["items"][1]["received"], 2) << "sent at 0 and 2.5 s";
}

}  // namespace
