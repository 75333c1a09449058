// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "experiment/files/html.hpp"
#include "experiment/report/chart_axis.hpp"
#include "experiment/report/report_page.hpp"
#include "sim/base/number.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_charts = 24;

/// Point of a curve with the interval of its mean; NaN where there is none.
struct ChartPoint {
  double x = 0, mean = 0, low = 0, high = 0;
};

struct ChartCurve {
  std::string name;
  std::vector<ChartPoint> points;
};

struct Chart {
  std::string title, x_label, y_label;
  bool log_x = false;
  std::vector<ChartCurve> curves;
};

std::optional<double> number_of_text(const std::string& text) {
  const auto value = sim::exact_number<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Writer of one chart as SVG: a dot for each mean, a bar for its interval, and lines between means.
class ChartWriter {
 public:
  explicit ChartWriter(const Chart& chart) : chart_(chart) {
    ChartAxis x_axis(chart.log_x), y_axis;
    for (const ChartCurve& curve : chart.curves)
      for (const ChartPoint& point : curve.points) {
        // A figure without a value at some point leaves a gap in its curve.
        if (!std::isfinite(point.mean)) continue;
        x_axis.add(point.x);
        for (const double value : {point.mean, point.low, point.high}) y_axis.add(value);
      }
    if (x_axis.empty()) return;
    x_ticks_ = x_axis.ticks();
    y_ticks_ = y_axis.ticks();
  }

  std::string html() const {
    if (x_ticks_.empty()) return {};
    double height = bottom + 44;
    const std::string names = legend(height);
    std::string svg = fmt::format(
        "<figure><svg viewBox=\"0 0 640 {1}\" role=\"img\" aria-label=\"{0}\" style=\"max-width:100%;height:auto\">"
        "<title>{0}</title><g font-size=\"12\" fill=\"currentColor\">",
        html_text(chart_.title), height);
    svg += axes() + names;
    std::size_t number = 0;
    for (const ChartCurve& curve : chart_.curves) svg += drawn(curve, number++);
    return svg + "</g></svg><figcaption>" + html_text(chart_.title) +
           ": mean with its 95 % interval.</figcaption></figure>\n";
  }

 private:
  static constexpr double left = 70, right = 620, top = 28, bottom = 270, margin = 12;
  /// Width of a character of the legend.
  static constexpr double character = 7;

  double px(double x) const {
    return left + margin + share_of_axis(x_ticks_, chart_.log_x, x) * (right - left - 2 * margin);
  }
  double py(double y) const { return bottom - share_of_axis(y_ticks_, false, y) * (bottom - top); }

  static const char* color(std::size_t number) {
    static constexpr const char* colors[] = {"#1f77b4", "#d95f02", "#1b9e77", "#7570b3", "#e7298a", "#666666"};
    return colors[number % std::size(colors)];
  }

  std::string axes() const {
    std::string lines, labels;
    const auto label = [&](double x, double y, const char* anchor, const std::string& text) {
      labels +=
          fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", x, y, anchor, html_text(text));
    };
    for (const double tick : x_ticks_) {
      lines += fmt::format("M{:.1f} {}V{}", px(tick), top, bottom);
      label(px(tick), bottom + 16, "middle", tick_text(x_ticks_, tick));
    }
    for (const double tick : y_ticks_) {
      lines += fmt::format("M{} {:.1f}H{}", left, py(tick), right);
      label(left - 6, py(tick) + 4, "end", tick_text(y_ticks_, tick));
    }
    label((left + right) / 2, bottom + 34, "middle", chart_.x_label + (chart_.log_x ? " (log)" : ""));
    label(left, top - 12, "start", chart_.y_label);
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"currentColor\" stroke-opacity=\"0.15\"/>", lines) +
           fmt::format("<path d=\"M{} {}V{}H{}\" fill=\"none\" stroke=\"currentColor\" stroke-opacity=\"0.5\"/>", left,
                       top, bottom, right) +
           labels;
  }

  /// Names of the curves in rows below the chart.  `height`: that of the chart, to which the rows are added.
  std::string legend(double& height) const {
    if (chart_.curves.size() < 2) return {};
    std::string svg;
    double x = left;
    height += 14;
    std::size_t number = 0;
    for (const ChartCurve& curve : chart_.curves) {
      const double width = character * static_cast<double>(curve.name.size() + 3);
      if (x > left && x + width > right) {
        x = left;
        height += 14;
      }
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\">{}</text>", x, height - 6, color(number++),
                         html_text(curve.name));
      x += width;
    }
    return svg;
  }

  std::string drawn(const ChartCurve& curve, std::size_t number) const {
    // Curves stand beside each other, so that equal ones and their intervals are seen.
    const double aside = 3 * (static_cast<double>(number) - static_cast<double>(chart_.curves.size() - 1) / 2);
    const double shift = std::clamp(aside, -margin, margin);
    std::string line, marks;
    for (const ChartPoint& point : curve.points) {
      if (!std::isfinite(point.mean) || (chart_.log_x && point.x <= 0)) continue;
      line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", px(point.x) + shift, py(point.mean));
      marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\" fill=\"{}\" stroke=\"none\"/>",
                           px(point.x) + shift, py(point.mean), color(number));
      if (std::isfinite(point.low) && std::isfinite(point.high))
        marks += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\"/>", px(point.x) + shift, py(point.low), py(point.high));
    }
    if (line.empty()) return {};
    return fmt::format("<g stroke=\"{}\" fill=\"none\"><path d=\"{}\" stroke-width=\"1.5\"/>{}</g>", color(number),
                       line, marks);
  }

  const Chart& chart_;
  std::vector<double> x_ticks_, y_ticks_;
};

