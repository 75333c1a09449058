// SPDX-License-Identifier: BSD-3-Clause
#include "messages/reporter/message_reporter.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "shoal/lbl_t.hpp"
#include "shoal/pressure_t.hpp"

namespace reporter_test {

struct Gauge {
  double pressure_Pa = 0;
};
void fill(const Gauge& gauge, shoal::pressure_t& message) {
  message.pressure_Pa = gauge.pressure_Pa;
}

/// Reports the ranges that it has, and nothing without any.
struct Net {
  std::vector<double> ranges_m;
  bool wrong_length = false;
};
bool fill(const Net& net, shoal::lbl_t& message) {
  if (net.ranges_m.empty()) return false;
  message.n = static_cast<std::int32_t>(net.ranges_m.size()) + (net.wrong_length ? 1 : 0);
  for (const double range_m : net.ranges_m) {
    message.transponder.emplace_back("t");
    message.travel_time_s.push_back(range_m / 1500);
    message.range_m.push_back(range_m);
  }
  return true;
}

/// Leaves the depth as it is.
struct Reused {
  static constexpr bool reuses_message = true;
  double pressure_Pa = 0;
};
void fill(const Reused& gauge, shoal::pressure_t& message) {
  message.depth_m += 1;
  message.pressure_Pa = gauge.pressure_Pa;
  message.temperature_C = 0;
}

class Published final : public sim::Publisher {
 public:
  Published() : Publisher(1'000'000, nullptr) {}
  void publish(std::span<const std::byte> payload) override { sent.emplace_back(payload.begin(), payload.end()); }
  std::vector<sim::Bytes> sent;
};

template <typename Message>
Message last(const Published& published) {
  return shoal::decode<Message>(published.sent.back(), shoal::Finite::any);
}

TEST(MessageReporter, NamesItsMessageAsTheSchemaDoes) {
  EXPECT_EQ((sim::MessageReporter<Gauge, shoal::pressure_t>::message_name()), "shoal.pressure_t");
}

TEST(MessageReporter, StampsAndPublishesWhatFillWrote) {
  const Gauge gauge{101325};
  Published published;
  sim::MessageReporter<Gauge, shoal::pressure_t>(gauge).report(sim::Time{250}, published);
  ASSERT_EQ(published.sent.size(), 1u);
  const auto message = last<shoal::pressure_t>(published);
  EXPECT_EQ(message.utime, 1'000'250);  // the epoch of the run and the time of the sample
  EXPECT_EQ(message.pressure_Pa, 101325);
  EXPECT_EQ(message.depth_m, 0) << "what fill() leaves out is zero";
}

TEST(MessageReporter, PublishesNothingWhenFillHasNothingToReport) {
  const Net net;
  Published published;
  sim::MessageReporter<Net, shoal::lbl_t>(net).report(sim::Time{0}, published);
  EXPECT_TRUE(published.sent.empty());
}

TEST(MessageReporter, BeginsEachMessageEmpty) {
  const Net net{{3, 4}};
  Published published;
  const sim::MessageReporter<Net, shoal::lbl_t> reporter(net);
  for (int i = 0; i < 2; ++i) reporter.report(sim::Time{0}, published);
  EXPECT_EQ(published.sent[0], published.sent[1]);
  EXPECT_EQ(last<shoal::lbl_t>(published).range_m, (std::vector<double>{3, 4}));
}

TEST(MessageReporter, KeepsTheMessageOfAModelThatReusesIt) {
  const Reused gauge{1};
  Published published;
  const sim::MessageReporter<Reused, shoal::pressure_t> reporter(gauge);
  for (int i = 0; i < 3; ++i) reporter.report(sim::Time{0}, published);
  EXPECT_EQ(last<shoal::pressure_t>(published).depth_m, 3);
}

TEST(MessageReporter, RefusesAnArrayOfAnotherLengthThanItsMessageSays) {
  const Net net{{3, 4}, true};
  Published published;
  const sim::MessageReporter<Net, shoal::lbl_t> reporter(net);
  EXPECT_THROW(reporter.report(sim::Time{0}, published), shoal::MessageError);
  EXPECT_TRUE(published.sent.empty());
}

}  // namespace reporter_test
