// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/waiting_page.hpp"

#include "bridges/base/json_text.hpp"

namespace viewer {

WaitingPage::WaitingPage(const experiment::ViewOptions& options, const std::string& version, const std::string& world,
                         const std::string& problem)
    : server_(web_options(options)) {
  nlohmann::json hello = hello_json(version, "run", world, 0);
  hello["problem"] = problem;
  server_.retain("hello", bridges::json_text(hello));
}

void WaitingPage::serve() {
  while (const auto request = server_.take_request())
    if (request->op == "control" || request->op == "drive") refuse(server_, *request, "there is no run");
}

}  // namespace viewer
