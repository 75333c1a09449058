// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/page_session.hpp"

#include "bridges/base/json_text.hpp"

namespace viewer {

bridges::WebOptions web_options(const experiment::ViewOptions& options) {
  bridges::WebOptions web;
  web.host = options.host;
  web.port = options.port;
  web.port_tries = options.port_tries;
  web.origins = options.origins;
  web.token = options.token;
  web.page_directory = options.page_directory;
  return web;
}

nlohmann::json hello_json(const std::string& version, const char* source, const std::string& world,
                          std::int64_t epoch_us) {
  return {{"op", "hello"},  {"version", 1},         {"shoal", version}, {"source", source},
          {"world", world}, {"epoch_us", epoch_us}, {"start_us", 0},    {"end_us", nullptr}};
}

PageSession::PageSession(const experiment::ViewOptions& options, Source source)
    : server(web_options(options)),
      messages(server,
               source == Source::world ? ViewMessages::Frames::from_elsewhere : ViewMessages::Frames::from_bodies),
      traffic(server, source == Source::world ? MessageFeed::Past::kept : MessageFeed::Past::forgotten),
      foxglove(server) {
  if (options.rosbridge || options.rosbridge_control) rosbridge.emplace(server, options.rosbridge_control);
}

}  // namespace viewer
