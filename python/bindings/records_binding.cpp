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

#include "bridges/log/record_file.hpp"
#include "bridges/log/record_reader.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/in_use.hpp"
#include "python/bindings/message_objects.hpp"
#include "python/world/error.hpp"
#include "sim/bus/bus.hpp"
#include "sim/config/message_text.hpp"

namespace py = pybind11;

namespace python {
namespace {

/// Reader of a record.
class RecordReader : public Guarded {
 public:
  explicit RecordReader(const std::string& path) : Guarded("the record"), source_(bridges::open_record(path)) {}

  /// Returns channel, time stamp and payload of the next event on one of these channels; none at the end.
  std::optional<py::tuple> next(const std::vector<std::string>& channels) {
    const Use use(*this);
    bridges::RecordEvent event;
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
  const std::unique_ptr<bridges::RecordReader> source_;
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
