// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/foxglove/foxglove_message.hpp"
#include "bridges/ros2/topic_table.hpp"

namespace bridges::foxglove {

/// Rights of a client besides reading.
enum class Control {
  none,     ///< nothing
  run,      ///< steer a run: services and parameters
  playback  ///< play a log
};

/// Introduction of the server.
struct ServerInfo {
  std::string name;     ///< shown by viewers
  std::string session;  ///< another one for another run
  std::vector<std::pair<std::string, std::string>> metadata;
  Control control = Control::none;
  std::int64_t start_us = 0, end_us = 0;  ///< UTC of the first and last message of a log, us since 1970
};

/// State of the playback or run, as clients see it.
struct PlaybackState {
  enum class Status : std::uint8_t { playing = 0, paused = 1, buffering = 2, ended = 3 };
  Status status = Status::playing;
  std::int64_t now_us = 0;  ///< UTC that is shown, us since 1970
  double speed = 1;         ///< 0: as fast as possible
  bool operator==(const PlaybackState&) const = default;
};

enum class StatusLevel { info = 0, warning = 1, error = 2 };

/// Return text messages of the server.
std::string server_info_text(const ServerInfo& info);
/// `id`: of a status that later ones replace; empty: none.
std::string status_text(StatusLevel level, std::string_view message, std::string_view id = "");
std::string advertise_text(std::span<const ros2::Topic* const> topics);
std::string advertise_services_text();
std::string service_failure_text(std::uint32_t service, std::uint32_t call, std::string_view message);
/// `names`: those that the client asked for; empty: all.  `id`: of the request, if there is one.
std::string parameters_text(const PlaybackState& state, const std::vector<std::string>& names,
                            const std::optional<std::string>& id);

/// Return binary messages of the server.  Times before 1970 are 0.
std::string message_data(std::uint32_t subscription, std::int64_t utime, std::string_view payload);
std::string time_data(std::int64_t utime);
std::string service_response_data(std::uint32_t service, std::uint32_t call, std::string_view encoding,
                                  std::string_view payload);
std::string playback_data(const PlaybackState& state, bool did_seek, std::string_view request_id);

}  // namespace bridges::foxglove
