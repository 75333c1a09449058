// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "experiment/files/html.hpp"
#include "experiment/report/chart_axis.hpp"
#include "experiment/report/report_page.hpp"

namespace experiment {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Value with its 95 % interval; NaN where there is none.
struct Estimated {
  double value = nan, low = nan, high = nan;

  std::string text() const {
    if (!std::isfinite(value)) return "-";
    if (!std::isfinite(low) || !std::isfinite(high)) return fmt::format("{:.3g}", value);
    return fmt::format("{:.3g} [{:.3g}, {:.3g}]", value, low, high);
  }
};

Estimated estimated(const JsonReader& in, const char* key, const char* interval) {
  const auto& ends = in.list(interval);
  if (ends.size() != 2)
    throw std::runtime_error(in.where() + ": '" + interval + "' must be two numbers, got " + shown_json(ends));
  return {number_or_nan(in.at(key)), number_or_nan(ends[0]), number_or_nan(ends[1])};
}

struct Cell {
  std::string world, algorithm, covariance;
  std::int64_t runs = 0, planned = 0;
  Estimated rms, nees, efficiency;
  double inside = nan, bytes_per_h = nan, us_per_event = nan;
};

std::vector<Cell> cells_of(const JsonReader& in) {
  std::vector<Cell> cells;
  for (const auto& item : in.list("cells")) {
    const JsonReader of_cell(item, in.where() + ": cells");
    cells.push_back({of_cell.text("world"), of_cell.text("algorithm"), of_cell.text("covariance"),
                     of_cell.whole("runs"), of_cell.whole("planned"), estimated(of_cell, "rms_m", "rms_95"),
                     estimated(of_cell, "nees", "nees_95"), estimated(of_cell, "efficiency", "efficiency_95"),
                     number_or_nan(of_cell.at("inside_95_share")), number_or_nan(of_cell.at("bytes_per_h")),
                     number_or_nan(of_cell.at("us_per_event"))});
  }
  return cells;
}

/// Returns the values of a member in the order in which they come first.
std::vector<std::string> distinct(const std::vector<Cell>& cells, std::string Cell::*member) {
  std::vector<std::string> values;
  for (const Cell& cell : cells)
    if (std::find(values.begin(), values.end(), cell.*member) == values.end()) values.push_back(cell.*member);
  return values;
}

const char* color_of(const std::string& covariance) {
  if (covariance == "consistent") return "#1b9e77";
  if (covariance == "overconfident") return "#d03030";
  return covariance == "conservative" ? "#1f77b4" : "currentColor";
}

/// One line for each world, with a dot and the interval of each algorithm: rms over that of the bound.
std::string chart(const std::vector<Cell>& cells) {
  constexpr double left = 190, right = 620, row_height = 11, gap = 8, top = 24;
  ChartAxis axis(true);
  axis.add(1);
  for (const Cell& cell : cells)
    for (const double efficiency : {cell.efficiency.value, cell.efficiency.low, cell.efficiency.high})
      if (efficiency > 0) axis.add(1 / efficiency);
  const std::vector<double> ticks = axis.ticks();
  const auto px = [&](double ratio) { return left + share_of_axis(ticks, true, ratio) * (right - left); };
  std::string marks, labels;
  double y = top;
  for (const std::string& world : distinct(cells, &Cell::world)) {
    labels +=
        fmt::format("<text x=\"4\" y=\"{:.1f}\" font-weight=\"bold\">{}</text>", y + row_height - 2, html_text(world));
    y += row_height + 2;
    for (const Cell& cell : cells) {
      if (cell.world != world || !(cell.efficiency.value > 0)) continue;
      const double middle = y + row_height / 2;
      labels += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", left - 8, middle + 3.5,
                            html_text(cell.algorithm));
      const char* color = color_of(cell.covariance);
      if (cell.efficiency.low > 0)
        marks += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"{}\"/>", px(1 / cell.efficiency.high), middle,
                             px(1 / cell.efficiency.low), color);
      marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>", px(1 / cell.efficiency.value),
                           middle, color);
      y += row_height;
    }
    y += gap;
  }
  if (marks.empty()) return {};
  std::string lines;
  for (const double tick : ticks) {
    lines += fmt::format("<path d=\"M{0:.1f} {1}V{2:.1f}\" stroke=\"currentColor\" stroke-opacity=\"{3}\"/>", px(tick),
                         top, y, tick == 1 ? "0.8" : "0.15");
    for (const double at : {top - 6, y + 14})
      labels += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", px(tick), at,
                            tick_text(ticks, tick));
  }
  const std::string title = "rms over that of the bound";
  return fmt::format(
             "<figure><svg viewBox=\"0 0 640 {:.0f}\" role=\"img\" aria-label=\"{}\" "
             "style=\"max-width:100%;height:auto\"><g font-size=\"10\" fill=\"currentColor\">",
             y + 22, title) +
         lines + labels + marks + "</g></svg><figcaption>" + title +
         " (log), with 95 % intervals. Color: the covariance is <span style=\"color:#1b9e77\">consistent</span>, "
         "<span "
         "style=\"color:#d03030\">overconfident</span> or <span "
         "style=\"color:#1f77b4\">conservative</span>.</figcaption>"
         "</figure>\n";
}

