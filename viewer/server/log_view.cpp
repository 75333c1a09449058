// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/log_view.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "bridges/base/json_text.hpp"
#include "viewer/log/scene_names.hpp"
#include "viewer/page_data/page_request.hpp"

namespace viewer {

namespace {

using Json = nlohmann::json;

/// Part of the log before a time that is read after a jump, for estimates and sounds that are still visible.
constexpr std::int64_t before_us = 3'000'000;

}  // namespace

LogView::LogView(const std::string& path, const LogIndex& index, const experiment::ViewOptions& options,
                 const std::string& version)
    : path_(path),
      name_(std::filesystem::path(path).filename().string()),
      index_(index),
      reader_(path),
      looking_(path),
      session_(options, PageSession::Source::messages),
      series_(path, index, session_.server),
      times_(index.epoch_us()),
      poses_(path, index),
      now_us_(static_cast<double>(index.start_us())) {
  session_.messages.set_epoch(index.epoch_us());
  Json hello = hello_json(version, "log", index.world(), index.epoch_us());
  hello["name"] = name_;
  hello["start_us"] = index.start_us();
  hello["end_us"] = index.end_us();
  session_.server.retain("hello", bridges::json_text(hello));
  using bridges::foxglove::Control;
  session_.foxglove.introduce(hello["name"], version, options.foxglove_control ? Control::playback : Control::none,
                              index.epoch_us() + index.start_us(), index.epoch_us() + index.end_us());
  for (const std::uint64_t offset : index.assets()) send_event_at(offset);
  seek(index.start_us());
  // The events of the whole log for the time line, after the scene to which they belong.
  Json items = Json::array();
  for (const LogIndex::Occasion& each : index.occasions())
    items.push_back({{"time_us", each.time_us}, {"kind", each.kind}, {"who", each.who}, {"text", each.text}});
  if (!items.empty())
    session_.server.retain("events",
                           bridges::json_text({{"op", "events"}, {"all", true}, {"items", std::move(items)}}));
}

void LogView::compare_with(const std::string& path, const LogIndex& index,
                           const std::optional<LogDifference>& difference) {
  other_.emplace(path, index);
  other_epoch_us_ = index.epoch_us();
  constexpr double always_s = std::numeric_limits<double>::infinity(), interval_s = 0.1;
  other_estimates_ = LogEstimates(path, -always_s, always_s, interval_s);
  difference_ = difference;
  distances_.emplace(path_, index_, path, index, session_.messages.scene());
  const auto item = [](int branch, const std::string& name, const LogIndex& of) {
    return Json{{"branch", branch},          {"parent", nullptr},     {"name", name},
                {"start_us", of.start_us()}, {"end_us", of.end_us()}, {"differs_us", nullptr}};
  };
  Json items{item(0, name_, index_), item(1, std::filesystem::path(path).filename().string(), index)};
  if (difference) {
    items[1]["differs_us"] = difference->time_us;
    if (difference->step) items[1]["differs_step"] = *difference->step;
  }
  session_.server.retain(
      "branches",
      bridges::json_text(
          {{"op", "branches"}, {"present", 0}, {"by", difference ? difference->by : ""}, {"items", std::move(items)}}));
}

void LogView::look(const bridges::ViewRequest& request) {
  const LookRequest look = parse_look(request.text);
  if (!look.time_us) return;
  const std::int32_t branch = look.branch.value_or(0);
  if (branch < 0 || branch > (other_ ? 1 : 0))
    throw std::runtime_error("look: there is no log " + std::to_string(branch));
  // The bodies of either log, in the order of the scene that the pages show.
  const LogPoses::Poses* const shown = poses_.at(static_cast<std::int64_t>(now_us_));
  if (shown == nullptr) throw std::runtime_error("look: the poses of this time cannot be read");
  const std::vector<std::string> order = *shown->names;
  const auto revision = static_cast<std::uint32_t>(shown->message.revision);
  const LogPoses::Poses* const poses = (branch == 1 ? *other_ : poses_).at(*look.time_us);
  if (poses == nullptr) throw std::runtime_error("look: the poses of this time cannot be read");
  StateFrame::Head head;
  head.time_us = poses->time_us;
  head.branch = branch;
  head.revision = revision;
  head.paused = head.past = true;
  past_.begin(head);
  arrange(poses->bodies, *poses->names, order, past_);
  if (branch == 1) send_other_estimates(request, poses->time_us);
  session_.server.send_state_to(request.client, past_.end());
}

void LogView::send_other_estimates(const bridges::ViewRequest& request, std::int64_t time_us) {
  std::string items;
  for (const std::string& vehicle : other_estimates_.vehicles()) {
    constexpr double max_age_s = 1e-6 * static_cast<double>(before_us);
    const LogEstimate* const estimate = other_estimates_.find(vehicle, 1e-6 * static_cast<double>(time_us), max_age_s);
    if (estimate == nullptr) continue;
    items += (items.empty() ? "" : ",") + estimate_text(vehicle, *estimate, estimate->utime - other_epoch_us_);
  }
  if (other_estimates_.vehicles().empty()) return;
  session_.server.reply(request.client, "{\"op\":\"estimates\",\"branch\":1,\"items\":[" + items + "]}");
}

void LogView::send_event_at(std::uint64_t offset) {
  looking_.seek(offset);
  bridges::LogEventView event;
  if (!looking_.next(event)) return;
  session_.messages.take(event.channel, event.payload);
  times_.take(event.channel, event.payload, event.utime);
  session_.pass_on(times_.interpolated_us(), event.channel, event.payload);
}

void LogView::seek(std::int64_t time_us) {
  time_us = std::clamp(time_us, index_.start_us(), index_.end_us());
  now_us_ = static_cast<double>(time_us);
  session_.foxglove.jump(index_.epoch_us() + std::max(index_.start_us(), time_us - before_us));
  // The state at this time, then the events shortly before it.
  send_event_at(index_.scene_at(time_us).offset);
  if (const auto scores = index_.scores_at(time_us)) send_event_at(scores->offset);
  session_.messages.rewind_paths(std::numeric_limits<std::int64_t>::min());
  for (const std::uint64_t offset : index_.paths_at(time_us)) send_event_at(offset);
  const std::uint64_t from = index_.bodies_at(time_us - before_us).offset;
  TrafficHistory::Point counted = index_.counts_before(from);
  session_.traffic.set_counts(std::move(counted.counts));
  session_.traffic.feed().discard();
  reader_.seek(counted.offset);
  bridges::LogEventView event;
  while (reader_.next(event) && event.offset < from) session_.traffic.count(event.channel, event.payload);
  reader_.seek(from);
  session_.messages.mark_jump();
  play_to(time_us);
  status_is_old_ = true;
}

void LogView::play_to(std::int64_t time_us) {
  const std::uint64_t last = index_.bodies_at(time_us).offset;
  bridges::LogEventView event;
  while (reader_.next(event)) {
    // Events were retained for the whole log.
    if (event.channel != "sim.event" && event.channel != "sim.asset")
      session_.messages.take(event.channel, event.payload);
    times_.take(event.channel, event.payload, event.utime);
    session_.traffic.take(event.channel, event.payload, times_.steady_us() - index_.epoch_us());
    if (event.channel != "sim.asset") session_.pass_on(times_.interpolated_us(), event.channel, event.payload);
    if (event.offset >= last) break;
  }
  session_.messages.set_pace(static_cast<float>(speed_), paused_);
  session_.messages.flush();
}

void LogView::fill_feed() {
  const auto now_us = static_cast<std::int64_t>(now_us_);
  const std::uint64_t last = index_.bodies_at(now_us).offset;
  looking_.seek(index_.bodies_at(now_us - before_us).offset);
  MessageTimes times(index_.epoch_us());
  bridges::LogEventView event;
  while (looking_.next(event) && event.offset <= last) {
    times.take(event.channel, event.payload, event.utime);
    session_.traffic.feed().take(event.channel, event.payload, times.steady_us() - index_.epoch_us());
  }
}

void LogView::send_distances() {
  constexpr std::chrono::milliseconds slice{8};
  if (!distances_ || !distances_->compute(std::chrono::steady_clock::now() + slice)) return;
  session_.server.retain("distances", distances_->text(difference_));
  distances_.reset();
}

void LogView::advance(double wall_s) {
  send_distances();
  while (const auto request = session_.server.take_request()) handle(*request);
  serve_foxglove();
  // A page that has just opened gets the present state.
  if (session_.rosbridge) session_.rosbridge->release();
  const int clients = session_.server.clients() + session_.foxglove.clients() +
                      (session_.rosbridge ? session_.rosbridge->clients() : 0);
  if (clients > clients_) seek(static_cast<std::int64_t>(now_us_));
  clients_ = clients;
  const auto end = static_cast<double>(index_.end_us());
  if (!paused_ && now_us_ < end && clients > 0) {
    const auto before = static_cast<std::int64_t>(now_us_);
    now_us_ = std::min(end, now_us_ + 1e6 * speed_ * wall_s);
    const auto now = static_cast<std::int64_t>(now_us_);
    if (index_.bodies_at(now).offset != index_.bodies_at(before).offset) play_to(now);
    status_is_old_ = true;
  } else if (!paused_ && loop_ && clients > 0) {
    seek(index_.start_us());
  }
  session_.flush();
  session_.flush_traffic(static_cast<std::int64_t>(now_us_));
  constexpr double status_interval_s = 1;
  since_status_s_ += wall_s;
  if (status_is_old_ || since_status_s_ > status_interval_s) send_status();
}

void LogView::serve_foxglove() {
  session_.foxglove.serve([this] { return foxglove_state(); },
                          [this](const FoxgloveView::Request& request) -> FoxgloveView::Answer {
                            if (request.kind != FoxgloveView::Request::Kind::playback)
                              return {false, "this is a log, which cannot be controlled"};
                            play_foxglove(request.playback);
                            return {true, ""};
                          });
  // While nothing is played, new subscriptions need the messages of the present time.
  const bool of_rosbridge = session_.rosbridge && session_.rosbridge->take_subscribed();
  const bool is_new = session_.foxglove.take_subscribed() || of_rosbridge;
  if (is_new && foxglove_state().status != FoxgloveView::State::Status::playing)
    seek(static_cast<std::int64_t>(now_us_));
  session_.foxglove.show_time(index_.epoch_us() + static_cast<std::int64_t>(now_us_));
}

FoxgloveView::State LogView::foxglove_state() const {
  using Status = FoxgloveView::State::Status;
  const bool at_end = now_us_ >= static_cast<double>(index_.end_us());
  return {paused_  ? Status::paused
          : at_end ? Status::ended
                   : Status::playing,
          index_.epoch_us() + static_cast<std::int64_t>(now_us_), speed_};
}

void LogView::play_foxglove(const bridges::foxglove::PlaybackRequest& request) {
  speed_ = request.speed;
  paused_ = !request.plays;
  status_is_old_ = true;
  if (request.seek_us) seek(*request.seek_us - index_.epoch_us());
}

void LogView::send_status() {
  status_is_old_ = false;
  since_status_s_ = 0;
  const bool at_end = now_us_ >= static_cast<double>(index_.end_us());
  // A log that is at its end stands still, whatever was chosen.
  session_.server.retain("status", bridges::json_text({{"op", "status"},
                                                       {"time_us", static_cast<std::int64_t>(now_us_)},
                                                       {"step", nullptr},
                                                       {"branch", 0},
                                                       {"paused", paused_ || at_end},
                                                       {"speed", speed_},
                                                       {"rate", paused_ || at_end ? 0 : speed_},
                                                       {"waits_for", ""},
                                                       {"ended", nullptr}}));
}

void LogView::handle(const bridges::ViewRequest& request) {
  if (request.op == "series") return series_.request(request);
  if (session_.traffic.handle(request)) {
    if (request.op == "subscribe") fill_feed();
    return;
  }
  // Requests come from a browser: what cannot be read is ignored, or answered with an error, but never ends the
  // server.
  const Json message = Json::parse(request.text, nullptr, false);
  if (!message.is_object()) return;
  try {
    if (request.op == "look") {
      look(request);
    } else if (request.op == "seek") {
      const double time_us = message.value("time_us", now_us_);
      if (std::isfinite(time_us)) seek(static_cast<std::int64_t>(std::clamp(time_us, -1e18, 1e18)));
    } else if (request.op == "play") {
      speed_ = std::clamp(message.value("speed", speed_), 0.01, 1000.0);
      paused_ = message.value("paused", paused_);
      loop_ = message.value("loop", loop_);
      // Play at the end starts again, as media players do.
      if (!paused_ && now_us_ >= static_cast<double>(index_.end_us())) seek(index_.start_us());
      status_is_old_ = true;
    } else if (request.op == "control") {
      refuse(session_.server, request, "this is a log, which cannot be controlled");
    }
  } catch (const Json::exception&) {
    session_.server.reply(
        request.client,
        bridges::json_text({{"op", "error"}, {"text", "'" + request.op + "' has a value of a wrong kind"}}));
  } catch (const std::runtime_error& error) {
    session_.server.reply(request.client, bridges::json_text({{"op", "error"}, {"text", error.what()}}));
  }
}

}  // namespace viewer
