// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bridges/log/event_log.hpp"
#include "bridges/log/record_file.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/message_objects.hpp"
#include "python/world/error.hpp"

namespace py = pybind11;

namespace python {
namespace {

/// Reader of an LCM event log.
class LogReader {
 public:
  explicit LogReader(const std::string& path) : log_(path) {}

  /// Returns channel, time stamp and payload of the next event on one of these channels; raises StopIteration.
  py::tuple next(const std::vector<std::string>& channels) {
    bridges::LogEventView event;
    while (log_.next(event)) {
      const bool fits =
          channels.empty() || std::find(channels.begin(), channels.end(), event.channel) != channels.end();
      if (fits)
        return py::make_tuple(std::string(event.channel), event.utime,
                              py::bytes(reinterpret_cast<const char*>(event.payload.data()), event.payload.size()));
      if ((++skipped_ & 4095) == 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    throw py::stop_iteration();
  }
  std::vector<std::string> problems() const { return log_.problems(); }
  std::uint64_t bytes() const { return log_.file_bytes(); }

 private:
  bridges::EventLogReader log_;
  std::uint64_t skipped_ = 0;
};

/// Writer of a record: an LCM event log or, by its name, an MCAP file.
class RecordWriter {
 public:
  RecordWriter(const std::string& path, bool overwrite)
      : path_(path),
        file_(bridges::create_record(path, overwrite ? bridges::Existing::overwrite : bridges::Existing::refuse)) {}
  ~RecordWriter() {
    if (file_) file_->finish();
  }

  void write(const std::string& channel, std::int64_t utime, const py::bytes& payload) {
    if (!file_) throw Error(path_ + " is closed");
    if (channel.empty() || channel.size() > 63) throw Error("a channel has 1 to 63 characters, got '" + channel + "'");
    if (!file_->write(number_++, utime, channel, span_of(payload))) fail();
  }
  void close() {
    if (!file_) return;
    const std::unique_ptr<bridges::RecordFile> file = std::move(file_);
    if (!file->finish()) fail();
  }

 private:
  [[noreturn]] void fail() const { throw Error(path_ + " cannot be written"); }

  const std::string path_;
  std::unique_ptr<bridges::RecordFile> file_;
  std::int64_t number_ = 0;
};

}  // namespace

void add_records(py::module_& module) {
  using namespace py::literals;
  py::class_<LogReader>(module, "LogReader")
      .def(py::init<const std::string&>(), "path"_a)
      .def("next", &LogReader::next, "channels"_a = std::vector<std::string>())
      .def_property_readonly("problems", &LogReader::problems)
      .def_property_readonly("bytes", &LogReader::bytes);
  py::class_<RecordWriter>(module, "RecordWriter")
      .def(py::init<const std::string&, bool>(), "path"_a, "overwrite"_a = false)
      .def("write", &RecordWriter::write, "channel"_a, "utime"_a, "payload"_a)
      .def("close", &RecordWriter::close);
}

}  // namespace python
