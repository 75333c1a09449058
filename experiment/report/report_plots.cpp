// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>

#include "bridges/base/base64.hpp"
#include "experiment/files/html.hpp"
#include "experiment/report/report_page.hpp"
#include "experiment/results/run_plots.hpp"
#include "sim/base/crc32.hpp"
#include "sim/base/log.hpp"

namespace experiment {
namespace {

namespace fs = std::filesystem;

std::string note(const std::string& text) {
  return "<p class=\"soft\">" + html_text(text) + "</p>\n";
}

const std::map<std::string, std::string>& captions_of_run() {
  static const std::map<std::string, std::string> captions{
      {"tracks.png",
       "Tracks from above: true positions broad and pale, estimates thin and dashed, outlines of objects grey."},
      {"errors.png", "Distance between estimate and truth over time; dashed: three times the estimate's own sigma."},
      {"errors_by_distance.png", "The same errors over the distance traveled."},
      {"nees.png",
       "Normalized estimation error squared over time, with its mean and 95 % bound for a consistent estimate."}};
  return captions;
}

std::vector<std::string> plots_of(const RunRecord& run) {
  std::error_code error;
  std::vector<std::string> files;
  const bool plotted = fs::exists(run.directory + "/plot.gp", error);  // otherwise plots were not requested
  if (plotted) files.emplace_back("tracks.png");
  const bool compared = std::any_of(run.metrics.begin(), run.metrics.end(), [](const auto& figure) {
    return figure.first.ends_with(".samples") && figure.second.value_or(0) > 0;
  });
  if (plotted && compared) files.emplace_back("errors.png");
  for (const char* file : run_plots)
    if (fs::exists(run.directory + "/" + file, error) && std::find(files.begin(), files.end(), file) == files.end())
      files.emplace_back(file);
  return files;
}

}  // namespace

std::string plots_html(const std::string& directory, const std::vector<std::string>& files,
                       const std::map<std::string, std::string>& captions) {
  std::string html;
  for (const std::string& file : files) {
    std::string bytes;
    try {
      bytes = read_whole_file(directory + "/" + file);
    } catch (const std::runtime_error&) {
      html += note(file + " is missing.");
      continue;
    }
    // A run that was killed may leave an incomplete plot, which some browsers show as broken.
    if (!is_whole_png(bytes)) {
      sim::log_warn("{}/{}: is not a complete PNG file; the page omits it", directory, file);
      html += note(file + " is not a complete PNG file.");
      continue;
    }
    const auto caption = captions.find(file);
    const std::string text = html_text(caption == captions.end() ? file : caption->second);
    html += "<figure><img alt=\"" + text + "\" src=\"data:image/png;base64," + bridges::base64(bytes) +
            "\"><figcaption>" + text + "</figcaption></figure>\n";
  }
  return html;
}

std::string run_plots_html(const RunRecord& run) {
  return plots_html(run.directory, plots_of(run), captions_of_run());
}

namespace {

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

}  // namespace

// Portable Network Graphics (W3C), section 5: chunks of length, type, data and CRC-32 of type and data.
bool is_whole_png(std::string_view bytes) {
  constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
  constexpr std::size_t around = 12;  // bytes of a chunk in addition to its data
  if (!bytes.starts_with(signature)) return false;
  bool first = true;
  for (std::size_t at = signature.size(); bytes.size() - at >= around; first = false) {
    const std::size_t length = number_at(bytes, at);
    if (length > bytes.size() - at - around) return false;
    const std::string_view body = bytes.substr(at + 4, 4 + length);
    if (sim::crc32(std::as_bytes(std::span(body))) != number_at(bytes, at + 8 + length)) return false;
    if (first && !body.starts_with("IHDR")) return false;
    at += around + length;
    if (body.starts_with("IEND")) return at == bytes.size();
  }
  return false;
}

}  // namespace experiment
