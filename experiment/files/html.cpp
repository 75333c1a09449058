// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/html.hpp"

#include <algorithm>
#include <cstdint>

#include "sim/config/utf8.hpp"

namespace experiment {

namespace {

constexpr const char* style = R"(
:root { color-scheme: light dark; --back: #ffffff; --text: #1c2530; --soft: #56626e; --line: #d5dbe1; --band: #f3f6f9;
  --good: #176f3a; --bad: #b3261e; --open: #8a5a00; }
@media (prefers-color-scheme: dark) {
  :root { --back: #14191f; --text: #e4e9ee; --soft: #9aa7b4; --line: #333d47; --band: #1d242c;
    --good: #6cc48c; --bad: #f28b82; --open: #e0b04c; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--back); color: var(--text); font: 16px/1.5 system-ui, sans-serif; }
main { max-width: 60rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: .5rem 0; overflow-wrap: anywhere; }
h2 { font-size: 1.2rem; margin: 2rem 0 .5rem; }
h3 { font-size: 1rem; margin: 1.5rem 0 .25rem; overflow-wrap: anywhere; }
p, li, summary { overflow-wrap: anywhere; }
.soft { color: var(--soft); }
.small { font-size: .875rem; font-weight: 400; }
.good { color: var(--good); font-weight: 600; }
.bad { color: var(--bad); font-weight: 600; }
.open { color: var(--open); font-weight: 600; }
.verdict { background: var(--band); border-left: .375rem solid var(--open); border-radius: .25rem;
  padding: .75rem 1rem; margin: 1rem 0; }
.verdict.is-good { border-color: var(--good); }
.verdict.is-bad { border-color: var(--bad); }
.verdict p, .verdict ul { margin: .25rem 0; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .75rem .25rem 0; text-align: right; vertical-align: top; border-bottom: 1px solid var(--line);
  white-space: nowrap; }
th:first-child, td:first-child { text-align: left; white-space: normal; overflow-wrap: anywhere; min-width: 8rem; }
tbody th { font-weight: 400; }
table.figures { width: 100%; }
table.figures td { padding-right: 0; }
table.facts td { text-align: left; white-space: normal; overflow-wrap: anywhere; }
details { margin: .5rem 0; }
summary { cursor: pointer; color: var(--soft); }
ul.rules { list-style: none; padding: 0; }
figure { margin: 1rem 0; }
figure img { max-width: 100%; height: auto; background: #ffffff; border-radius: .25rem; }
figcaption { color: var(--soft); font-size: .875rem; }
pre { background: var(--band); padding: .75rem; overflow-x: auto; font-size: .85rem; }
@media print {
  :root { color-scheme: light; --back: #ffffff; --text: #000000; --soft: #444444; --line: #bbbbbb; --band: #f3f3f3;
    --good: #176f3a; --bad: #b3261e; --open: #8a5a00; }
  body { font-size: 11pt; }
  main { max-width: none; padding: 0; }
  figure, tr, .verdict { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  figure img { max-height: 20cm; }
  pre { white-space: pre-wrap; overflow-wrap: anywhere; }
  details::details-content { content-visibility: visible; block-size: auto; }
}
)";

std::string row_of(const std::vector<std::string>& cells, const char* tag) {
  std::string text = "<tr>";
  for (const std::string& cell : cells)
    text += "<" + std::string(tag) + ">" + html_text(cell) + "</" + std::string(tag) + ">";
  return text + "</tr>\n";
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = sim::utf8_length(text);
    const char c = text.front();
    // Replace control characters and invalid bytes, escape markup.
    const bool control = length == 1 && ((c >= 0 && c < 0x20 && c != '\n' && c != '\t') || c == 0x7f);
    if (length == 0 || control)
      out += "\xef\xbf\xbd";
    else if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else
      out += text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

std::string html_table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
  std::string text = "<div class=\"wide\"><table>\n<thead>" + row_of(head, "th") + "</thead>\n<tbody>\n";
  for (const auto& row : rows) text += row_of(row, "td");
  return text + "</tbody></table></div>\n";
}

std::string html_details(const std::string& summary, const std::string& body) {
  return "<details><summary>" + html_text(summary) + "</summary>\n" + body + "</details>\n";
}

std::string html_page(const std::string& title, const std::string& body) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         html_text(title) + "</title>\n<style>" + style + "</style>\n</head>\n<body>\n<main>\n" + body +
         "</main>\n</body>\n</html>\n";
}

}  // namespace experiment
