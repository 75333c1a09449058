// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/waiting_page.hpp"

#include "viewer/page_data/view_json.hpp"

namespace viewer {

using Json = nlohmann::json;

WaitingPage::WaitingPage(const experiment::ViewOptions& options, const std::string& version, const std::string& world,
                         const std::string& problem)
    : server_(web_options(options)) {
  server_.retain("hello", json_text({{"op", "hello"},
                                     {"version", 1},
                                     {"shoal", version},
                                     {"source", "run"},
                                     {"world", world},
                                     {"epoch_us", 0},
                                     {"start_us", 0},
                                     {"end_us", nullptr},
                                     {"problem", problem}}));
}

void WaitingPage::serve() {
  while (const auto request = server_.take_request()) {
    if (request->op != "control" && request->op != "drive") continue;
    const Json message = Json::parse(request->text, nullptr, false);
    server_.reply(request->client, json_text({{"op", "reply"},
                                              {"id", message.is_object() ? message.value("id", Json()) : Json()},
                                              {"ok", false},
                                              {"text", "there is no run"}}));
  }
}

}  // namespace viewer
