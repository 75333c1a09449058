// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viewer/server/page_session.hpp"

namespace viewer {

/// Page without a run, which shows why there is none.
class WaitingPage {
 public:
  /// `problem` may have several lines.  Throws bridges::WebError.
  WaitingPage(const experiment::ViewOptions& options, const std::string& version, const std::string& world,
              const std::string& problem);

  std::string url() const { return server_.url(); }
  /// Refuses the requests of the pages.
  void serve();

 private:
  bridges::WebServer server_;
};

}  // namespace viewer
