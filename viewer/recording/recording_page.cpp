// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/recording/recording_page.hpp"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bridges/base/base64.hpp"
#include "bridges/base/json_text.hpp"

namespace viewer {

namespace {

/// No request leaves the page, not even to its folder.
constexpr std::string_view policy =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline' blob:; "
    "style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action 'none'\">\n";
constexpr std::string_view script_of_page = "<script type=\"module\" src=\"main.js\"></script>";
constexpr std::string_view link_of_style = "<link rel=\"stylesheet\" href=\"";
constexpr std::string_view loader_name = "recording_loader.js";

std::string_view bytes_of(const bridges::EmbeddedFile& file) {
  return {reinterpret_cast<const char*>(file.begin), static_cast<std::size_t>(file.end - file.begin)};
}

std::string_view file_of(std::span<const bridges::EmbeddedFile> page, std::string_view path) {
  for (const bridges::EmbeddedFile& file : page)
    if (file.path == path) return bytes_of(file);
  throw std::runtime_error("the page in this build of Shoal has no file '" + std::string(path) + "'");
}

/// Returns the text of an element; throws if it would end the element.
std::string_view content(std::string_view text, std::string_view element, std::string_view path) {
  if (text.find("</" + std::string(element)) != std::string_view::npos)
    throw std::runtime_error("file '" + std::string(path) + "' of the page must not contain '</" +
                             std::string(element) + "'");
  return text;
}

/// Replaces links to style sheets by the style sheets.
std::string with_styles(std::string html, std::span<const bridges::EmbeddedFile> page) {
  for (std::size_t at = html.find(link_of_style); at != std::string::npos; at = html.find(link_of_style, at)) {
    const std::size_t name_at = at + link_of_style.size(), name_end = html.find('"', name_at),
                      end = html.find('>', name_at);
    if (name_end == std::string::npos || end == std::string::npos)
      throw std::runtime_error("index.html of the page: a link to a style sheet does not end");
    const std::string path = html.substr(name_at, name_end - name_at);
    const std::string style = "<style>\n" + std::string(content(file_of(page, path), "style", path)) + "</style>";
    html.replace(at, end + 1 - at, style);
    at += style.size();
  }
  return html;
}

/// Returns the modules of the page as JSON: text by path.
std::string modules_of(std::span<const bridges::EmbeddedFile> page) {
  nlohmann::json modules = nlohmann::json::object();
  for (const bridges::EmbeddedFile& file : page)
    if (std::string_view(file.path).ends_with(".js") && file.path != loader_name)
      modules[file.path] = std::string(bytes_of(file));
  return bridges::json_text(modules);
}

std::string data_element(std::string_view id, std::string_view packed) {
  return "<script type=\"text/plain\" id=\"" + std::string(id) + "\">" + bridges::base64(packed) + "</script>\n";
}

}  // namespace

std::string recording_html(std::span<const bridges::EmbeddedFile> page, std::string_view packed) {
  if (page.empty()) throw std::runtime_error("this build of Shoal does not contain the live page");
  std::string html = with_styles(std::string(file_of(page, "index.html")), page);
  const auto replace = [&html](std::string_view what, const std::string& by) {
    const std::size_t at = html.find(what);
    if (at == std::string::npos) throw std::runtime_error("index.html of the page has no '" + std::string(what) + "'");
    html.replace(at, what.size(), by);
  };
  // The loader below replaces the script: modules cannot be imported from a file opened without a server.
  replace(script_of_page, "");
  replace("<meta charset=\"utf-8\">\n", "<meta charset=\"utf-8\">\n" + std::string(policy));
  replace("</body>", data_element("modules", bridges::gzip(modules_of(page))) + data_element("recording", packed) +
                         "<script>\n" + std::string(content(file_of(page, loader_name), "script", loader_name)) +
                         "</script>\n</body>");
  return html;
}

std::string RecordingPage::to_text() const {
  std::string text =
      fmt::format("{:.1f} MB, {:.6g} to {:.6g} s", static_cast<double>(html.size()) / 1e6, start_s, end_s);
  if (states > 1)
    text += fmt::format(", {} states (every {:.3g} s)", states, (end_s - start_s) / static_cast<double>(states - 1));
  if (states < states_of_log) text += fmt::format(" of the {} of the record", states_of_log);
  if (dropped_texts > 0) text += fmt::format(", without {} messages of sound and estimates", dropped_texts);
  return text;
}

RecordingPage make_recording_page(const std::string& log, const std::string& version, std::size_t max_bytes,
                                  const std::function<void(double share)>& progress) {
  Recording recording(log, version, {}, progress);
  RecordingPage page;
  for (;;) {
    page.html = recording_html(bridges::embedded_page(), bridges::gzip(recording.to_bytes()));
    if (page.html.size() <= max_bytes) break;
    // Down to a state in ten seconds, then without sounds, then with what is left.
    constexpr double coarse_s = 10;
    const double interval_s =
        static_cast<double>(recording.end_us() - recording.start_us()) / 1e6 / static_cast<double>(recording.states());
    if (interval_s < coarse_s && recording.thin()) continue;
    if (recording.drop_sounds() || recording.thin()) continue;
    throw std::runtime_error(fmt::format("{}: scene and meshes alone make a page of {:.1f} MB, the limit is {:.1f} MB",
                                         log, static_cast<double>(page.html.size()) / 1e6,
                                         static_cast<double>(max_bytes) / 1e6));
  }
  page.world = recording.world();
  page.start_s = static_cast<double>(recording.start_us()) / 1e6;
  page.end_s = static_cast<double>(recording.end_us()) / 1e6;
  page.states = recording.states();
  page.states_of_log = recording.states_of_log();
  page.dropped_texts = recording.dropped_texts();
  return page;
}

}  // namespace viewer
