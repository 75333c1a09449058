// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/film_clips.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>

#include "bridges/log/event_log.hpp"
#include "experiment/process/signals.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_event_t.hpp"
#include "shoal/sim_info_t.hpp"
#include "shoal/sim_state_t.hpp"
#include "viewer/film/camera_rig.hpp"
#include "viewer/film/film_source.hpp"
#include "viewer/film/overlay.hpp"

namespace viewer {

namespace {

namespace fs = std::filesystem;

/// Events of the same subject within this time share a clip.
constexpr double same_clip_s = 1;
/// Bound of the films that are written at the same time.
constexpr int max_overlap = 8;
/// Bound of the memory for the events of a log.
constexpr std::size_t max_events = 100'000;

struct LogEvents {
  std::vector<Clip> events;  // with times of the events only
  std::vector<std::string> texts;
  std::set<std::string, std::less<>> vehicles;
};

/// Reads the events of a log; of a run that was rewound the last part counts.
LogEvents read_events(const std::string& log) {
  bridges::EventLogReader file(log);
  bridges::LogEventView event;
  LogEvents found;
  std::int64_t epoch_us = 0;
  while (file.next(event)) {
    try {
      if (event.channel == "sim.info")
        epoch_us = shoal::decode<shoal::sim_info_t>(event.payload, shoal::Finite::any).epoch_utime;
      if (event.channel == "sim.state")
        for (const auto& name : shoal::decode<shoal::sim_state_t>(event.payload, shoal::Finite::any).vehicle)
          found.vehicles.insert(name);
      if (event.channel != "sim.event" || found.events.size() >= max_events) continue;
      const auto message = shoal::decode<shoal::sim_event_t>(event.payload, shoal::Finite::any);
      const double at_s = static_cast<double>(message.utime - epoch_us) / 1e6;
      while (!found.events.empty() && found.events.back().at_s > at_s) found.events.pop_back(), found.texts.pop_back();
      found.events.push_back({at_s, at_s, at_s, message.kind, message.who, "", ""});
      found.texts.push_back(message.text);
    } catch (const shoal::MessageError&) {
      // Damage, which the replay reports.
    }
  }
  return found;
}

/// Returns the vehicle that an event names: as its subject, as the owner of a device, or as a word of its text.
std::string vehicle_of_event(const Clip& event, const std::string& text, const LogEvents& log) {
  const std::string owner = event.who.substr(0, event.who.find('/'));
  if (log.vehicles.contains(owner)) return owner;
  const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (const std::string& words : {event.who, text})
    for (const std::string& name : log.vehicles)
      for (std::size_t at = words.find(name); at != std::string::npos; at = words.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        if ((at == 0 || !is_letter(words[at - 1])) && (end == words.size() || !is_letter(words[end]))) return name;
      }
  return "";
}

/// Returns the name of an event from the subject of what it writes into the log, `event 'NAME'`; else the subject.
std::string subject_of(const std::string& who) {
  constexpr std::string_view start = "event '";
  return who.starts_with(start) && who.ends_with('\'') ? who.substr(start.size(), who.size() - start.size() - 1) : who;
}

/// Returns a text as part of a file name: letters, digits, `-` and `_`, at most 40.
std::string plain(const std::string& text) {
  constexpr std::size_t max_letters = 40;
  std::string name;
  for (const char c : text.substr(0, max_letters))
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  return name.empty() ? "event" : name;
}

/// A clip being rendered.
class OpenClip {
 public:
  OpenClip(const Clip& clip, const sim::World& world, const SceneView& like, const FilmFormat& format)
      : clip_(clip), world_(world), like_(like), writer_(make_film_writer(clip.file, format)) {
    rig_ = make_camera_rig("all", world_, like_);
  }

  const Clip& clip() const { return clip_; }
  void add(ScenePainter& painter, const Overlay& overlay, bool with_overlay, double film_step_s) {
    // A vehicle that is added by the event is followed from then on.
    if (!follows_ && !clip_.vehicle.empty() && world_.find_vehicle(clip_.vehicle) != nullptr) {
      rig_ = make_camera_rig("chase:" + clip_.vehicle, world_, like_);
      follows_ = true;
    }
    SceneView view = rig_->view(frames_++ == 0 ? 0 : film_step_s);
    overlay.prepare(view);
    RenderedScene& rendered = painter.paint(view);
    if (with_overlay) overlay.draw(rendered, view);
    writer_->add(rendered.image);
  }
  void finish() { writer_->finish(); }

 private:
  const Clip& clip_;
  const sim::World& world_;
  const SceneView& like_;
  std::unique_ptr<FilmWriter> writer_;
  std::unique_ptr<CameraRig> rig_;
  bool follows_ = false;
  std::int64_t frames_ = 0;
};

/// Pass through a log that renders its clips.
class Clips {
 public:
  Clips(const FilmOptions& film, std::vector<Clip> clips)
      : film_(film),
        clips_(std::move(clips)),
        source_(open_film_source(film.source, {})),
        world_(source_->world()),
        like_(film_view(film, world_)),
        painter_(world_, film.threads),
        overlay_(world_, film_overlay(film), estimates(), paths()) {}

