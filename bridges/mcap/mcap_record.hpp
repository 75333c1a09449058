// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/mcap/mcap_writer.hpp"
#include "bridges/ros2/converter.hpp"
#include "shoal/message_schema.hpp"

namespace bridges::mcap {

/// MCAP file of the messages of a run, for Foxglove and the tools of ROS 2.  Each LCM channel becomes a topic with all
/// its messages in CDR, and further topics with those that a standard type of ROS 2 can express.  Payloads of unknown
/// types, and invalid ones, are kept as they are.
class McapRecord {
 public:
  /// `types` must outlive this.
  McapRecord(FileDescriptor file, const shoal::MessageTypes& types = shoal::embedded_types());

  /// Writes a message with its simulated time.  Returns false after a failed write; errno has the reason.
  bool write(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload);
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
  /// The topics of an LCM channel for one type.
  struct Route {
    struct Standard {
      const ros2::Converter* converter = nullptr;
      std::uint16_t channel = 0;  ///< 0: not needed until now
    };
    const shoal::MessageSchema* schema = nullptr;
    std::uint16_t channel = 0;
    std::vector<Standard> standard;
  };

  /// Returns the route of a valid message; null when there are too many channels.
  Route* route_of(std::string_view channel, const shoal::MessageSchema& schema);
  bool write_standard(Route& route, std::string_view channel, std::uint64_t time_ns,
                      std::span<const std::byte> payload);
  bool write_raw(std::string_view channel, std::uint64_t time_ns, std::span<const std::byte> payload);
  bool write_info(std::uint64_t time_ns, std::span<const std::byte> payload);
  /// Returns a topic that no other owner has: the proposed one, or one with a number.
  std::string own_topic(const std::string& topic, const std::string& owner);
  std::uint16_t standard_channel(const ros2::Converter& converter, std::string_view channel);
  void report(const std::string& problem);

  const shoal::MessageTypes& types_;
  McapWriter file_;
  std::map<std::string, std::map<std::uint64_t, Route>, std::less<>> routes_;  // by channel and fingerprint
  std::map<std::string, std::uint16_t, std::less<>> raw_channels_;
  std::map<std::string, std::uint16_t> common_channels_;  // topics that several LCM channels share, such as /tf
  std::map<std::string, std::string> topic_owners_;       // LCM channel and type of each topic
  ros2::ConverterContext context_;
  std::optional<std::int32_t> branch_;  // of the last sim.info
  std::uint64_t not_decoded_ = 0;
  std::vector<std::string> problems_;
  std::vector<std::byte> cdr_;
};

}  // namespace bridges::mcap
