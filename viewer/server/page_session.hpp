// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bridges/web/web_server.hpp"
#include "experiment/run/run_page.hpp"
#include "viewer/server/foxglove_view.hpp"
#include "viewer/server/page_traffic.hpp"
#include "viewer/server/rosbridge_view.hpp"
#include "viewer/server/view_messages.hpp"

namespace viewer {

/// Returns the settings of the server.
bridges::WebOptions web_options(const experiment::ViewOptions& options);

/// Returns the text `hello` of the page protocol, without an end; `source`: `run`, `log` or `bus`.
nlohmann::json hello_json(const std::string& version, const char* source, const std::string& world,
                          std::int64_t epoch_us);

/// Server of a live page, and what passes messages on to its clients: the parts that the pages of a run (RunView), a
/// log (LogView) and a bus (BusView) have in common.  Each of them adds where the messages come from, and what requests
/// do.
struct PageSession {
  /// Where poses and the past come from.
  enum class Source {
    world,     ///< a world in this process: the server keeps the past
    messages,  ///< messages of another process or of a log
  };
  /// Starts the server.  Throws bridges::WebError.
  PageSession(const experiment::ViewOptions& options, Source source);

  /// Sends what is due of the messages themselves, at a simulated time.
  void flush_traffic(std::int64_t time_us) { traffic.flush(time_us, messages.scene(), messages.scene_number()); }

  /// Passes a message on to the clients of other protocols, published at this UTC, with the next flush().
  void pass_on(std::int64_t utime, std::string_view channel, std::span<const std::byte> payload) {
    foxglove.message(utime, channel, payload);
    if (rosbridge) rosbridge->message(utime, channel, payload);
  }
  void flush() {
    foxglove.flush();
    if (rosbridge) rosbridge->flush();
  }

  bridges::WebServer server;
  ViewMessages messages;
  PageTraffic traffic;
  FoxgloveView foxglove;
  std::optional<RosbridgeView> rosbridge;  ///< none: it is not served
};

}  // namespace viewer