  void run(ClipOutcome& outcome) {
    // All clips have frames at multiples of the same time.
    const double step_s = film_.speed / film_.format.fps;
    std::size_t next = 0;
    for (auto frame = static_cast<std::int64_t>(std::floor(clips_.front().from_s / step_s));
         next < clips_.size() || !open_.empty(); ++frame) {
      if (open_.empty()) frame = std::max(frame, static_cast<std::int64_t>(std::floor(clips_[next].from_s / step_s)));
      const double now_s = static_cast<double>(frame) * step_s;
      const bool goes_on = advance(now_s, step_s);
      if (experiment::caught_signal() != 0) break;
      for (; next < clips_.size() && clips_[next].from_s < now_s + step_s; ++next)
        open_.push_back(std::make_unique<OpenClip>(clips_[next], world_, like_, film_.format));
      for (const auto& clip : open_) {
        clip->add(painter_, overlay_, film_.overlays.any(), 1.0 / film_.format.fps);
        ++outcome.frames;
      }
      close(now_s + step_s, !goes_on, outcome);
      if (!goes_on) break;
    }
    outcome.interrupted = experiment::caught_signal() != 0;
  }

 private:
  LogEstimates estimates() const {
    if (!film_.overlays.ellipses) return {};
    return {film_.source, clips_.front().from_s - 60, clips_.back().to_s + 60, 0.5 * film_.speed / film_.format.fps};
  }

  LogPaths paths() const {
    if (!film_.overlays.paths) return {};
    return {film_.source, clips_.back().to_s + 60};
  }

  /// Runs to a time, with points for the trails.  Returns false at the end of the log.
  bool advance(double to_s, double step_s) {
    const sim::Time time = sim::from_seconds(to_s);
    while (world_.now() < time && experiment::caught_signal() == 0) {
      if (!source_->step()) return false;
      const double now_s = sim::to_seconds(world_.now());
      overlay_.observe_scans();
      if (now_s - observed_s_ < 0.1 * step_s) continue;
      overlay_.observe();
      observed_s_ = now_s;
    }
    overlay_.observe();
    return true;
  }

  void close(double until_s, bool all, ClipOutcome& outcome) {
    std::erase_if(open_, [&](const std::unique_ptr<OpenClip>& clip) {
      if (!all && clip->clip().to_s >= until_s) return false;
      clip->finish();
      outcome.clips.push_back(clip->clip());
      outcome.clips.back().to_s = std::min(clip->clip().to_s, sim::to_seconds(world_.now()));
      return true;
    });
  }

  const FilmOptions& film_;
  const std::vector<Clip> clips_;
  std::unique_ptr<FilmSource> source_;
  sim::World& world_;
  const SceneView like_;
  ScenePainter painter_;
  Overlay overlay_;
  PingObserver pings_{world_, overlay_};
  std::vector<std::unique_ptr<OpenClip>> open_;
  double observed_s_ = -1;
};

}  // namespace

std::vector<Clip> find_clips(const std::string& log, const ClipOptions& options, ClipOutcome& outcome) {
  if (!is_event_log(log)) throw std::runtime_error(log + ": is not a log; clips are of the events of a recorded run");
  const LogEvents found = read_events(log);
  outcome.events = found.events.size();
  if (found.events.empty()) throw std::runtime_error(log + ": has no events (sim.event), so there is nothing to show");
  std::vector<Clip> clips;
  for (std::size_t i = 0; i < found.events.size(); ++i) {
    Clip clip = found.events[i];
    clip.vehicle = vehicle_of_event(clip, found.texts[i], found);
    clip.who = subject_of(clip.who);
    // Events that belong together, and limits.
    const auto shared = std::find_if(clips.begin(), clips.end(), [&](const Clip& one) {
      return clip.at_s - one.at_s <= same_clip_s &&
             (one.who == clip.who || (!clip.vehicle.empty() && one.vehicle == clip.vehicle));
    });
    if (shared != clips.end()) {
      if (shared->vehicle.empty()) shared->vehicle = clip.vehicle;
      continue;
    }
    clip.from_s = std::max(0.0, clip.at_s - options.before_s);
    clip.to_s = clip.at_s + options.after_s;
    const auto overlapping =
        std::count_if(clips.begin(), clips.end(), [&](const Clip& one) { return one.to_s >= clip.from_s; });
    if (clips.size() >= options.max_clips || overlapping >= max_overlap) {
      ++outcome.without;
      continue;
    }
    // Names sort by time, and differ.
    const std::string start =
        fmt::format("{}/{:09.2f}s_{}_{}", options.directory, clip.at_s, plain(clip.kind), plain(clip.who));
    clip.file = start + options.ending;
    for (int number = 2;
         std::any_of(clips.begin(), clips.end(), [&](const Clip& one) { return one.file == clip.file; }); ++number)
      clip.file = fmt::format("{}_{}{}", start, number, options.ending);
    clips.push_back(std::move(clip));
  }
  return clips;
}

ClipOutcome make_clips(const FilmOptions& film, const ClipOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  ClipOutcome outcome;
  std::vector<Clip> clips = find_clips(film.source, options, outcome);
  std::error_code error;
  fs::create_directories(options.directory, error);
  if (error) throw FilmError(options.directory + ": cannot be created: " + error.message());
  // A wrong format is reported before any frame is rendered.
  check_film_file(clips.front().file, film.format);
  std::make_unique<Clips>(film, std::move(clips))->run(outcome);
  outcome.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

std::string ClipOutcome::to_text() const {
  std::string text;
  for (const Clip& clip : clips)
    text += fmt::format("{}: {} to {} s, {} {}, {}\n", clip.file, fmt::format("{:.2f}", clip.from_s),
                        fmt::format("{:.2f}", clip.to_s), clip.kind, clip.who,
                        clip.vehicle.empty() ? "all in view" : "follows " + clip.vehicle);
  text += fmt::format("{} clips of {} events, {} frames, in {:.1f} s\n", clips.size(), events, frames, wall_s);
  if (without > 0)
    text += fmt::format("note: {} events have no clip: the limits are --max-clips and {} clips at the same time\n",
                        without, max_overlap);
  return text;
}

}  // namespace viewer
