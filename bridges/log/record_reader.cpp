// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/record_reader.hpp"

#include <optional>
#include <sstream>
#include <utility>

#include "bridges/log/event_log.hpp"
#include "bridges/log/record_file.hpp"
#include "bridges/mcap/mcap_reader.hpp"
#include "bridges/ros2/cdr.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/message_schema.hpp"
#include "sim/config/message_text.hpp"

namespace bridges {
namespace {

class LogReader final : public RecordReader {
 public:
  /// Reads the first event, so that a file that is not a log is refused at once.
  explicit LogReader(const std::string& path) : log_(path), has_first_(log_.next(first_)) {
    if (!has_first_ && log_.file_bytes() > 0)
      throw BusError(path +
                     ": is not an LCM log: it contains no readable event (the name of an MCAP file ends with .mcap)");
  }
  bool next(RecordEvent& event) override {
    LogEventView view = first_;
    if (!std::exchange(has_first_, false) && !log_.next(view)) return false;
    event = {view.channel, view.utime, view.payload};
    return true;
  }
  std::vector<std::string> problems() const override { return log_.problems(); }

 private:
  EventLogReader log_;
  LogEventView first_;
  bool has_first_;  // and it was not given away
};

class McapRecordReader final : public RecordReader {
 public:
  explicit McapRecordReader(const std::string& path) : file_(path) {}
  bool next(RecordEvent& event) override {
    using Item = mcap::McapReader::Item;
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
  bool read(RecordEvent& event) {
    const mcap::Message& message = file_.message();
    const mcap::Channel& channel = file_.channel(message.channel);
    const auto name = channel.metadata.find("lcm_channel"), type = channel.metadata.find("lcm_type");
    if (name == channel.metadata.end()) return false;
    // Records store ns; LCM has us.
    event = {name->second, static_cast<std::int64_t>(message.log_time_ns / 1000), message.data};
    if (channel.encoding == "lcm") return true;
    if (type == channel.metadata.end()) return false;
    const shoal::MessageSchema* const schema = shoal::embedded_types().find(type->second);
    const auto error = schema == nullptr ? std::optional("there is no message type '" + type->second + "'")
                                         : ros2::from_cdr(*schema, message.data, payload_);
    constexpr std::size_t max_bad_messages = 100;
    if (error && problems_.size() < max_bad_messages) problems_.push_back(name->second + ": " + *error);
    event.payload = payload_;
    return !error;
  }

  mcap::McapReader file_;
  std::vector<std::byte> payload_;
  std::vector<std::string> problems_;
};

}  // namespace

std::unique_ptr<RecordReader> open_record(const std::string& path) {
  if (is_mcap_name(path)) return std::make_unique<McapRecordReader>(path);
  return std::make_unique<LogReader>(path);
}

shoal::sim_info_t read_run_info(std::span<const std::byte> payload) {
  auto info = shoal::decode<shoal::sim_info_t>(payload, shoal::Finite::any);
  info.world = sim::printable(info.world);
  std::istringstream lines(info.versions);
  info.versions.clear();
  for (std::string line; std::getline(lines, line);) info.versions += sim::printable(line) + '\n';
  return info;
}

}  // namespace bridges
