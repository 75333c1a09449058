// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/recording_bus.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "bridges/mcap/mcap_record.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_event_t.hpp"
#include "sim/base/log.hpp"

namespace bridges {
namespace {

constexpr std::chrono::milliseconds shortest_pause{50};
constexpr std::chrono::milliseconds max_buffered{250};

/// Returns the path of a record.  Throws BusError when its format cannot hold the epoch.
const std::string& with_valid_epoch(const std::string& path, std::int64_t epoch_utime) {
  if (is_mcap_name(path))
    if (const std::string why = mcap::time_error(epoch_utime); !why.empty())
      throw BusError(path + ": the 'epoch' of the world cannot be recorded: " + why);
  return path;
}

}  // namespace

RecordingBus::RecordingBus(std::unique_ptr<sim::Bus> inner, const std::string& path, std::int64_t epoch_utime,
                           Existing existing)
    : RecordingBus(*inner, path, epoch_utime, existing) {
  owned_ = std::move(inner);
}

RecordingBus::RecordingBus(sim::Bus& inner, const std::string& path, std::int64_t epoch_utime, Existing existing)
    : inner_(inner),
      path_(path),
      epoch_utime_(epoch_utime),
      utime_(epoch_utime),
      log_(create_record(with_valid_epoch(path, epoch_utime), existing)) {}

RecordingBus::RecordingBus(sim::Bus& inner, RecordingBus& first) : inner_(inner), first_(&first) {}

RecordingBus::~RecordingBus() {
  close();
}

void RecordingBus::publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) {
  inner_.publish(channel, payload, at);
  set_time(at);
  record(channel, payload);
}

class RecordingBus::RecordedChannel final : public sim::OpenChannel {
 public:
  RecordedChannel(RecordingBus& bus, const std::string& name)
      : bus_(bus), name_(name), inner_(bus.inner_.open_channel(name)) {}

  void publish(std::span<const std::byte> payload, sim::Time at) override {
    inner_->publish(payload, at);
    bus_.set_time(at);
    bus_.record(name_, payload);
  }

 private:
  RecordingBus& bus_;
  const std::string name_;
  const std::unique_ptr<sim::OpenChannel> inner_;
};

std::unique_ptr<sim::OpenChannel> RecordingBus::open_channel(const std::string& channel) {
  return std::make_unique<RecordedChannel>(*this, channel);
}

void RecordingBus::admitted(std::span<const sim::MessageGate::Delivery> input_record) {
  for (const sim::MessageGate::Delivery& each : input_record) record(each.channel, each.payload);
}

void RecordingBus::set_time(sim::Time at) {
  if (first_) return first_->set_time(at);
  utime_ = std::max(utime_, epoch_utime_ + at.count());
}

void RecordingBus::record(std::string_view channel, std::span<const std::byte> payload) {
  if (first_) return first_->record(channel, payload);
  if (!log_ || error_) return;
  if (budget_ && leaves_out(channel, payload.size())) {
    ++left_out_;
    return;
  }
  if (!log_) return;  // the budget is used up
  errno = 0;
  if (!log_->write(static_cast<std::int64_t>(recorded_), utime_, channel, payload)) return fail(errno);
  ++recorded_;
  // Write once per simulated second, at limited intervals, so that a killed run loses little, and `tail` can follow the
  // file.
  if (const std::int64_t second = (utime_ - epoch_utime_) / 1'000'000; second > checked_s_) {
    checked_s_ = second;
    hand_over();
  }
}

void RecordingBus::set_budget(const RecordBudget& budget) {
  budget_ = budget;
  shoal::sim_event_t note{};
  note.utime = utime_;
  note.kind = "budget";
  note.who = "record";
  note.text = std::to_string(budget.bytes) + " bytes: messages may be left out";
  record(budget_channel, shoal::encode(note));
}

bool RecordingBus::leaves_out(std::string_view channel, std::size_t bytes) {
  constexpr double head_start = 0.02;  // of the budget, for the description of the world
  constexpr std::int64_t minute_s = 60;
  constexpr std::size_t head_bytes = 100;  // of an event, with its channel
  // The share of the budget at this second.
  const std::int64_t second = (utime_ - epoch_utime_) / 1'000'000;
  if (second != decided_s_) {
    decided_s_ = second;
    const double passed = budget_->duration_us > 0
                              ? static_cast<double>(utime_ - epoch_utime_) / static_cast<double>(budget_->duration_us)
                              : 1;
    const double share = std::min(1.0, head_start + (1 - head_start) * passed);
    thins_ = static_cast<double>(position()) > share * static_cast<double>(budget_->bytes);
  }
  const auto kept = kept_s_.find(channel);
  const bool is_first = kept == kept_s_.end() || second >= kept->second + minute_s;
  const bool needed = channel.starts_with("sim.") && channel != "sim.state" && channel != "sim.bodies";
  if (thins_ && !needed && !is_first) return true;
  if (position() + bytes + head_bytes > budget_->bytes) {
    if (!needed) return true;
    sim::log_warn(
        "{}: the record has used its budget of {} MB at {} s and ends; the data needed for a replay does not fit",
        path_, static_cast<double>(budget_->bytes) / 1e6, second);
    close();
    return false;
  }
  if (kept == kept_s_.end())
    kept_s_.emplace(channel, second);
  else if (is_first)
    kept->second = second;
  return false;
}

void RecordingBus::end_of_step() {
  inner_.end_of_step();
  // A simulated second may take minutes in a slow run or a large world.
  if (!first_) hand_over_after(max_buffered);
}

void RecordingBus::hand_over() {
  if (first_) return first_->hand_over();
  hand_over_after(shortest_pause);
}

void RecordingBus::hand_over_after(std::chrono::milliseconds pause) {
  if (!log_ || error_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - handed_over_ < pause) return;
  handed_over_ = now;
  if (!log_->hand_over()) fail(errno);
}

void RecordingBus::prepare(const std::string& path, std::uint64_t events, std::uint64_t position, Existing existing) {
  give_up();
  if (!log_ || error_) return;
  errno = 0;
  if (!log_->flush()) return fail(errno);
  next_ = Next{path, events, log_->branch_to(path, position, existing)};
  if (next_->log) return;
  give_up();
  throw BusError(path + ": cannot copy " + path_ + " into it");
}

void RecordingBus::give_up() {
  if (!next_) return;
  const std::string path = next_->path;
  next_.reset();
  std::remove(path.c_str());
}

void RecordingBus::go_on() {
  if (!next_) return;
  log_ = std::move(next_->log);
  path_ = next_->path;
  recorded_ = next_->events;
  next_.reset();
  utime_ = epoch_utime_;  // after a rewind the next set_time() sets the time
  checked_s_ = 0;
}

void RecordingBus::fail(int error_number) {
  error_ = path_ + ": cannot record: " + std::strerror(error_number != 0 ? error_number : EIO);
}

void RecordingBus::close() {
  if (!log_) return;
  errno = 0;
  if (!error_ && !log_->finish()) fail(errno);
  for (const std::string& problem : log_->problems()) sim::log_warn("{}: {}", path_, problem);
  log_.reset();
}

}  // namespace bridges