/// Statistics of a case at a point, as in study.json.
struct PointOfFile {
  std::string in_case;
  std::vector<std::string> values;
  std::map<std::string, ChartPoint> figures;
};

std::vector<PointOfFile> points_of(const JsonReader& in) {
  std::vector<PointOfFile> points;
  for (const auto& item : in.list("points")) {
    const JsonReader reader(item, in.where() + ": points");
    PointOfFile& point = points.emplace_back();
    point.in_case = reader.text("case");
    for (const auto& value : reader.list("values")) {
      if (!value.is_string())
        throw std::runtime_error(reader.where() + ": 'values' must be texts, got " + shown_json(value));
      point.values.push_back(value.get<std::string>());
    }
    for (const auto& [name, figure] : reader.object("figures").items()) {
      const JsonReader cells(figure, reader.where() + ": figures");
      point.figures[name] = {0, number_or_nan(cells.at("mean")), number_or_nan(cells.at("mean_low_95")),
                             number_or_nan(cells.at("mean_high_95"))};
    }
  }
  return points;
}

/// Curves of a figure over one factor: with several factors, the mean over the points with equal values.
std::vector<ChartCurve> curves_over(const std::vector<PointOfFile>& points, std::size_t factor,
                                    const std::string& figure, bool only_factor) {
  std::map<std::string, std::map<double, std::vector<ChartPoint>>> by_case;
  std::vector<std::string> order;
  for (const PointOfFile& point : points) {
    const auto found = point.figures.find(figure);
    if (factor >= point.values.size() || found == point.figures.end()) continue;
    const auto x = number_of_text(point.values[factor]);
    if (!x || !std::isfinite(found->second.mean)) continue;
    if (!by_case.contains(point.in_case)) order.push_back(point.in_case);
    by_case[point.in_case][*x].push_back(found->second);
  }
  std::vector<ChartCurve> curves;
  for (const std::string& name : order) {
    ChartCurve& curve = curves.emplace_back();
    curve.name = name;
    for (const auto& [x, at_x] : by_case[name]) {
      ChartPoint mean = at_x.front();
      if (!only_factor || at_x.size() > 1) {
        mean = {x, 0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
        for (const ChartPoint& one : at_x) mean.mean += one.mean / static_cast<double>(at_x.size());
      }
      mean.x = x;
      curve.points.push_back(mean);
    }
  }
  return curves;
}

/// Returns `cooperative.rms_m (m)`.
std::string with_unit(const std::string& figure, const std::map<std::string, std::string>& units) {
  const auto unit = units.find(figure);
  return unit == units.end() ? figure : figure + " (" + unit->second + ")";
}

/// Returns the name of a factor with the first setting that it changes, whose name ends in the unit.
std::string factor_label(const JsonReader& factor) {
  const std::string name = factor.text("name");
  if (!factor.has("paths") || factor.list("paths").empty() || !factor.list("paths").front().is_string()) return name;
  return name + ": " + factor.list("paths").front().get<std::string>();
}

std::string factor_charts(const JsonReader& in, const std::map<std::string, std::string>& units) {
  if (!in.has("factors") || !in.has("points")) return {};
  const std::vector<PointOfFile> points = points_of(in);
  std::string html;
  std::size_t charts = 0;
  std::size_t factor = 0;
  const std::size_t factors = in.list("factors").size();
  for (const auto& item : in.list("factors")) {
    const JsonReader reader(item, in.where() + ": factors");
    for (const auto& figure : in.list("figures")) {
      if (!figure.is_string() || ++charts > max_charts) continue;
      const auto name = figure.get<std::string>();
      Chart chart{name + " over " + reader.text("name"), factor_label(reader), with_unit(name, units),
                  reader.boolean("log"), curves_over(points, factor, name, factors == 1)};
      html += ChartWriter(chart).html();
    }
    ++factor;
  }
  return html;
}

std::string convergence_charts(const JsonReader& in, const std::map<std::string, std::string>& units) {
  if (!in.has("convergence")) return {};
  std::vector<Chart> charts;
  for (const auto& item : in.list("convergence")) {
    const JsonReader reader(item, in.where() + ": convergence");
    const std::string figure = reader.text("figure");
    const std::string title = figure + " over the number of seeds";
    // Entries of one figure follow each other and share a chart.
    if (charts.empty() || charts.back().title != title)
      charts.push_back({title, "seeds", with_unit(figure, units), false, {}});
    ChartCurve& curve = charts.back().curves.emplace_back();
    curve.name = reader.text("case");
    for (const auto& point : reader.list("points")) {
      if (!point.is_array() || point.size() != 4 || !point[0].is_number())
        throw std::runtime_error(reader.where() + ": 'points' must be lists of four numbers, got " + shown_json(point));
      curve.points.push_back(
          {point[0].get<double>(), number_or_nan(point[1]), number_or_nan(point[2]), number_or_nan(point[3])});
    }
  }
  std::string html;
  for (const Chart& chart : charts) html += ChartWriter(chart).html();
  return html;
}

std::string short_figure(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "none";
}

/// Returns a link to a file of a run, if there is one.
std::string link_to(const std::string& directory, const std::string& path, const std::string& text) {
  std::error_code error;
  if (!fs::is_regular_file(directory + "/" + path, error)) return {};
  return " <a href=\"" + html_text(path) + "\">" + text + "</a>";
}

}  // namespace

