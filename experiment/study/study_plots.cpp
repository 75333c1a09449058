// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "experiment/files/file_replacement.hpp"
#include "experiment/files/gnuplot.hpp"
#include "experiment/files/no_links.hpp"
#include "experiment/results/run_metrics.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/study/algorithm_table.hpp"
#include "experiment/study/study_curves.hpp"
#include "experiment/study/study_results.hpp"
#include "sim/base/log.hpp"

namespace experiment {

namespace {

std::vector<std::string> cases_of(const StudyPlot& plot, const StudyConfig& config) {
  if (!plot.cases.empty()) return plot.cases;
  std::vector<std::string> names;
  for (const StudyCase& each : config.cases) names.push_back(each.name);
  return names;
}

/// Writer of the plots of a study; each gets a data file that can be plotted again.
class StudyPainter {
 public:
  StudyPainter(std::string directory, const LoadedStudy& study, const std::vector<StudyRun>& runs,
               const StudyResults& results)
      : directory_(std::move(directory)), study_(study), runs_(runs), results_(results) {}

  void draw() {
    script_ =
        "set terminal pngcairo size 1000,700 font ',13'\nset grid\n"
        "set key outside center bottom horizontal height 0.6 spacing 1.1\n";
    bool any = false;
    for (const StudyPlot& plot : study_.config.plots) {
      const std::string curves = plot.over == StudyPlot::Over::cases ? by_case(plot) : along(plot);
      if (curves.empty()) continue;  // gnuplot fails on a plot without points
      any = true;
      script_ += "set output " + gnuplot_text(plot.name + ".png") + "\nset title " +
                 gnuplot_text(study_.config.name + ": " + plot.name) + " noenhanced\n" + curves + "\n";
    }
    if (!any) return;
    write_whole_file(directory_ + "/plot.gp", script_);
    if (!run_gnuplot(directory_, "plot.gp", std::chrono::seconds(60), [] { return caught_signal() != 0; }))
      sim::log_warn("no plots: gnuplot failed, see {}/plot.log", directory_);
  }

 private:
  /// Plots every run as a point, beside the mean and standard deviation of its case.
  std::string by_case(const StudyPlot& plot) {
    std::string points, means, tics;
    int number = 0;
    for (const std::string& name : cases_of(plot, study_.config)) {
      ++number;
      tics += fmt::format("{}{} {}", tics.empty() ? "" : ", ", gnuplot_text(name), number);
      for (const double value : results_.values(name, plot.figure))
        if (std::isfinite(value)) points += fmt::format("{} {:.9g}\n", number + 0.1, value);
      const Statistics s = results_.of(name, plot.figure);
      if (s.count > 0) means += fmt::format("{} {:.9g} {:.9g}\n", number - 0.1, s.mean, s.count > 1 ? s.std : 0.0);
    }
    if (points.empty()) return {};
    write_whole_file(directory_ + "/" + plot.name + ".dat", points + "\n\n" + means);
    const std::string file = gnuplot_text(plot.name + ".dat");
    return fmt::format(
        "set xtics ({}) noenhanced\nset xrange [0.5:{}.5]\nset yrange [*:*]\nset xlabel ''\nset ylabel {} noenhanced\n"
        "plot {} index 0 using 1:2 with points pt 7 ps 0.8 lc 1 title 'runs', "
        "{} index 1 using 1:2:3 with yerrorbars lw 2 pt 5 lc 2 title 'mean and standard deviation'\n"
        "set xrange [*:*]\nset xtics auto enhanced",
        tics, number, gnuplot_text(with_unit(plot.figure)), file, file);
  }

  /// Returns `cooperative.rms_m (m)`.
  std::string with_unit(const std::string& name) const {
    const std::map<std::string, std::string> units = units_of(results_.figures());
    const auto unit = units.find(name);
    return unit == units.end() ? name : name + " (" + unit->second + ")";
  }