std::string cell_html(const Cell& cell) {
  if (cell.runs == 0) return "<td>-</td>";
  const std::string lacking = cell.runs < cell.planned ? fmt::format("<br>{} of {} runs", cell.runs, cell.planned) : "";
  return fmt::format("<td>{} m<br><span style=\"color:{}\" title=\"{}\">NEES {}</span><br>bound / rms {}{}</td>",
                     html_text(cell.rms.text()), color_of(cell.covariance), html_text(cell.covariance),
                     html_text(cell.nees.text()), html_text(cell.efficiency.text()), lacking);
}

std::string table(const std::vector<Cell>& cells) {
  const std::vector<std::string> worlds = distinct(cells, &Cell::world);
  std::string html = "<div class=\"wide\"><table class=\"facts\">\n<thead><tr><th>algorithm</th>";
  for (const std::string& world : worlds) html += "<th>" + html_text(world) + "</th>";
  html += "<th>B/h</th><th>us/event</th></tr></thead>\n<tbody>\n";
  for (const std::string& algorithm : distinct(cells, &Cell::algorithm)) {
    html += "<tr><th scope=\"row\">" + html_text(algorithm) + "</th>";
    // A modem must carry the payload in the worst world. `fmax` ignores NaN, the figure of a world without a result.
    double max_bytes = nan, max_us = nan;
    for (const std::string& world : worlds) {
      const auto cell = std::find_if(cells.begin(), cells.end(), [&](const Cell& each) {
        return each.world == world && each.algorithm == algorithm;
      });
      html += cell == cells.end() ? "<td>-</td>" : cell_html(*cell);
      if (cell == cells.end()) continue;
      max_bytes = std::fmax(max_bytes, cell->bytes_per_h);
      max_us = std::fmax(max_us, cell->us_per_event);
    }
    const auto number = [](double value, const char* form) {
      return std::isfinite(value) ? fmt::format(fmt::runtime(form), value) : std::string("-");
    };
    html += "<td>" + number(max_bytes, "{:.0f}") + "</td><td>" + number(max_us, "{:.2g}") + "</td></tr>\n";
  }
  return html +
         "</tbody></table></div>\n<p>rms: root of the mean square over the seeds, with the 95 % bootstrap interval. "
         "NEES: mean over the seeds with Student's 95 % interval; 2 is consistent. bound / rms: efficiency against the "
         "reference of the metric bound; an estimator that knows the speed of a craft between its fixes, which the "
         "reference does not, can exceed 1. B/h: payload that a vehicle sends, us/event: CPU time, each the largest of "
         "the worlds.</p>\n";
}

std::string pairs(const JsonReader& in) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& item : in.list("pairs")) {
    const JsonReader pair(item, in.where() + ": pairs");
    rows.push_back({pair.text("world"), pair.text("algorithm") + " over " + pair.text("base"),
                    fmt::format("{}", pair.whole("pairs")), estimated(pair, "factor", "factor_95").text(),
                    fmt::format("{:.2g}", number_or_nan(pair.at("wilcoxon_p")))});
  }
  if (rows.empty()) return {};
  return html_details(
      "Ratios of the rms in pairs of equal seeds",
      "<div class=\"wide\">" + html_table({"world", "rms", "pairs", "ratio", "Wilcoxon p"}, rows) + "</div>\n");
}

}  // namespace

std::string study_algorithms_html(const JsonReader& in) {
  if (!in.has("algorithms")) return {};
  const JsonReader algorithms(in.object("algorithms"), in.where() + ": algorithms");
  const std::vector<Cell> cells = cells_of(algorithms);
  std::vector<std::string> sentences;
  for (const auto& item : algorithms.list("sentences")) {
    if (!item.is_string())
      throw std::runtime_error(algorithms.where() + ": 'sentences' must be a list of texts, got " + shown_json(item));
    sentences.push_back(item.get<std::string>() + ".");
  }
  return "<h2>Algorithms</h2>\n" + list_html(sentences) + chart(cells) + table(cells) + pairs(algorithms);
}

}  // namespace experiment
