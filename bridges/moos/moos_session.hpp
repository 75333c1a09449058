// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bridges/moos/moos_message.hpp"

namespace bridges {

/// Variable of MOOS with its value.
struct MoosValue {
  std::string key;
  std::variant<double, std::string> value;
};

/// What a client of a MOOSDB is.
struct MoosClientTerms {
  std::string name;                    ///< of the client; a MOOSDB accepts each name once
  std::vector<std::string> variables;  ///< it subscribes to; `*` for all of any client
  double time_warp = 1;                ///< as MOOSTimeWarp of the community: stamps are wall time times this
};

/// One connection of an asynchronous client with a MOOSDB, without its socket and its clock: bytes and wall time in,
/// bytes and messages out.  It greets, waits for the welcome, subscribes, and keeps the connection alive: a MOOSDB
/// drops a client that is silent for 5 s, and a MOOSDB that is silent for 5 s is taken for dead.
class MoosSession {
 public:
  static constexpr double silence_limit_s = 5, timing_period_s = 1;
  /// Values that wait for a MOOSDB that does not read: further ones are dropped, and counted.
  static constexpr std::size_t max_waiting_bytes = 4 << 20;

  /// `wall_s`: since 1970, as of all functions.
  MoosSession(MoosClientTerms terms, double wall_s);

  /// Takes bytes of the MOOSDB.  Throws MoosError when they have no meaning, or when it refuses the client.
  void receive(std::span<const std::byte> bytes, double wall_s);
  /// Sends the values of variables; before the welcome they are dropped.
  void notify(std::span<const MoosValue> values, double wall_s);
  /// Sends a timing message when one is due.  Call it at least once a second.  Throws MoosError when the MOOSDB is
  /// silent.
  void keep_alive(double wall_s);

  /// Returns the messages that came for the variables since the last call.
  std::vector<MoosMessage> take_received() { return std::exchange(inbox_, {}); }
  /// Bytes for the MOOSDB; sent() removes those that the socket took.
  std::span<const std::byte> output() const { return output_; }
  void sent(std::size_t bytes);
  bool is_open() const { return open_; }
  /// Name of the community, by the welcome.
  const std::string& community() const { return community_; }
  std::uint64_t dropped() const { return dropped_; }

 private:
  void send(std::span<const MoosMessage> messages);
  void subscribe(double wall_s);
  MoosMessage message_of(MoosType type, const std::string& key, double wall_s);

  const MoosClientTerms terms_;
  MoosPacketReader reader_;
  std::vector<std::byte> output_;
  std::vector<MoosMessage> inbox_;
  std::string community_;
  double heard_s_, timing_s_;
  std::int32_t next_id_ = 0;
  bool open_ = false;
  std::uint64_t dropped_ = 0;
};

}  // namespace bridges
