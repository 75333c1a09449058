// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/log_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bridges/base/json_text.hpp"
#include "shoal/message_schema.hpp"
#include "viewer/log/message_times.hpp"
#include "viewer/server/page_traffic.hpp"

namespace viewer {

namespace {

using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

/// Number of events between looks at the clock.
constexpr int events_per_look = 256;

struct Sample {
  std::int64_t t_us;
  double value;
};

/// Values that come in the order of time: all of them while they are few, and the extremes of equal intervals.
class Decimator {
 public:
  explicit Decimator(const SeriesRequest& request)
      : points_(request.points), from_us_(request.from_us), extremes_(request.points / 2) {
    span_us_ = static_cast<double>(request.to_us) - static_cast<double>(request.from_us) + 1;
  }

  void add(const Sample& sample) {
    if (all_.size() <= points_) all_.push_back(sample);
    const double share = (static_cast<double>(sample.t_us) - static_cast<double>(from_us_)) / span_us_;
    const auto last = static_cast<double>(extremes_.size() - 1);
    Extremes& place = extremes_[static_cast<std::size_t>(std::clamp(share * (last + 1), 0.0, last))];
    if (std::isnan(sample.value)) return;
    if (!place.smallest || sample.value < place.smallest->value) place.smallest = sample;
    if (!place.largest || sample.value > place.largest->value) place.largest = sample;
  }

  Series take() const {
    Series series;
    const auto put = [&](const Sample& sample) {
      series.t_us.push_back(sample.t_us);
      series.values.push_back(sample.value);
    };
    if (all_.size() <= points_) {
      for (const Sample& sample : all_) put(sample);
      return series;
    }
    // The smallest and the largest value of each interval, in order of time: peaks stay visible.
    for (const auto& [smallest, largest] : extremes_) {
      if (!smallest) continue;
      const bool falls = largest->t_us < smallest->t_us;
      put(falls ? *largest : *smallest);
      if (smallest->t_us != largest->t_us || smallest->value != largest->value) put(falls ? *smallest : *largest);
    }
    return series;
  }

 private:
  struct Extremes {
    std::optional<Sample> smallest, largest;
  };
  const std::size_t points_;
  const std::int64_t from_us_;
  double span_us_ = 1;
  std::vector<Sample> all_;
  std::vector<Extremes> extremes_;
};

std::optional<double> number_in(const shoal::FieldValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? 1 : 0;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  if (const double* number = std::get_if<double>(&value)) return *number;
  return std::nullopt;
}

/// Field of the messages of a channel, and what was found of it.
class FieldReader {
 public:
  explicit FieldReader(const SeriesRequest& request) : request_(request) {}

  /// Returns the number in a message; none when it has none.
  std::optional<double> read(std::span<const std::byte> payload) {
    ++messages_;
    const auto* schema = shoal::embedded_types().find(static_cast<std::uint64_t>(shoal::fingerprint(payload)));
    if (schema == nullptr) return std::nullopt;
    type_ = schema;
    std::optional<double> number;
    shoal::visit_fields(*schema, payload, [&](std::string_view name, const shoal::FieldValue& value) {
      if (name != request_.field) return;
      number = number_in(value);
      if (!number) is_text_ = true;
    });
    if (number) ++numbers_;
    return number;
  }
  /// Throws PageRequestError when there was no number.
  void check() const {
    if (numbers_ > 0) return;
    const std::string what = "series: ";
    if (messages_ == 0) throw PageRequestError(what + "no message on '" + request_.channel + "' in this range of time");
    if (type_ == nullptr)
      throw PageRequestError(what + "the messages on '" + request_.channel + "' are of an unknown type");
    if (is_text_) throw PageRequestError(what + "'" + request_.field + "' of " + type_->name + " is not a number");
    throw PageRequestError(what + type_->name + " on '" + request_.channel + "' has no field '" + request_.field + "'");
  }

 private:
  const SeriesRequest& request_;
  const shoal::MessageSchema* type_ = nullptr;
  std::int64_t messages_ = 0, numbers_ = 0;
  bool is_text_ = false;
};

}  // namespace

Series read_series(bridges::EventLogReader& log, const LogIndex& index, const SeriesRequest& request,
                   Clock::time_point deadline) {
  // Begin before the first message of the range: those of a step come before its poses
  log.seek(request.from_us <= index.start_us() ? 0 : index.bodies_at(request.from_us - 1).offset);
  MessageTimes times(index.epoch_us());
  FieldReader field(request);
  Decimator decimator(request);
  bridges::LogEventView event;
  for (std::int64_t number = 0; log.next(event); ++number) {
    if (number % events_per_look == 0 && Clock::now() > deadline)
      throw PageRequestError("series: the log from " + std::to_string(request.from_us) + " to " +
                             std::to_string(request.to_us) +
                             " us cannot be read within a second; ask for a shorter range");
    times.take(event.channel, event.payload, event.utime);
    const std::int64_t t_us = times.steady_us() - index.epoch_us();
    if (t_us > request.to_us && (event.channel == "sim.bodies" || event.channel == "sim.clock")) break;
    if (event.channel != request.channel || t_us < request.from_us || t_us > request.to_us) continue;
    if (const auto value = field.read(event.payload)) decimator.add({t_us, *value});
  }
  field.check();
  return decimator.take();
}

LogSeries::LogSeries(const std::string& path, const LogIndex& index, bridges::WebServer& server)
    : index_(index), server_(server), log_(path), thread_([this] { run(); }) {}

LogSeries::~LogSeries() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void LogSeries::request(const bridges::ViewRequest& request) {
  constexpr std::size_t max_jobs = 64;
  constexpr std::chrono::milliseconds time{900};  // the answer takes the rest of the second
  try {
    Job job{request, parse_series(request.text), Clock::now() + time};
    const std::lock_guard lock(mutex_);
    if (jobs_.size() >= max_jobs) throw PageRequestError("series: too many requests are waiting");
    jobs_.push_back(std::move(job));
  } catch (const PageRequestError& error) {
    return refuse(server_, request, error.what());
  }
  wake_.notify_one();
}

void LogSeries::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return ends_ || !jobs_.empty(); });
    if (ends_) return;
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    // Reading a log takes long; requests can be added meanwhile.
    lock.unlock();
    answer(job);
    lock.lock();
  }
}

void LogSeries::answer(const Job& job) {
  try {
    const Series series = read_series(log_, index_, job.series, job.deadline);
    Json values = Json::array();
    for (const double value : series.values) values.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
    server_.reply(job.request.client, bridges::json_text({{"op", "series"},
                                                          {"id", Json::parse(job.series.id)},
                                                          {"t_us", series.t_us},
                                                          {"values", std::move(values)}}));
  } catch (const std::exception& error) {  // of the request, or the file cannot be read any more
    refuse(server_, job.request, error.what());
  }
}

}  // namespace viewer
