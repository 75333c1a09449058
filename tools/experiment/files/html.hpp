// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tools {

/// Text as HTML text or as an attribute in double quotes.  Any bytes stay text: markup is written as entities;
/// control characters and invalid UTF-8 become U+FFFD.
std::string html_text(std::string_view text);

std::string base64(std::string_view bytes);

/// A table of texts (not HTML yet); columns after the first are right-aligned.
std::string html_table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows);

/// What is folded away until one asks for it; `body` is HTML.
std::string html_details(const std::string& summary, const std::string& body);

/// A page that needs nothing but itself: `body` is HTML.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace tools