  /// Plots errors over distance or time: the median of the runs, in a band of 5 to 95 % of them.
  std::string along(const StudyPlot& plot) {
    std::string data, plots;
    int index = 0;
    std::vector<double> reached_m;
    const std::string file = gnuplot_text(plot.name + ".dat");
    const auto cases = cases_of(plot, study_.config);
    for (const std::string& name : cases)
      for (const std::string& metric : plot.metrics) {
        // Data of the band.
        const std::vector<Band> bands = bands_of(curves(plot, name, metric));
        if (bands.empty()) continue;
        reached_m.push_back(0);
        for (const Band& band : bands) reached_m.back() = std::max(reached_m.back(), band.median);
        for (const Band& band : bands)
          data += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {}\n", band.x, band.low, band.median, band.high, band.runs);
        data += "\n\n";
        // Curve and title.
        std::string title = metric;
        if (cases.size() > 1) title = plot.metrics.size() > 1 ? name + ": " + metric : name;
        plots += fmt::format(
            "{0}{1} index {2} using 1:2:4 with filledcurves lc {3} fs transparent solid 0.2 notitle, "
            "{1} index {2} using 1:3 with lines lw 2 lc {3} title {4} noenhanced",
            plots.empty() ? "plot " : ", ", file, index, index + 1, gnuplot_text(title));
        ++index;
      }
    // Axes.
    if (plots.empty()) return {};
    write_whole_file(directory_ + "/" + plot.name + ".dat", data);
    const bool distance = plot.over == StudyPlot::Over::distance;
    return fmt::format("{}set xlabel '{}'\nset ylabel 'error (m): median, 5 to 95 % of the runs'\n{}\nunset logscale y",
                       axis_of_errors(reached_m), distance ? "distance traveled (m)" : "time (s)", plots);
  }

  std::vector<Curve> curves(const StudyPlot& plot, const std::string& name, const std::string& metric) const {
    std::vector<Curve> curves;
    const bool distance = plot.over == StudyPlot::Over::distance;
    for (const StudyRun& run : runs_) {
      if (!run.record || study_.config.cases[run.in_case].name != name) continue;
      Curve curve = read_error_curve(run.directory + "/errors.csv", metric, distance ? "travelled_m" : "time_s");
      if (!curve.empty()) curves.push_back(std::move(curve));
    }
    return curves;
  }

  std::string directory_;
  const LoadedStudy& study_;
  const std::vector<StudyRun>& runs_;
  const StudyResults& results_;
  std::string script_;
};

}  // namespace

std::vector<std::string> study_plots(const StudyConfig& config) {
  std::vector<std::string> files;
  for (const StudyPlot& plot : config.plots) files.push_back(plot.name + ".png");
  return files;
}

void check_outputs(const std::string& directory, const StudyConfig& config) {
  // Checked before the first run: a study of hours must not fail at its last file.
  std::vector<std::string> names{"study.csv",    "points.csv",  "study.json",
                                 "study.sqlite", "report.html", "study.sqlite.part"};
  if (!config.plots.empty()) names.insert(names.end(), {"plot.gp", "plot.log"});
  for (const StudyPlot& plot : config.plots) names.insert(names.end(), {plot.name + ".dat", plot.name + ".png"});
  if (!config.algorithms.empty()) names.insert(names.end(), {"algorithms.csv", "algorithms.md"});
  for (const std::string& name : names) {
    const std::string path = directory + "/" + name;
    refuse_links(directory, path);
    check_whole_file(path);
  }
}

void write_study(const std::string& directory, const LoadedStudy& study, const std::vector<StudyRun>& runs,
                 const StudyResults& results, int exit_code) {
  make_folders(directory, directory);
  std::error_code error;
  // Remove the plots of an earlier study, which would be mistaken for those of this one.
  for (const std::string& image : study_plots(study.config)) std::filesystem::remove(directory + "/" + image, error);
  write_whole_file(directory + "/study.csv", results.to_csv());
  write_whole_file(directory + "/points.csv", results.points_csv());
  if (!study.config.algorithms.empty()) {
    const AlgorithmTable& table = results.algorithm_table();
    write_whole_file(directory + "/algorithms.csv", table.csv());
    write_whole_file(directory + "/algorithms.md", table.markdown());
  }
  StudyPainter(directory, study, runs, results).draw();
  write_whole_file(directory + "/study.json", results.to_json(exit_code));
}

}  // namespace experiment
