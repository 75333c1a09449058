// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/run_view.hpp"

#include <cmath>

#include "bridges/base/json_text.hpp"
#include "experiment/drive/drive_profile.hpp"
#include "experiment/run/version.hpp"
#include "shoal/message_codec.hpp"
#include "viewer/server/page_drive.hpp"

namespace viewer {

namespace {

using Json = nlohmann::json;

constexpr std::chrono::milliseconds frame_interval{33};
constexpr std::chrono::milliseconds status_interval{200};

}  // namespace

RunView::RunView(const experiment::ViewOptions& options, const std::string& version)
    : session_(options, PageSession::Source::world),
      opened_(options.opened),
      foxglove_control_(options.foxglove_control),
      version_(version),
      drive_(experiment::read_drive_profile(options.drive_profile)) {}

experiment::RunPage::Make run_page(const experiment::ViewOptions& options) {
  return [&options] { return std::make_unique<RunView>(options, experiment::short_version()); };
}

void RunView::announce() const {
  if (opened_) opened_(url());
}

void RunView::start(const sim::World& world, std::optional<double> duration_s, const Source& source) {
  session_.messages.set_epoch(world.epoch_us());
  Json hello = hello_json(version_, "run", world.config().name, world.epoch_us());
  hello["start_us"] = world.now().count();
  hello["past"] = true;
  if (duration_s && *duration_s > 0) hello["end_us"] = sim::from_seconds(*duration_s).count();
  if (!source.record.empty()) hello["record"] = source.record;
  if (!source.programs.empty()) hello["programs"] = source.programs;
  if (source.may_launch) hello["may_launch"] = true;
  if (source.record == "recorded") past_.set_programs(source.programs);
  // Retained, so that pages which connect later get it first.
  session_.server.retain("hello", bridges::json_text(hello));
  using bridges::foxglove::Control;
  session_.foxglove.introduce(world.config().name, version_, foxglove_control_ ? Control::run : Control::none);
  // A client may command from its first message on.
  if (session_.rosbridge) session_.rosbridge->show_commands(world);
}

void RunView::message(std::string_view channel, std::span<const std::byte> payload, sim::Time at) {
  session_.messages.take(channel, payload);
  if (channel == "sim.scene") past_.set_scene(session_.messages.scene());
  session_.traffic.take(channel, payload, at.count());
  const std::int64_t utime = session_.messages.epoch_us() + at.count();
  if (at < message_time_) session_.foxglove.jump(utime);
  message_time_ = at;
  session_.pass_on(utime, channel, payload);
}

void RunView::problem(const std::string& text) {
  session_.server.send_text(bridges::json_text({{"op", "error"}, {"text", text}}));
}

void RunView::moved(const sim::World& world, const sim::RunControl& control, bool continues,
                    const std::string& programs) {
  jump_ = true;
  session_.traffic.rewind(world.now().count());
  session_.messages.rewind_paths(world.now().count());
  past_.start_branch(control.branch, world.now().count(), last_us_, continues);
  past_.set_programs(programs);
  last_us_ = world.now().count();
}

void RunView::after_step(const sim::World& world, const bridges::ViewPublisher& publisher,
                         const sim::RunControl& control) {
  session_.flush();
  session_.foxglove.show_time(world.epoch_us() + world.now().count());
  last_us_ = world.now().count();
  past_.remember(world, publisher);
  if (session_.server.clients() == 0) return;
  if (Clock::now() < next_frame_ && !jump_) return;
  send_state(world, publisher, control);
}

void RunView::send_state(const sim::World& world, const bridges::ViewPublisher& publisher,
                         const sim::RunControl& control) {
  next_frame_ = Clock::now() + frame_interval;
  sent_step_ = world.step_number();
  frame_.begin({world.now().count(), control.branch, static_cast<std::uint32_t>(publisher.revision()),
                static_cast<float>(control.speed), control.paused, std::exchange(jump_, false)});
  publisher.for_each_movable(
      [&](const sim::Pose& X_WB) { frame_.add(X_WB.translation(), sim::Quaterniond(X_WB.linear())); });
  session_.server.send_state(frame_.end());
  session_.messages.flush();
  flush_traffic(world);
}

void RunView::flush_traffic(const sim::World& world) {
  next_traffic_ = Clock::now() + frame_interval;
  session_.flush_traffic(world.now().count());
}

void RunView::send_status(const sim::World& world, const sim::RunControl& control, const std::string& waits_for,
                          const std::string& ended, const std::string& log) {
  const Clock::time_point now = Clock::now();
  next_status_ = now + status_interval;
  // Rate of simulated time since a second ago.
  const double wall_s = std::chrono::duration<double>(now - rate_since_).count();
  if (wall_s > 1 || world.now() < rate_from_) {
    constexpr double max_wall_s = 5;  // else there was no page for a while
    rate_ = wall_s < max_wall_s ? sim::to_seconds(world.now() - rate_from_) / wall_s : control.speed;
    rate_since_ = now;
    rate_from_ = world.now();
  }
  Json status{{"op", "status"},
              {"time_us", world.now().count()},
              {"step", world.step_number()},
              {"branch", control.branch},
              {"paused", control.paused},
              {"speed", control.speed > 0 ? Json(control.speed) : Json(nullptr)},
              {"rate", std::max(0.0, rate_)},
              {"waits_for", waits_for},
              {"ended", ended.empty() ? Json(nullptr) : Json(ended)}};
  if (!log.empty()) status["log"] = log;
  session_.server.retain("status", bridges::json_text(status));
}

void RunView::handle(const bridges::ViewRequest& request, const Execute& execute) {
  if (request.op == "look") return past_.answer(request);
  const Json message = Json::parse(request.text, nullptr, false);
  // Unknown requests are ignored: a page of a newer version may send more.
  if (request.op != "control" || !message.is_object()) return;
  Json reply{{"op", "reply"}, {"id", message.value("id", Json())}};
  try {
    const Answer answer = execute(message.value("command", ""), message.value("value", 0.0), message.value("text", ""));
    reply["ok"] = answer.ok;
    reply["text"] = answer.text;
  } catch (const Json::exception&) {
    reply["ok"] = false;
    reply["text"] = "'command' and 'text' must be texts, and 'value' a number";
  }
  session_.server.reply(request.client, bridges::json_text(reply));
}

void RunView::drive(const bridges::ViewRequest& request, const sim::World& world) {
  try {
    if (!publish_drive_) throw experiment::DriveError("this run cannot be driven");
    drive_.take(request.client, PageDrive::read(request.text), world, Clock::now());
  } catch (const experiment::DriveError& error) {
    refuse(session_.server, request, error.what());
  }
}

void RunView::send_forms(const sim::World& world) {
  if (forms_generation_ == world.generation()) return;
  forms_generation_ = world.generation();
  session_.server.retain("forms", forms_text(world, drive_.profile()));
}

void RunView::serve(const sim::World& world, const bridges::ViewPublisher& publisher, const sim::RunControl& control,
                    const std::string& waits_for, const Execute& execute) {
  constexpr int max_at_once = 50;
  bool handled = false;
  for (int i = 0; i < max_at_once; ++i) {
    const auto request = session_.server.take_request();
    if (!request) break;
    if (request->op == "left") session_.messages.page_left();
    if (session_.traffic.handle(*request)) continue;
    if (request->op == "left") {
      drive_.left(request->client);
      continue;
    }
    if (request->op == "drive") {
      drive(*request, world);
      continue;
    }
    handle(*request, execute);
    handled = handled || request->op != "look";
  }
  serve_foxglove(world, publisher, control, execute);
  if (session_.rosbridge) session_.rosbridge->serve(world, execute, publish_drive_);
  const Clock::time_point now = Clock::now();
  if (publish_drive_) drive_.run(world, now, control.paused, publish_drive_);
  if (session_.server.clients() == 0) return;
  send_forms(world);
  if (handled || now >= next_status_) send_status(world, control, waits_for, "");
  past_.update(now);
  // While the run is paused, a page that has just opened needs the state too.
  if (now >= next_frame_ && (jump_ || control.paused || sent_step_ != world.step_number()))
    send_state(world, publisher, control);
  else if (now >= next_traffic_)
    flush_traffic(world);
}

void RunView::serve_foxglove(const sim::World& world, const bridges::ViewPublisher& publisher,
                             const sim::RunControl& control, const Execute& execute) {
  const auto utime = [&] { return world.epoch_us() + world.now().count(); };
  session_.foxglove.serve(
      [&]() -> FoxgloveView::State {
        using Status = FoxgloveView::State::Status;
        return {control.paused ? Status::paused : Status::playing, utime(), control.speed};
      },
      [&](const FoxgloveView::Request& request) -> FoxgloveView::Answer {
        const Answer answer = execute(request.command, request.value, request.text);
        return {answer.ok, answer.text};
      });
  // While the run is paused, nothing else would say where the bodies are.
  if (!control.paused) return;
  session_.foxglove.show_time(utime());
  const bool of_rosbridge = session_.rosbridge && session_.rosbridge->take_subscribed();
  if (session_.foxglove.take_subscribed() || of_rosbridge)
    session_.pass_on(utime(), "sim.bodies", shoal::encode(publisher.bodies()));
  session_.flush();
}

void RunView::ended(const sim::World& world, const sim::RunControl& control, const std::string& why,
                    const std::string& log) {
  send_status(world, control, "", why, log);
}

}  // namespace viewer
