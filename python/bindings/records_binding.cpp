// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bridges/log/event_log.hpp"
#include "bridges/log/record_file.hpp"
#include "bridges/mcap/mcap_reader.hpp"
#include "bridges/ros2/cdr_transcoder.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/in_use.hpp"
#include "python/bindings/message_objects.hpp"
#include "python/world/error.hpp"
#include "sim/config/message_text.hpp"

namespace py = pybind11;

namespace python {
namespace {

/// Event of a record, valid until the next one is read.
struct Event {
  std::string_view channel;
  std::int64_t utime = 0;
  std::span<const std::byte> payload;
};

/// Reader of the events of a file.
class EventSource {
 public:
  virtual ~EventSource() = default;
  /// Reads the next event; returns false at the end.
  virtual bool next(Event& event) = 0;
  virtual std::vector<std::string> problems() const = 0;
};

class LogSource final : public EventSource {
 public:
  /// Reads the first event, so that a file that is not a log is refused at once.  An empty file is a log.
  explicit LogSource(const std::string& path) : log_(path), has_first_(log_.next(first_)) {
    if (!has_first_ && log_.file_bytes() > 0)
      throw Error(path +
                  ": is not an LCM log: it contains no readable event (the name of an MCAP file ends with .mcap)");
  }
  bool next(Event& event) override {
    bridges::LogEventView view = first_;
    if (!std::exchange(has_first_, false) && !log_.next(view)) return false;
    event = {view.channel, view.utime, view.payload};
    return true;
  }
  std::vector<std::string> problems() const override { return log_.problems(); }

 private:
  bridges::EventLogReader log_;
  bridges::LogEventView first_;
  bool has_first_;  // and it was not given away
};

/// The messages of LCM channels in an MCAP file of Shoal; topics that repeat them in standard types are left out.
class McapSource final : public EventSource {
 public:
  explicit McapSource(const std::string& path) : file_(path) {}
  bool next(Event& event) override {
    using Item = bridges::mcap::McapReader::Item;
    for (Item item = file_.next(); item != Item::end; item = file_.next())
      if (item == Item::message && read(event)) return true;
    return false;
  }
  std::vector<std::string> problems() const override {
    std::vector<std::string> all = file_.problems();
    all.insert(all.end(), problems_.begin(), problems_.end());
    return all;
  }

 private:
  bool read(Event& event) {
    const bridges::mcap::Message& message = file_.message();
    const bridges::mcap::Channel& channel = file_.channel(message.channel);
    const auto name = channel.metadata.find("lcm_channel"), type = channel.metadata.find("lcm_type");
    if (name == channel.metadata.end()) return false;
    event = {name->second, static_cast<std::int64_t>(message.log_time_ns / 1000), message.data};
    if (channel.encoding == "lcm") return true;
    if (type == channel.metadata.end()) return false;
    const shoal::MessageSchema* const schema = shoal::embedded_types().find(type->second);
    const auto error = schema == nullptr ? std::optional("there is no message type '" + type->second + "'")
                                         : bridges::ros2::from_cdr(*schema, message.data, payload_);
    constexpr std::size_t max_problems = 100;
    if (error && problems_.size() < max_problems) problems_.push_back(name->second + ": " + *error);
    event.payload = payload_;
    return !error;
  }

  bridges::mcap::McapReader file_;
  std::vector<std::byte> payload_;
  std::vector<std::string> problems_;
};

std::unique_ptr<EventSource> open_record(const std::string& path) {
  if (bridges::is_mcap_name(path)) return std::make_unique<McapSource>(path);
  return std::make_unique<LogSource>(path);
}

/// Reader of a record.
class RecordReader : public Guarded {
 public:
  explicit RecordReader(const std::string& path) : Guarded("the record"), source_(open_record(path)) {}

  /// Returns channel, time stamp and payload of the next event on one of these channels; none at the end.
  std::optional<py::tuple> next(const std::vector<std::string>& channels) {
    const Use use(*this);
    Event event;
    while (source_->next(event)) {
      if (!channels.empty() && names_.find(event.channel) == names_.end()) names_.emplace(event.channel);
      if (channels.empty() || std::find(channels.begin(), channels.end(), event.channel) != channels.end())
        return py::make_tuple(py::str(event.channel.data(), event.channel.size()), event.utime,
                              py::bytes(reinterpret_cast<const char*>(event.payload.data()), event.payload.size()));
      if ((++skipped_ & 4095) == 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    return std::nullopt;
  }
  std::vector<std::string> problems() {
    const Use use(*this);
    return source_->problems();
  }
  /// Returns a text for each of the channels of next() on which nothing was found so far.
  std::vector<std::string> missing(const std::vector<std::string>& channels) {
    const Use use(*this);
    std::vector<std::string> texts;
    for (const std::string& channel : channels)
      if (!names_.contains(channel))
        texts.push_back("no messages on '" + sim::shortened(sim::printable(channel)) + "'" +
                        sim::did_you_mean(channel, {names_.begin(), names_.end()}));
    return texts;
  }

 private:
  const std::unique_ptr<EventSource> source_;
  std::set<std::string, std::less<>> names_;  // of the channels that were found
  std::uint64_t skipped_ = 0;
};

/// Writer of a record: an LCM event log or, by its name, an MCAP file.
class RecordWriter : public Guarded {
 public:
  RecordWriter(const std::string& path, bool overwrite)
      : Guarded("the record"),
        path_(path),
        file_(bridges::create_record(path, overwrite ? bridges::Existing::overwrite : bridges::Existing::refuse)) {}
  ~RecordWriter() {
    if (!is_ours())
      file_.release();  // a fork has the memory but not the thread that writes
    else if (file_)
      file_->finish();
  }

  void write(const std::string& channel, std::int64_t utime, const py::bytes& payload) {
    const Use use(*this);
    if (!file_) throw Error(path_ + ": the record is closed");
    if (channel.empty() || channel.size() > sim::Bus::max_channel_length)
      throw Error("a channel has 1 to " + std::to_string(sim::Bus::max_channel_length) + " characters, got '" +
                  channel + "'");
    if (!file_->write(number_++, utime, channel, span_of(payload))) fail();
  }
  void close() {
    const Use use(*this);
    if (!file_) return;
    const std::unique_ptr<bridges::RecordFile> file = std::move(file_);
    if (!file->finish()) fail();
  }

 private:
  [[noreturn]] void fail() const { throw Error(path_ + ": " + std::strerror(errno != 0 ? errno : EIO)); }

  const std::string path_;
  std::unique_ptr<bridges::RecordFile> file_;
  std::int64_t number_ = 0;
};

}  // namespace

void add_records(py::module_& module) {
  using py::literals::operator""_a;
  py::class_<RecordReader>(module, "RecordReader")
      .def(py::init<const std::string&>(), "path"_a)
      .def("next", &RecordReader::next, "channels"_a)
      .def("missing", &RecordReader::missing, "channels"_a)
      .def_property_readonly("problems", &RecordReader::problems);
  py::class_<RecordWriter>(module, "RecordWriter")
      .def(py::init<const std::string&, bool>(), "path"_a, "overwrite"_a = false)
      .def("write", &RecordWriter::write, "channel"_a, "utime"_a, "payload"_a)
      .def("close", &RecordWriter::close);
}

}  // namespace python
