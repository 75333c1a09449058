// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/offline.hpp"

#include <deque>
#include <stdexcept>
#include <type_traits>

#include "autonomy/cooperative/driver/land_run.hpp"
#include "autonomy/cooperative/driver/team_navigator.hpp"

namespace navigation {

namespace {

/// Frames given to the modems, as they were recorded and as they are with this algorithm.
class SentFrames {
 public:
  explicit SentFrames(std::size_t vehicles) : by_vehicle_(vehicles) {}

  void add(int vehicle, const Bytes& recorded, Bytes sent) {
    auto& frames = by_vehicle_[static_cast<std::size_t>(vehicle)];
    frames.push_back({recorded, std::move(sent)});
    if (frames.size() > max_frames) frames.pop_front();
  }
  /// Returns the newest frame that was recorded as these bytes; empty when there is none.
  Bytes find(int vehicle, const Bytes& recorded) const {
    const auto& frames = by_vehicle_[static_cast<std::size_t>(vehicle)];
    for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame)
      if (frame->recorded == recorded) return frame->sent;
    return {};
  }

 private:
  /// A packet arrives before its sender has sent that many more.
  static constexpr std::size_t max_frames = 64;
  struct Frame {
    Bytes recorded, sent;
  };
  std::vector<std::deque<Frame>> by_vehicle_;
};

template <class Message>
constexpr bool is_marine_report = requires(VehicleReports& reports, const Message& message) {
  reports.receive(message);
};

/// One algorithm in each vehicle.
class OwnRun {
 public:
  OwnRun(const NavRecord& record, const Algorithm& algorithm, const std::vector<NavOptions>& options, OfflineRun& run)
      : record_(record), run_(run), frames_(options.size()), estimated_at_(options.size()) {
    for (std::size_t i = 0; i < options.size(); ++i)
      vehicles_.emplace_back(record.team, static_cast<int>(i), algorithm, options[i]);
  }

  void tick(std::size_t i, std::int64_t time_us) {
    vehicles_[i].step();
    const Time now = vehicles_[i].reports().time();
    const auto estimate = vehicles_[i].estimate();
    if (!estimate || now == estimated_at_[i]) return;
    estimated_at_[i] = now;
    run_.estimates[i].push_back({time_us, vehicles_[i].message(*estimate)});
  }
  void add(const NavRecord::Item& item) {
    VehicleNavigation& vehicle = vehicles_[static_cast<std::size_t>(item.vehicle)];
    std::visit([&](const auto& message) { add(item.vehicle, vehicle, message); }, item.message);
  }
  void finish() {
    for (const VehicleNavigation& vehicle : vehicles_) run_.ranges += vehicle.ranges();
  }

 private:
  template <class Message>
  void add(int index, VehicleNavigation& vehicle, const Message& message) {
    if constexpr (std::is_same_v<Message, shoal::modem_send_t>) {
      auto frame = vehicle.make_payload();
      if (!frame) return;
      ++run_.frames_said;
      run_.payload_bytes[static_cast<std::size_t>(index)] += payload_length(*frame);
      frames_.add(index, message.data, std::move(*frame));
    } else if constexpr (std::is_same_v<Message, shoal::acoustic_received_t>) {
      if (const auto sender = record_.team->index_of(message.source))
        vehicle.on_range(message, frames_.find(*sender, message.data));
    } else if constexpr (is_marine_report<Message>) {
      vehicle.receive(message);
    }
  }

  const NavRecord& record_;
  OfflineRun& run_;
  SentFrames frames_;
  std::vector<VehicleNavigation> vehicles_;
  std::vector<Time> estimated_at_;
};

/// One algorithm for the whole team.
class TeamRun {
 public:
  TeamRun(const NavRecord& record, const Algorithm& algorithm, const std::vector<NavOptions>& options, OfflineRun& run)
      : record_(record),
        run_(run),
        frames_(options.size()),
        estimator_(algorithm.make_team()),
        team_(options.size()),
        options_(options),
        estimated_at_(options.size()) {
    for (std::size_t i = 0; i < options.size(); ++i)
      vehicles_.emplace_back(record.team, static_cast<int>(i), options[i].start, options[i].sound,
                             seconds(options[i].period_us));
  }

