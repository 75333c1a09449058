// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/mcap/mcap_writer.hpp"
#include "bridges/ros2/topic_table.hpp"
#include "shoal/message_schema.hpp"

namespace bridges::mcap {

/// Last time that messages of ROS 2 can hold, 2038-01-19T03:14:07Z; the first one is 1970, us.
inline constexpr std::int64_t max_utime = 2'147'483'647'999'999;
/// Returns why a record cannot have a time; empty: it can.
std::string time_error(std::int64_t utime);

/// MCAP file of the messages of a run, for Foxglove and the tools of ROS 2.  Each LCM channel becomes a topic with all
/// its messages in CDR, and further topics with those that a standard type of ROS 2 can express.  Payloads of unknown
/// types, and invalid ones, are kept as they are.
class McapRecord final : private ros2::TopicSink {
 public:
  /// `types` must outlive this.
  McapRecord(FileDescriptor file, const shoal::MessageTypes& types = shoal::embedded_types());

  /// Writes a message with its simulated time.  Returns false after a failed write, and for a time of which
  /// time_error() says why; errno has the reason.
  bool write(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload);
  /// Takes a message that is not written, for what it tells about others: the devices and the world.
  void learn(std::string_view channel, std::span<const std::byte> payload);
  /// Continues with another file, which starts with the first `messages` messages of this record; `path`: its file.
  /// Returns null when the file cannot be read or written.
  std::unique_ptr<McapRecord> branch(const std::string& path, std::uint64_t messages, FileDescriptor file);

  bool flush() { return file_.flush(); }
  bool finish() { return file_.finish(); }
  const McapWriter& file() const { return file_; }
  /// Returns the messages of unknown types, and the invalid ones.
  std::uint64_t not_decoded() const { return not_decoded_; }
  /// Returns the first problems, such as an invalid message.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  bool take(const ros2::Topic& topic, std::span<const std::byte> bytes) override;
  void invalid(std::string_view channel, const std::string& error) override;
  /// Returns the number of the channel of a topic; 0 when there are too many.
  std::uint16_t channel_of(const ros2::Topic& topic);
  bool write_info(std::span<const std::byte> payload);
  void report(const std::string& problem);

  const shoal::MessageTypes& types_;
  McapWriter file_;
  ros2::TopicTable topics_;
  std::vector<std::uint16_t> channels_;  // by the number of the topic; 0: none until now
  std::uint64_t time_ns_ = 0;            // of the present message
  std::optional<std::int32_t> branch_;   // of the last sim.info
  std::uint64_t not_decoded_ = 0;
  std::vector<std::string> problems_;
};

}  // namespace bridges::mcap
