// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/evolve_page.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "experiment/files/html.hpp"

namespace motion {

namespace {

constexpr double image_width = 800, image_height = 420, left_edge = 70, right_edge = 20, top_edge = 20,
                 bottom_edge = 50;  // of the image, pixels
constexpr double mm_per_m = 1000;

/// Returns 1, 2 or 5 times a power of ten: a distance of about `count` marks over a range.
double mark_distance(double range, int count) {
  const double raw = range / count, power = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw) return factor * power;
  return 10 * power;
}

/// Coordinates of an image.
struct ImageAxis {
  double low, high, from, to;
  double at(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

std::string label_at(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     experiment::html_text(text));
}

std::string grid_line(double x1, double y1, double x2, double y2) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"currentColor\" "
      "stroke-opacity=\"0.2\"/>\n",
      x1, y1, x2, y2);
}

}  // namespace

std::string evolve_curve(const std::vector<EvolveGeneration>& generations) {
  if (generations.size() < 2) return "";
  // Ranges: falls are negative.
  double low = 0, high = 0;
  for (const EvolveGeneration& one : generations) {
    low = std::min({low, one.best_mps * mm_per_m, one.of_generation_mps * mm_per_m});
    high = std::max({high, one.best_mps * mm_per_m, one.of_generation_mps * mm_per_m});
  }
  const double y_mark = mark_distance(std::max(1.0, high - low), 6);
  const ImageAxis x{0, std::max(1.0, static_cast<double>(generations.back().tried)), left_edge,
                    image_width - right_edge};
  const ImageAxis y{std::floor(low / y_mark) * y_mark, std::max(y_mark, std::ceil(high / y_mark) * y_mark),
                    image_height - bottom_edge, top_edge};
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"Speed over candidates\" font-size=\"13\" "
      "fill=\"currentColor\">\n",
      image_width, image_height);
  // Axes.
  for (double value = y.low; value <= y.high + y_mark / 2; value += y_mark)
    svg += grid_line(left_edge, y.at(value), image_width - right_edge, y.at(value)) +
           label_at(left_edge - 8, y.at(value) + 4, "end", fmt::format("{:.0f}", value));
  const double x_mark = mark_distance(x.high, 8);
  for (double value = 0; value <= x.high; value += x_mark)
    svg += grid_line(x.at(value), top_edge, x.at(value), image_height - bottom_edge) +
           label_at(x.at(value), image_height - bottom_edge + 18, "middle", fmt::format("{:.0f}", value));
  svg += label_at((left_edge + image_width - right_edge) / 2, image_height - 10, "middle", "candidates") +
         label_at(left_edge, 14, "middle", "mm/s");
  // Points of the generations, and the best so far.
  std::string line;
  for (const EvolveGeneration& one : generations) {
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\" fill=\"#c05a00\"/>\n", x.at(one.tried),
                       y.at(one.of_generation_mps * mm_per_m));
    line += fmt::format("{}{:.1f},{:.1f}", line.empty() ? "" : " ", x.at(one.tried), y.at(one.best_mps * mm_per_m));
  }
  return svg + "<polyline points=\"" + line + "\" fill=\"none\" stroke=\"#2070c0\" stroke-width=\"2\"/>\n</svg>\n";
}

std::string evolve_page(const EvolveReport& report) {
  std::string body =
      "<h1>" + experiment::html_text(report.title) + "</h1>\n" + experiment::html_table({"", ""}, report.facts);
  if (const std::string curve = evolve_curve(report.generations); !curve.empty())
    body += "<h2>Search</h2>\n<figure>" + curve +
            "<figcaption>Value in the worst world: the best so far (line), and the best of each generation (points)."
            "</figcaption></figure>\n";
  body += "<h2>The best gait in each world</h2>\n" + experiment::html_table(report.world_head, report.worlds);
  body += "<h2>Its numbers</h2>\n" + experiment::html_table({"number", "best", "start"}, report.numbers);
  return experiment::html_page(report.title, body);
}

}  // namespace motion
