// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/report/report_figures.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "experiment/files/html.hpp"

namespace experiment {

namespace {

std::string metric_heading(const RunMetric& metric) {
  std::string about = metric.kind == nullptr ? "" : metric.kind->word;
  if (!metric.vehicle.empty()) about += " of " + metric.vehicle;
  if (!metric.channel.empty()) about += " on " + metric.channel;
  if (metric.kind != nullptr && metric.kind->find("rms_m") != nullptr && metric.dimensions > 0)
    about += metric.dimensions == 2 ? ", horizontal" : ", in three dimensions";
  std::string html = "<h3>" + html_text(metric.name);
  if (!about.empty()) html += " <span class=\"soft small\">" + html_text(about) + "</span>";
  return html + "</h3>\n";
}

std::string full_name(const RunMetric& metric, const RunMetric::Figure& figure) {
  return figure.name.empty() ? metric.name : metric.name + "." + figure.name;
}

/// Removes the marks of Markdown.
std::string plain(std::string text) {
  std::erase(text, '`');
  return text;
}

/// Returns name and meaning of a figure.
std::string named(const std::string& name, const sim::FigureKind* kind) {
  std::string html = html_text(name);
  if (kind != nullptr) html += "<br><span class=\"soft small\">" + html_text(plain(kind->meaning)) + "</span>";
  return html;
}

std::string rows_html(const RunMetric& metric, const std::vector<const RunMetric::Figure*>& figures) {
  std::string html = "<table class=\"figures\">\n<tbody>\n";
  for (const RunMetric::Figure* figure : figures)
    html += "<tr><th scope=\"row\">" + named(figure->name.empty() ? metric.name : figure->name, figure->kind) +
            "</th><td>" + html_text(figure_with_unit(*figure)) + "</td></tr>\n";
  return html + "</tbody></table>\n";
}

std::string folded(std::size_t count, const std::string& body) {
  return html_details(fmt::format("{} {} 0", count, count == 1 ? "figure that is" : "figures that are"), body);
}

}  // namespace

std::string figures_html(const std::vector<RunMetric>& metrics, const std::vector<RunRecord::Rule>& rules) {
  std::string html;
  for (const RunMetric& metric : metrics) {
    const auto is_in_a_rule = [&](const RunMetric::Figure& figure) {
      return std::any_of(rules.begin(), rules.end(), [&](const RunRecord::Rule& rule) {
        return rule.rule.find(full_name(metric, figure)) != std::string::npos;
      });
    };
    std::vector<const RunMetric::Figure*> shown, zeros;
    for (const RunMetric::Figure& figure : metric.figures) {
      // Counts of 0, such as causes of loss that did not happen, would hide the others.
      const bool idle = figure.kind != nullptr && figure.kind->is_count && figure.value == 0.0;
      (idle && &figure != &metric.figures.front() && !is_in_a_rule(figure) ? zeros : shown).push_back(&figure);
    }
    html += metric_heading(metric) + rows_html(metric, shown);
    if (!zeros.empty()) html += folded(zeros.size(), rows_html(metric, zeros));
  }
  return html.empty() ? "" : "<h2>Figures</h2>\n" + html;
}

std::string FigureColumns::rows_of(const std::string& full_name, const RunMetric::Figure& figure, bool idle) const {
  std::string name = figure.name.empty() ? full_name : figure.name;
  if (figure.kind != nullptr && figure.kind->unit != "1") name += ", " + figure.kind->unit;
  std::string html;
  bool first = true;
  for (const Row& row : rows_) {
    if (row.figure != full_name || row.idle != idle) continue;
    if (first && !row.label.empty())
      html += fmt::format("<tr><th colspan=\"{}\">", head_.size() + 1) + named(name, figure.kind) + "</th></tr>\n";
    first = false;
    html += "<tr><th scope=\"row\">" + (row.label.empty() ? named(name, figure.kind) : html_text(row.label)) + "</th>";
    for (const std::string& value : row.values) html += "<td>" + html_text(value) + "</td>";
    html += "</tr>\n";
  }
  return html;
}

std::string FigureColumns::table(const RunMetric& metric, bool idle) const {
  std::string rows;
  for (const RunMetric::Figure& figure : metric.figures) rows += rows_of(full_name(metric, figure), figure, idle);
  if (rows.empty()) return {};
  std::string head = "<th></th>";
  for (const std::string& each : head_) head += "<th>" + html_text(each) + "</th>";
  return "<div class=\"wide\"><table>\n<thead><tr>" + head + "</tr></thead>\n<tbody>\n" + rows +
         "</tbody></table></div>\n";
}

std::string FigureColumns::html() const {
  std::string html;
  for (const RunMetric& metric : metrics_) {
    const std::string shown = table(metric, false), idle = table(metric, true);
    if (shown.empty() && idle.empty()) continue;
    html += metric_heading(metric) + shown;
    if (!idle.empty()) html += html_details("Figures that are 0", idle);
  }
  return html.empty() ? "" : "<h2>Figures</h2>\n" + html;
}

}  // namespace experiment
