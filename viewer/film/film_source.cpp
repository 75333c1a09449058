// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/film_source.hpp"

#include <array>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "experiment/replay/replayed_world.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/world/standalone_world.hpp"

namespace viewer {

namespace {

/// World without programs.
class WorldSource final : public FilmSource {
 public:
  explicit WorldSource(sim::LoadedWorld loaded) : loaded_(std::move(loaded)), world_(loaded_.config) {
    world_.use_threads(0);
  }

  sim::World& world() override { return world_; }
  bool step() override {
    world_.step();
    return true;
  }
  double end_s() const override { return std::numeric_limits<double>::infinity(); }
  const std::string& log() const override { return log_; }

 private:
  sim::LoadedWorld loaded_;
  sim::StandaloneWorld world_;
  std::string log_;
};

/// World of a log.
class LogSource final : public FilmSource {
 public:
  explicit LogSource(const std::string& path) : log_(experiment::read_replay_log(path)), replayed_(log_, {}) {
    replayed_.start();
  }

  sim::World& world() override { return replayed_.world(); }
  bool step() override {
    if (replayed_.world().step_number() >= log_.usable_step()) return false;
    replayed_.step();
    return true;
  }
  double end_s() const override {
    return static_cast<double>(log_.usable_step()) * sim::to_seconds(replayed_.world().step_time());
  }
  const std::string& log() const override { return log_.path; }

 private:
  experiment::ReplayLog log_;
  experiment::ReplayedWorld replayed_;
};

}  // namespace

bool FilmSource::advance_to(sim::Time time) {
  while (world().now() < time)
    if (!step()) return false;
  return true;
}

bool is_event_log(const std::string& path) {
  std::array<char, 4> start{};
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), start.size());
  return file.gcount() == 4 && start == std::array<char, 4>{'\xED', '\xA1', '\xDA', '\x01'};
}

std::unique_ptr<FilmSource> open_film_source(const std::string& log_or_world, const sim::LoadOptions& load) {
  if (is_event_log(log_or_world)) {
    if (load.seed || !load.sets.empty())
      throw std::runtime_error(log_or_world + ": is a log, which is shown as it was: --seed and --set are for worlds");
    return std::make_unique<LogSource>(log_or_world);
  }
  sim::LoadOptions options = load;
  options.encode_message = shoal::encode_own_message;
  return std::make_unique<WorldSource>(sim::load_world(experiment::world_file(log_or_world), options));
}

}  // namespace viewer
