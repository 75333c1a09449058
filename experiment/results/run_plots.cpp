// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/run_plots.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "experiment/files/gnuplot.hpp"
#include "sim/base/vehicle_colors.hpp"

namespace experiment {

namespace {

/// More vehicles than this are drawn as dots in one color.
constexpr std::size_t max_named_tracks = 12;

using Tracks = std::vector<Scoring::Track>;

/// Selects one metric for each estimate: several metrics may use one estimate, which is drawn once, with the metric
/// that has the most samples.  Metrics without samples are omitted, because gnuplot fails on a plot without points.
Tracks distinct(const Tracks& tracks) {
  Tracks kept;
  for (const Scoring::Track& track : tracks) {
    if (track.samples->empty()) continue;
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const Scoring::Track& other) {
      return other.vehicle == track.vehicle && other.channel == track.channel && other.dimensions == track.dimensions;
    });
    if (same == kept.end())
      kept.push_back(track);
    else if (track.samples->size() > same->samples->size())
      *same = track;
  }
  return kept;
}

bool has_covariance(const Scoring::Track& track) {
  return std::any_of(track.samples->begin(), track.samples->end(),
                     [](const ErrorSample& sample) { return std::isfinite(sample.nees); });
}

/// Returns `'errors.csv' using X:Y` of one metric; x and y are columns of errors.csv.
std::string curve(const std::string& metric, int x, const std::string& y, const std::string& look) {
  return fmt::format("'errors.csv' every ::1 using (strcol(2) eq {} ? ${} : NaN):{} with lines {}",
                     gnuplot_text(metric), x, y, look);
}

std::string joined(const std::vector<std::string>& curves) {
  std::string text = "plot ";
  for (std::size_t i = 0; i < curves.size(); ++i) text += (i > 0 ? ", " : "") + curves[i];
  return text + "\n";
}

/// Canvas with the aspect ratio of the tracks.
constexpr const char* canvas_for_tracks =
    "stats 'tracks.csv' every ::1 using 3 name 'E' nooutput\nstats 'tracks.csv' every ::1 using 4 name 'N' nooutput\n"
    "stats 'outlines.dat' using (real(word(strcol(1),1))) name 'OE' nooutput\n"
    "stats 'outlines.dat' using (real(word(strcol(1),2))) name 'ON' nooutput\n"
    "larger(a, b) = a > b ? a : b\n"
    "width = larger(larger(E_max, OE_max) + larger(-E_min, -OE_min), 1e-3)\n"
    "height = larger(larger(N_max, ON_max) + larger(-N_min, -ON_min), 1e-3)\n"
    // A straight track has a range across it that its labels fit into.
    "least = 0.3 * larger(width, height)\n"
    "middle(low, high) = 0.5 * (high - low)\n"
    "east = middle(larger(-E_min, -OE_min), larger(E_max, OE_max))\n"
    "north = middle(larger(-N_min, -ON_min), larger(N_max, ON_max))\n"
    "if (width < least) set xrange [east - 0.5 * least : east + 0.5 * least]\n"
    "if (height < least) set yrange [north - 0.5 * least : north + 0.5 * least]\n"
    "across = larger(400, 900 * (height > width ? width / height : 1))\n"
    "up = larger(250, 900 * (width > height ? height / width : 1))\n"
    "set terminal pngcairo size across + 100, up + 220 font ',13'\n";

constexpr std::array strong_colors{"#000000", "#cb181d", "#54278f", "#006d2c",
                                   "#b15900", "#08519c", "#ae017e", "#636363"};

template <std::size_t n>
const char* cycled(const std::array<const char*, n>& colors, std::size_t i) {
  return colors[i % n];
}

/// Returns the final positions of the vehicles: one that stands still would be invisible otherwise.
std::string end_positions(const sim::World& world) {
  std::string text = "$ends << EOD\n";
  for (const auto& vehicle : world.vehicles()) {
    const sim::Vector3d p = vehicle->X_WV().translation();
    text += fmt::format("{:.4f},{:.4f}\n", p.x(), p.y());
  }
  return text + "EOD\n";
}

/// Returns `set title` of a plot of this world.
std::string title_of(const sim::World& world, const std::string& what) {
  return "set title " + gnuplot_text(world.config().name + ": " + what) + " noenhanced\n";
}

