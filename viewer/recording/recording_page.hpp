// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "bridges/web/page_files.hpp"
#include "viewer/recording/recording.hpp"

namespace viewer {

/// A page that shows a log in three dimensions, in one file that needs no server and no network.
struct RecordingPage {
  std::string html;
  std::string world;
  double start_s = 0, end_s = 0;
  std::size_t states = 0, states_of_log = 0, dropped_texts = 0;

  /// Returns `4.1 MB, 0 to 900 s, 9001 states (every 0.1 s)`, and what was left out.
  std::string to_text() const;
};

/// Maximum size of a page: e-mail and chat programs take files of this size.
constexpr std::size_t max_recording_page_bytes = 20'000'000;

/// Makes the page of a log.  States are left out until it has at most `max_bytes`, then sounds.  Throws BusError and
/// std::runtime_error: the log cannot be shown, is too large even so, or this build has no page.
RecordingPage make_recording_page(const std::string& log, const std::string& version,
                                  std::size_t max_bytes = max_recording_page_bytes,
                                  const std::function<void(double share)>& progress = {});

/// Returns the live page with a recording in it, as HTML.  All texts from outside are in base64, so that no name can
/// end an element.  `packed`: the bytes of a recording, compressed by gzip.  Throws std::runtime_error.
std::string recording_html(std::span<const bridges::EmbeddedFile> page, std::string_view packed);

}  // namespace viewer