  void tick(std::size_t i, std::int64_t time_us) {
    vehicles_[i].step();
    const Time now = vehicles_[i].time();
    if (!vehicles_[i].setup() || now == estimated_at_[i]) return;
    estimated_at_[i] = now;
    // Later events of the record do not change it: they are sorted by their times.
    team_.query(static_cast<int>(i), now, [this, i, time_us, reports = vehicles_[i]](const Estimate& estimate) {
      run_.estimates[i].push_back({time_us, reports.message(estimate)});
    });
  }
  void add(const NavRecord::Item& item) {
    std::visit([&](const auto& message) { add(item.vehicle, message); }, item.message);
  }
  void finish() { team_.run(*estimator_); }

 private:
  template <class Message>
  void add(int index, const Message& message) {
    VehicleReports& reports = vehicles_[static_cast<std::size_t>(index)];
    if constexpr (std::is_same_v<Message, shoal::modem_send_t>) {
      if (!reports.setup()) return;
      const Time time = reports.transmission();
      const NavFrame frame = reports.frame(time, {});
      team_.sent(index, time, frame.payload_time);
      ++run_.frames_said;
      frames_.add(index, message.data, encode_frame(frame, frame_overhead_bytes));
    } else if constexpr (std::is_same_v<Message, shoal::acoustic_received_t>) {
      const auto sender = record_.team->index_of(message.source);
      const auto frame = sender ? decode_frame(frames_.find(*sender, message.data), message.sent_utime) : std::nullopt;
      const auto event = frame ? reports.range_event(message, *frame) : std::nullopt;
      if (!event) return;
      ++run_.ranges;
      team_.add(index, *event);
    } else if constexpr (is_marine_report<Message>) {
      const bool started = reports.setup().has_value();
      const std::vector<NavEvent> events = reports.receive(message);
      if (!started && reports.setup())
        team_.start(index, completed(*reports.setup(), options_[static_cast<std::size_t>(index)]));
      for (const NavEvent& event : events) team_.add(index, event);
    }
  }

  const NavRecord& record_;
  OfflineRun& run_;
  SentFrames frames_;
  std::unique_ptr<TeamEstimator> estimator_;
  TeamNavigator team_;
  std::vector<VehicleReports> vehicles_;
  std::vector<NavOptions> options_;
  std::vector<Time> estimated_at_;
};

template <class Run>
void play(const NavRecord& record, const std::vector<NavOptions>& options, Run& run) {
  std::vector<std::int64_t> tick_us(options.size(), 0);
  const auto tick = [&](std::size_t vehicle) {
    run.tick(vehicle, tick_us[vehicle]);
    tick_us[vehicle] += options[vehicle].period_us;
  };
  for (const NavRecord::Item& item : record.items) {
    // The decision of a tick is made after all that was published until then.
    for (std::size_t i = 0; i < options.size(); ++i)
      while (tick_us[i] < item.time_us) tick(i);
    // What a program sent at a tick is recorded at its time, but it sent it after its decision.
    const auto own = static_cast<std::size_t>(item.vehicle);
    if (std::holds_alternative<shoal::modem_send_t>(item.message) && tick_us[own] == item.time_us) tick(own);
    run.add(item);
  }
  for (std::size_t i = 0; i < options.size(); ++i)
    while (tick_us[i] <= record.end_us) tick(i);
  run.finish();
}

}  // namespace

OfflineRun run_offline(const NavRecord& record, const Algorithm& algorithm, const std::vector<NavOptions>& options) {
  const bool on_land = record.team->is_on_land();
  if (on_land && !algorithm.on_land)
    throw std::invalid_argument(algorithm.name +
                                " does not use relative measurements of other vehicles: it does not work on land");
  if (!on_land && !algorithm.at_sea)
    throw std::invalid_argument(algorithm.name + " does not use acoustic ranges: it works on land only");
  OfflineRun run;
  run.algorithm = algorithm.name;
  run.estimates.resize(options.size());
  run.payload_bytes.resize(options.size());
  run.events = record.items.size();
  const AlgorithmClock clock(algorithm);
  if (on_land) {
    LandRun(record, algorithm, options, run).play();
  } else if (algorithm.make_team) {
    TeamRun team(record, algorithm, options, run);
    play(record, options, team);
  } else {
    OwnRun own(record, algorithm, options, run);
    play(record, options, own);
  }
  run.cpu_s = clock.elapsed_s();
  return run;
}

}  // namespace navigation