/// Tracks are drawn wide, in the colors of the vehicles and half transparent, estimates dark and thin on top of them,
/// so that both are visible.
std::string tracks_script(const sim::World& world, const Tracks& tracks) {
  std::size_t estimates = 0;
  std::vector<std::string> curves{
      "'outlines.dat' using (real(word(strcol(1),1))):(real(word(strcol(1),2))) with lines lc 'gray40' notitle"};
  // True tracks.
  if (world.vehicles().size() > max_named_tracks) {
    curves.emplace_back("'tracks.csv' every ::1 using 3:4 with dots lc 'blue' title 'vehicles'");
  } else {
    for (const auto& vehicle : world.vehicles())
      curves.push_back(fmt::format(
          "'tracks.csv' every ::1 using (strcol(2) eq {0} ? $3 : NaN):4 with lines lw 5 lc '#80{1:06x}' title {0} "
          "noenhanced",
          gnuplot_text(vehicle->name()), sim::vehicle_color(vehicle->number())));
  }
  // Estimates.
  std::set<std::string> drawn;
  for (const Scoring::Track& track : tracks)
    if (drawn.insert(track.metric).second)
      curves.push_back(curve(track.metric, 4, "5",
                             fmt::format("lw 1.5 dt 2 lc '{}' title {} noenhanced", cycled(strong_colors, estimates++),
                                         gnuplot_text(track.metric + " estimate of " + track.vehicle))));
  // Final positions.
  if (!world.vehicles().empty())
    curves.emplace_back("$ends using 1:2 with points pt 7 ps 1 lc 'gray20' title 'at the end'");
  return canvas_for_tracks + end_positions(world) + title_of(world, "tracks from above") +
         "set output 'tracks.png'\nset size ratio -1\nset xlabel 'east (m)'\nset ylabel 'north (m)'\n" +
         "set offsets graph 0.03, graph 0.03, graph 0.03, graph 0.03\n" + joined(curves) +
         "unset offsets\nset xrange [*:*]\nset yrange [*:*]\n";
}

double rms_of(const Scoring::Track& track) {
  double squares = 0;
  for (const ErrorSample& sample : *track.samples) squares += sample.error_m * sample.error_m;
  return std::sqrt(squares / static_cast<double>(track.samples->size()));
}

/// Plots errors over a column, with the three-sigma bound of the estimate.
std::string errors_script(const Tracks& tracks, const char* file, const char* x_label, int x) {
  std::vector<std::string> curves;
  std::vector<double> errors_m;
  std::size_t number = 0;
  for (const Scoring::Track& track : tracks) {
    const char* color = cycled(strong_colors, number++);  // the same as in tracks.png
    errors_m.push_back(rms_of(track));
    curves.push_back(curve(track.metric, x, "3",
                           fmt::format("lw 2 lc '{}' title {} noenhanced", color, gnuplot_text(track.metric))));
    if (has_covariance(track))
      curves.push_back(curve(track.metric, x, "(3*$11)",
                             fmt::format("lw 1 dt 2 lc '{}' title {} noenhanced", color,
                                         gnuplot_text(track.metric + ": 3 sigma as estimated"))));
  }
  return fmt::format("set output '{}'\nset size noratio\nset xlabel '{}'\nset ylabel 'position error (m)'\n", file,
                     x_label) +
         axis_of_errors(errors_m) + joined(curves) + "unset logscale y\nset autoscale y\n";
}

/// Plots consistency over time, with its expected mean and the bound of 95 % of the samples.
std::string nees_script(const Tracks& tracks) {
  std::vector<std::string> curves;
  std::set<int> dimensions;
  std::size_t number = 0;
  for (const Scoring::Track& track : tracks) {
    ++number;
    if (!has_covariance(track)) continue;
    dimensions.insert(track.dimensions);
    curves.push_back(curve(
        track.metric, 1, "12",
        fmt::format("lc '{}' title {} noenhanced", cycled(strong_colors, number - 1), gnuplot_text(track.metric))));
  }
  if (curves.empty()) return {};
  for (const int size : dimensions) {
    curves.push_back(fmt::format("{} dt 2 lc 'gray40' title 'mean of a consistent estimate ({}D)'", size, size));
    curves.push_back(fmt::format("{:.4f} dt 3 lc 'black' title '95 % bound ({}D)'", chi_square_95(size), size));
  }
  return "set output 'nees.png'\nset size noratio\nset xlabel 'time (s)'\n"
         "set ylabel 'normalized estimation error squared'\nset logscale y\nset yrange [1e-3:*]\n" +
         joined(curves) + "unset logscale y\nset autoscale y\n";
}

}  // namespace

std::string run_plots_script(const sim::World& world, const Scoring& scoring) {
  const Tracks tracks = distinct(scoring.tracks());
  std::string script =
      // The rows of vehicles alternate: without `missing`, rows of other vehicles would interrupt the line.
      "set datafile separator ','\nset datafile missing NaN\nset grid\n"
      // Below the axis and its label, outside of the data.
      "set key outside center bottom horizontal height 0.6 spacing 1.1\n" +
      tracks_script(world, tracks);
  if (tracks.empty()) return script;
  script += "set terminal pngcairo size 1000,700 font ',13'\n" + title_of(world, "position error over time");
  script += errors_script(tracks, "errors.png", "time (s)", 1);
  const auto went = [](const Scoring::Track& track) { return track.samples->back().travelled_m >= min_distance_m; };
  if (std::any_of(tracks.begin(), tracks.end(), went)) {
    script += title_of(world, "position error over distance");
    script += errors_script(tracks, "errors_by_distance.png", "distance traveled (m)", 10);
  }
  return script + title_of(world, "consistency of the estimates") + nees_script(tracks);
}

}  // namespace experiment
