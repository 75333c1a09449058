// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/bus_view.hpp"

#include <algorithm>

#include "bridges/base/json_text.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_info_t.hpp"

namespace viewer {

using Json = nlohmann::json;

BusView::BusView(const experiment::ViewOptions& options, const std::string& version, const std::string& bus)
    : session_(options, PageSession::Source::messages), version_(version), bus_(bus) {
  send_hello();
  session_.foxglove.introduce(bus, version, bridges::foxglove::Control::none);
}

void BusView::send_hello() {
  Json hello = hello_json(version_, "bus", world_.empty() ? bus_ : world_, session_.messages.epoch_us());
  hello["name"] = bus_;
  session_.server.retain("hello", bridges::json_text(hello));
}

void BusView::message(std::string_view channel, std::span<const std::byte> payload) {
  session_.messages.take(channel, payload);
  if (channel == "sim.clock" || channel == "sim.bodies")
    if (const auto stamp = stamp_of(payload)) now_us_ = *stamp - session_.messages.epoch_us();
  session_.traffic.take(channel, payload, now_us_);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  times_.take(channel, payload, std::chrono::duration_cast<std::chrono::microseconds>(now).count());
  const std::int64_t utime = times_.interpolated_us();
  constexpr std::int64_t disorder_us = 500'000;  // of datagrams, and of the two clocks
  if (utime < newest_utime_ - disorder_us) {
    session_.foxglove.jump(utime);
    newest_utime_ = utime;
  }
  newest_utime_ = std::max(newest_utime_, utime);
  session_.pass_on(utime, channel, payload);
  session_.flush();
  if (channel != "sim.info") return;
  try {
    const auto info = shoal::decode<shoal::sim_info_t>(payload, shoal::Finite::any);
    if (std::exchange(world_, info.world) != info.world) send_hello();
  } catch (const shoal::MessageError&) {  // counted by take()
  }
}

void BusView::flush() {
  while (const auto request = session_.server.take_request()) {
    if (request->op == "left") session_.messages.page_left();
    if (session_.traffic.handle(*request) || request->op != "control") continue;
    refuse(session_.server, *request, "this page watches a bus; steer the run with 'shoal control'");
  }
  session_.messages.flush();
  session_.flush_traffic(now_us_);
  session_.foxglove.show_time(newest_utime_);
  if (session_.rosbridge) session_.rosbridge->release();
  constexpr std::chrono::milliseconds status_interval{500};
  if (Clock::now() - status_at_ > status_interval) send_status();
}

void BusView::send_status() {
  const Clock::time_point now = Clock::now();
  const double wall_s = std::chrono::duration<double>(now - status_at_).count();
  const double simulated_s = 1e-6 * static_cast<double>(session_.messages.newest_us() - status_us_);
  constexpr double max_wall_s = 5;  // since the status before: else there was none
  const bool known = wall_s < max_wall_s && simulated_s >= 0;
  status_at_ = now;
  status_us_ = session_.messages.newest_us();
  session_.server.retain("status",
                         bridges::json_text({{"op", "status"},
                                             {"time_us", session_.messages.newest_us()},
                                             {"step", nullptr},
                                             {"branch", session_.messages.branch()},
                                             {"paused", known && simulated_s == 0},
                                             {"speed", nullptr},
                                             {"rate", known ? simulated_s / wall_s : 0},
                                             {"waits_for", session_.messages.has_scene() ? "" : "waits for sim.scene"},
                                             {"ended", nullptr}}));
}

}  // namespace viewer