std::string study_charts_html(const JsonReader& in, const std::map<std::string, std::string>& units) {
  const std::string html = factor_charts(in, units) + convergence_charts(in, units);
  return html.empty() ? "" : "<h2>Curves</h2>\n" + html;
}

std::string study_comparisons_html(const JsonReader& in) {
  if (!in.has("comparisons") || in.list("comparisons").empty()) return {};
  std::vector<std::vector<std::string>> rows;
  for (const auto& item : in.list("comparisons")) {
    const JsonReader row(item, in.where() + ": comparisons");
    const auto cell = [&](const char* key) { return short_figure(number_or_nan(row.at(key))); };
    rows.push_back({row.text("figure"), row.text("compared") + " minus " + row.text("base"),
                    fmt::format("{}", row.whole("pairs")), cell("mean"),
                    cell("mean_low_95") + " to " + cell("mean_high_95"), cell("median"), cell("sign_p"),
                    cell("wilcoxon_p")});
  }
  return "<h2>Differences in pairs of equal seeds</h2>\n<div class=\"wide\">" +
         html_table(
             {"figure", "difference", "pairs", "mean", "mean, 95 % interval", "median", "sign test p", "Wilcoxon p"},
             rows) +
         "</div>\n";
}

std::string study_extremes_html(const JsonReader& in, const std::string& directory) {
  if (!in.has("extremes") || in.list("extremes").empty()) return {};
  std::string html = "<h2>Runs to look at</h2>\n<ul>\n";
  for (const auto& item : in.list("extremes")) {
    const JsonReader run(item, in.where() + ": extremes");
    std::string links;
    for (const std::string& folder : {run.text("shown"), run.text("folder")}) {
      // study.json may come from someone else: its links stay below the folder of the study.
      if (folder.starts_with('/') || folder.find("..") != std::string::npos)
        throw std::runtime_error(run.where() + ": 'folder' must be a folder of the study");
      links += link_to(directory, folder + "/run.html", "view") + link_to(directory, folder + "/film.mp4", "film") +
               link_to(directory, folder + "/film.webm", "film") +
               link_to(directory, folder + "/report.html", "report");
    }
    links += link_to(directory, run.text("folder") + "/summary.json", "summary");
    html += "<li>" +
            html_text(fmt::format("{} {}: {} in run {} ({}, seed {})", run.text("which"), run.text("figure"),
                                  short_figure(run.number("value")), run.whole("run"), run.text("case"),
                                  run.whole("seed"))) +
            links + "<br><code>" + html_text(run.text("command")) + " --view</code></li>\n";
  }
  return html + "</ul>\n";
}

}  // namespace experiment
