// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bridges::ros2 {

/// Message `shoal_interfaces/msg/Tick`: a tick of the lockstep, or the answer of a node to it.
struct Tick {
  static constexpr const char* type = "shoal_interfaces/msg/Tick";
  static constexpr std::string_view definition = R"(# A tick of the lockstep, and the answer of a node to it.
builtin_interfaces/Time stamp  # simulated time
int64 step                     # of the simulation
int32 branch                   # increases with each rewind of the world
bool last                      # the run ends with this step, and waits for no answer
string node                    # of an answer: its sender
# Topics, and how many messages there were on each since the previous tick, or answer.
string[] topics
uint32[] counts
# Of a tick: how many messages of each topic, of this tick and earlier ones, a node receives that subscribes now.
uint32[] kept
)";
  /// As `ros2msg` text, with the type of the stamp.
  static std::string schema();

  std::int64_t utime = 0;
  std::int64_t step = 0;
  std::int32_t branch = 0;
  bool last = false;
  std::string node;
  std::map<std::string, std::uint32_t> counts;  ///< messages by topic
  std::map<std::string, std::uint32_t> kept;    ///< of a tick, by topic
};

std::vector<std::byte> encode(const Tick& tick);
/// Throws shoal::MessageError for bytes that are not of the type.
Tick decode_tick(std::span<const std::byte> cdr);

/// What the door and nodes of ROS 2 exchange in a tick of the lockstep.  DDS orders the messages of a topic, but not
/// those of two: tick and answers therefore name how many messages belong to them on each topic, and the commands of a
/// tick enter the world by the names of their topics.
class TickExchange {
 public:
  struct Command {
    std::string channel;
    std::vector<std::byte> payload;
  };

  /// Most commands of a tick; further ones are lost.
  static constexpr std::size_t max_commands = 9000;

  /// `nodes`: those whose answers a tick needs.
  explicit TickExchange(std::vector<std::string> nodes) : nodes_(std::move(nodes)) {}

  /// Counts a message that was published on a topic, for the next tick.  `depth`: of the history of the topic.
  void count(const std::string& topic, std::uint32_t depth);
  /// Begins a tick, and returns it with the messages since the previous one.
  const Tick& begin(std::int64_t utime, std::int64_t step, std::int32_t branch, bool last);
  /// Takes a command; none: it was refused, and is only counted.  Returns false if there is no room for it.
  bool add(const std::string& topic, std::optional<Command> command);
  /// Takes an answer.  One of a node that is not awaited, or to another tick, is ignored.
  void take(const Tick& answer);
  /// Returns what the tick lacks, `the answer of 'pilot'` or `a message on /rover1/cmd_vel`; empty: nothing.
  std::string missing() const;
  /// Ends a tick: returns its commands in the order of their topics, of one topic as they came.
  std::vector<Command> finish();
  /// Returns the first topic of this tick that two nodes name: DDS does not order their commands.
  const std::string& contested() const { return contested_; }

 private:
  std::vector<std::string> nodes_;
  std::map<std::string, std::uint32_t> counts_, kept_;
  Tick tick_;
  std::map<std::string, Tick> answers_;                                  // by node
  std::map<std::string, std::vector<std::optional<Command>>> commands_;  // by topic
  std::size_t held_ = 0;                                                 // commands since the previous tick
  std::string contested_;
};

}  // namespace bridges::ros2
