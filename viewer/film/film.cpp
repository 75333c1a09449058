// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/film.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "experiment/process/signals.hpp"
#include "sim/base/log.hpp"
#include "viewer/film/background_writer.hpp"
#include "viewer/film/camera_rig.hpp"
#include "viewer/film/film_source.hpp"
#include "viewer/film/overlay.hpp"
#include "viewer/film/scene_painter.hpp"

namespace viewer {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Line of progress: renewed on a terminal, one every 10 s elsewhere.
class FilmProgress {
 public:
  explicit FilmProgress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}
  ~FilmProgress() { clear(); }
  FilmProgress(const FilmProgress&) = delete;
  FilmProgress& operator=(const FilmProgress&) = delete;

  void update(std::int64_t frame, std::int64_t frames, double now_s) {
    if (quiet_ || seconds_since(last_) < (terminal_ ? 0.25 : 10.0)) return;
    last_ = Clock::now();
    const double rate = static_cast<double>(frame) / std::max(1e-3, seconds_since(start_));
    std::fprintf(stderr, "%s%s%s", terminal_ ? "\r" : "",
                 fmt::format("frame {} of {}, {:.1f} s, {:.0f} frames/s", frame, frames, now_s, rate).c_str(),
                 terminal_ ? "   " : "\n");
    shown_ = terminal_;
  }
  void clear() {
    if (shown_) std::fprintf(stderr, "\r%60s\r", "");
    shown_ = false;
  }

 private:
  bool quiet_, terminal_, shown_ = false;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

/// Copies an image into a frame, in the middle of the columns [first, first + width).
void place(const sim::Image8& image, int first, int width, sim::Image8& frame) {
  const int left = first + (width - image.width) / 2, top = (frame.height - image.height) / 2;
  for (int row = 0; row < image.height; ++row) {
    if (image.channels == 3) {
      std::copy_n(image.at(0, row), std::size_t{3} * static_cast<std::size_t>(image.width), frame.at(left, top + row));
      continue;
    }
    for (int column = 0; column < image.width; ++column) {
      const std::uint8_t* from = image.at(column, row);
      std::uint8_t* to = frame.at(left + column, top + row);
      for (int channel = 0; channel < 3; ++channel) to[channel] = *from;
    }
  }
}

class Film {
 public:
  explicit Film(const FilmOptions& options)
      : options_(options),
        source_(open(options)),
        world_(source_->world()),
        until_s_(end(options, *source_)),
        painter_(world_, options.threads),
        overlay_(world_, film_overlay(options), estimates(), paths()) {
    start();
  }

  FilmOutcome run() {
    const Clock::time_point start = Clock::now();
    const std::int64_t frames = frame_count();
    BackgroundWriter writer(make_film_writer(options_.out, options_.format));
    FilmProgress progress(options_.quiet);
    for (std::int64_t i = 0; i < frames && experiment::caught_signal() == 0; ++i) {
      if (!advance(options_.from_s + static_cast<double>(i) * step_s())) {
        outcome_.note = fmt::format("the run ends at {:.3f} s", sim::to_seconds(world_.now()));
        break;
      }
      writer.add(paint(i == 0 ? 0 : 1.0 / options_.format.fps));
      ++outcome_.frames;
      progress.update(i + 1, frames, sim::to_seconds(world_.now()));
    }
    progress.clear();
    outcome_.interrupted = experiment::caught_signal() != 0;
    // A film that is not finished leaves an earlier file of its name alone.
    if (outcome_.interrupted) return outcome_;
    writer.finish();
    outcome_.wall_s = seconds_since(start);
    outcome_.film_s = static_cast<double>(outcome_.frames) / options_.format.fps;
    outcome_.sim_s = sim::to_seconds(world_.now()) - options_.from_s;
    return outcome_;
  }

 private:
  static std::unique_ptr<FilmSource> open(const FilmOptions& options) {
    check_film_file(options.out, options.format);
    return open_film_source(options.source, options.load);
  }

  static double end(const FilmOptions& options, const FilmSource& source) {
    constexpr double usual_s = 10;
    if (options.until_s) return std::min(*options.until_s, source.end_s());
    return std::isfinite(source.end_s()) ? source.end_s() : options.from_s + usual_s * options.speed;
  }

  /// Simulated time between frames.
  double step_s() const { return options_.speed / options_.format.fps; }
  std::int64_t frame_count() const {
    return 1 + static_cast<std::int64_t>(std::floor((until_s_ - options_.from_s) / step_s() + 1e-9));
  }

  LogEstimates estimates() const {
    if (!options_.overlays.ellipses || source_->log().empty()) return {};
    return {source_->log(), options_.from_s - 60, until_s_, 0.5 * step_s()};
  }

