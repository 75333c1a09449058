// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace experiment {

/// Escapes text for HTML or for an attribute in double quotes.  Markup is written as entities; control characters and
/// invalid UTF-8 become U+FFFD.
std::string html_text(std::string_view text);

/// Returns a table of plain texts; columns after the first are right-aligned.
std::string html_table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows);

/// Returns a section that is collapsed until it is clicked; `body` is HTML.
std::string html_details(const std::string& summary, const std::string& body);

/// Returns a self-contained page: `body` is HTML.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace experiment
