// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bridges/base/bus_error.hpp"
#include "bridges/dds/dds_network.hpp"

struct ddsi_sertype;

namespace bridges {

/// Quality of service of a writer or reader, reliable, with the defaults of ROS 2.
struct DdsQos {
  int depth = 10;         ///< messages that are kept for each reader, or of each writer
  bool latched = false;   ///< transient local: a later reader gets the last `depth` messages
  std::string user_data;  ///< of the endpoint, such as `typehash=RIHS01_...;`
};

/// Participant of a domain of DDS whose messages stay encoded.  wait(), take() and stop() may be called while another
/// thread calls the others.
class DdsParticipant {
 public:
  using Endpoint = std::int32_t;
  using Guid = std::array<std::uint8_t, 16>;

  /// Throws BusError.
  DdsParticipant(const DdsNetwork& network, const std::string& user_data);
  ~DdsParticipant();
  DdsParticipant(const DdsParticipant&) = delete;
  DdsParticipant& operator=(const DdsParticipant&) = delete;

  /// Adds an endpoint of a topic, with the names of DDS: `rt/clock`, `rosgraph_msgs::msg::dds_::Clock_`.  Throws
  /// BusError.
  Endpoint add_writer(const std::string& topic, const std::string& type, const DdsQos& qos);
  Endpoint add_reader(const std::string& topic, const std::string& type, const DdsQos& qos);
  void remove(Endpoint endpoint);

  /// Return the number of endpoints on the other side that are known.
  std::size_t readers_of(Endpoint writer) const;
  std::size_t writers_to(Endpoint reader) const;
  bool has_readers(Endpoint writer) const { return readers_of(writer) > 0; }
  /// Writes a message, which begins with the four bytes of its representation; waits at most 0.1 s for slow readers.
  /// Returns false when DDS refused it.
  bool write(Endpoint writer, std::span<const std::byte> bytes);
  /// Waits, at most 1 s, until the readers have what was written.
  void flush(Endpoint writer) const;
  /// Waits for messages, and returns the readers that may have some; nothing after stop().
  std::optional<std::vector<Endpoint>> wait();
  /// Returns the next message of a reader, padded with at most three bytes.
  std::optional<std::vector<std::byte>> take(Endpoint reader);
  /// Ends wait(), permanently.
  void stop();

  Guid guid() const { return guid_of(participant_); }
  Guid guid_of(Endpoint endpoint) const;

 private:
  /// Topic of an endpoint, and what belongs to it.
  struct Part {
    std::int32_t topic = 0, condition = 0;
    const ddsi_sertype* type = nullptr;
  };
  Part make_topic(const std::string& topic, const std::string& type);

  std::int32_t domain_ = 0, participant_ = 0, waitset_ = 0, stop_ = 0;
  std::map<Endpoint, Part> parts_;
};

}  // namespace bridges