  LogPaths paths() const {
    if (!options_.overlays.paths || source_->log().empty()) return {};
    return {source_->log(), until_s_};
  }

  /// Runs to the first frame, and makes the cameras.
  void start() {
    if (const std::size_t programs = world_.config().processes.size(); programs > 0 && source_->log().empty())
      sim::log_warn("a world is shown without its {} programs; record a run with them: shoal run --launch --record",
                    programs);
    const double start_s = sim::to_seconds(world_.now());
    if (options_.from_s < start_s)
      throw std::runtime_error(fmt::format("{}: begins at {:.6g} s, after --from", options_.source, start_s));
    if (until_s_ < options_.from_s || !advance(options_.from_s))
      throw std::runtime_error(fmt::format("{}: ends at {:.6g} s, before --from", options_.source,
                                           until_s_ < options_.from_s ? until_s_ : sim::to_seconds(world_.now())));
    SceneView like = film_view(options_, world_);
    if (options_.cameras.size() > 1 || options_.split) like.optics.width /= 2;
    for (const std::string& camera : options_.cameras) rigs_.push_back(make_camera_rig(camera, world_, like));
    if (!options_.split || rigs_.size() > 1) return;
    const std::string on_board = first_camera(world_, rigs_.front()->subject());
    if (on_board.empty())
      throw CameraError(rigs_.front()->subject().empty()
                            ? "no vehicle has a camera for --split 2"
                            : "vehicle '" + rigs_.front()->subject() + "' has no camera for --split 2");
    rigs_.push_back(make_camera_rig("from:" + on_board, world_, like));
  }

  /// Runs to a time; trails have a point at each tenth of a frame, at most.
  bool advance(double to_s) {
    const sim::Time time = sim::from_seconds(to_s);
    while (world_.now() < time && experiment::caught_signal() == 0) {
      if (!source_->step()) return false;
      const double now_s = sim::to_seconds(world_.now());
      if (now_s > options_.from_s - LaserScans::kept_s) overlay_.observe_scans();
      if (now_s < options_.from_s - 15 * options_.speed || now_s - observed_s_ < 0.1 * step_s()) continue;
      overlay_.observe();
      observed_s_ = now_s;
    }
    return true;
  }

  const sim::Image8& paint(double film_step_s) {
    overlay_.observe();
    const int columns = options_.format.width / static_cast<int>(rigs_.size());
    frame_.width = options_.format.width, frame_.height = options_.format.height, frame_.channels = 3;
    frame_.data.assign(frame_.size(), 0);
    // Views side by side, each of half the width.
    for (std::size_t i = 0; i < rigs_.size(); ++i) {
      SceneView view = rigs_[i]->view(film_step_s);
      overlay_.prepare(view);
      RenderedScene& rendered = painter_.paint(view);
      if (options_.overlays.any() && view.options.kind == sim::ImageKind::color) overlay_.draw(rendered, view);
      place(rendered.image, static_cast<int>(i) * columns, columns, frame_);
    }
    return frame_;
  }

  const FilmOptions& options_;
  std::unique_ptr<FilmSource> source_;
  sim::World& world_;
  double until_s_;
  ScenePainter painter_;
  Overlay overlay_;
  PingObserver pings_{world_, overlay_};
  std::vector<std::unique_ptr<CameraRig>> rigs_;
  sim::Image8 frame_;
  double observed_s_ = -1;
  FilmOutcome outcome_;
};

}  // namespace

std::string FilmOutcome::to_text(const FilmOptions& options) const {
  std::string text = fmt::format(
      "{}: {} frames of {}x{}, {:.1f} s of film for {:.1f} s of the run, in {:.1f} s ({:.0f} "
      "frames/s)\n",
      options.out, frames, options.format.width, options.format.height, film_s, sim_s, wall_s,
      wall_s > 0 ? static_cast<double>(frames) / wall_s : 0.0);
  if (!note.empty()) text += "note: " + note + "\n";
  return text;
}

SceneView film_view(const FilmOptions& options, const sim::World& world) {
  SceneView view;
  view.optics.width = options.format.width;
  view.optics.height = options.format.height;
  view.optics.fov_rad = options.fov_rad;
  view.antialias = options.antialias;
  if (options.visibility_m) view.water = sim::WaterLook{sim::water_optics(*options.visibility_m)};
  view.options.light = world.config().light;
  return view;
}

Overlay::Settings film_overlay(const FilmOptions& options) {
  Overlay::Settings settings;
  settings.choice = options.overlays;
  settings.trail_s = std::max(20.0, 15 * options.speed);
  settings.title = options.speed == 1 ? "" : fmt::format("x{:g}", options.speed);
  return settings;
}

FilmOutcome make_film(const FilmOptions& options) {
  return std::make_unique<Film>(options)->run();
}

}  // namespace viewer
