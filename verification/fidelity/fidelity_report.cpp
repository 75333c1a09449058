// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "experiment/files/csv.hpp"
#include "experiment/files/gnuplot.hpp"
#include "experiment/files/scratch_directory.hpp"
#include "verification/fidelity/fidelity.hpp"

namespace verification {

namespace {

std::string bar_text(const std::optional<double>& bar) {
  return bar ? fmt::format("{:g}", *bar) : "-";
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.flush();
  if (!out) throw std::runtime_error("cannot write " + path.string());
}

std::string rows_of(const FidelityResult& result, const std::vector<FidelityState>& states, char separator,
                    bool for_plot) {
  std::string text;
  for (std::size_t i = 0; i < result.t.size(); ++i) {
    text += fmt::format("{:.9g}", result.t[i]);
    for (std::size_t k = 0; k < states[i].size(); ++k) {
      double value = states[i][k];
      // Both are shifted by the same number of turns.
      if (for_plot && k == 5) value = result.theirs[i][k] + std::remainder(value - result.theirs[i][k], 2 * M_PI);
      if (for_plot && ((k >= 3 && k < 6) || k >= 9)) value /= degree_rad;
      text += separator + fmt::format("{:.9g}", value);
    }
    text += '\n';
  }
  return text;
}

std::string panel(const char* title, const char* x, std::initializer_list<std::pair<const char*, const char*>> lines) {
  std::string text = fmt::format("set title '{}'\nplot ", title);
  int color = 0;
  static const char* colors[] = {"#d02020", "#2060c0", "#208030"};
  for (const auto& [column, name] : lines) {
    if (color > 0) text += ", ";
    text += fmt::format(
        "'theirs' using {0}:{1} with lines lw 4 lc rgb '#c8c8c8' notitle, "
        "'ours' using {0}:{1} with lines lw 1 lc rgb '{2}' title '{3}'",
        x, column, colors[color++ % 3], name);
  }
  return text + "\n";
}

/// Returns the interval of the east axis for about three tics.
double tics_of(const FidelityResult& result) {
  double low = result.theirs[0][1], high = low;
  for (const FidelityState& state : result.theirs) {
    low = std::min(low, state[1]);
    high = std::max(high, state[1]);
  }
  const double wide = std::max((high - low) / 2.5, 0.01);
  const double power = std::pow(10, std::floor(std::log10(wide)));
  return power * (wide / power >= 5 ? 5 : wide / power >= 2 ? 2 : 1);
}

/// Formats four digits, without a minus before zero.
std::string digits(double value) {
  const std::string text = fmt::format("{:.4f}", value);
  return text == "-0.0000" ? "0.0000" : text;
}

void plot(const std::filesystem::path& image, const FidelityResult& result) {
  const experiment::ScratchDirectory scratch;
  // Data and script of the plot.
  write(scratch.path / "theirs", rows_of(result, result.theirs, ' ', true));
  write(scratch.path / "ours", rows_of(result, result.ours, ' ', true));
  write(scratch.path / "plot.gp",
        "set terminal pngcairo size 840,440 font ',8'\nset output " +
            experiment::gnuplot_text(std::filesystem::absolute(image).string()) +
            "\nset key samplen 1 spacing 0.9\nset multiplot layout 2,3 title " +
            experiment::gnuplot_text(result.of.name + ": reference grey, ours colored") +
            " noenhanced\nset xlabel 'east (m)'\n" + "set ylabel 'north (m)'\nset size ratio -1\n" +
            fmt::format("set xtics {:g}\n", tics_of(result)) + panel("track", "3", {{"2", ""}}) +
            "set size noratio\nset xtics autofreq\nset xlabel 't (s)'\nset ylabel 'm'\nset yrange [] reverse\n" +
            panel("depth", "1", {{"4", ""}}) + "set yrange [] noreverse\nset ylabel 'deg'\n" +
            panel("attitude", "1", {{"5", "roll"}, {"6", "pitch"}, {"7", "yaw"}}) + "set ylabel 'm/s'\n" +
            panel("speed", "1", {{"8", "surge"}}) + panel("speed across", "1", {{"9", "sway"}, {"10", "heave"}}) +
            "set ylabel 'deg/s'\n" + panel("turn rates", "1", {{"11", "p"}, {"12", "q"}, {"13", "r"}}) +
            "unset multiplot\n");
  // Run gnuplot.
  if (!experiment::run_gnuplot(scratch.path.string(), "plot.gp", std::chrono::seconds(60), [] { return false; })) {
    std::ifstream log(scratch.path / "plot.log");
    std::string line;
    std::getline(log, line);
    throw std::runtime_error("gnuplot did not draw " + image.string() + (line.empty() ? "" : ": " + line));
  }
}

std::string states_header() {
  std::string text = "t";
  for (const char* name : fidelity_states) text += std::string(",") + name;
  return text + "\n";
}

std::string section_of(const FidelityResult& result) {
  std::string text = "### " + result.of.name + "\n\n";
  if (!result.of.text.empty()) text += result.of.text + "\n\n";
  return text + fmt::format("![{0}](fidelity/{0}.png)\n\n", result.of.name);
}

/// Returns the rows of end_states.csv for a case.
std::string end_state_of(const FidelityResult& result) {
  static const char* names[] = {"north_m", "east_m",    "depth_m",  "roll_deg", "pitch_deg",
                                "yaw_deg", "surge_mps", "sway_mps", "heave_mps"};
  const FidelityState &a = result.theirs.back(), &b = result.ours.back();
  std::string text;
  for (std::size_t k = 0; k < std::size(names); ++k) {
    const double unit = k >= 3 && k < 6 ? degree_rad : 1;
    const double difference = k == 5 ? std::remainder(b[k] - a[k], 2 * M_PI) : b[k] - a[k];
    text += fmt::format("{},{},{},{},{}\n", experiment::csv_field(result.of.name), names[k], digits(a[k] / unit),
                        digits((a[k] + difference) / unit), digits(difference / unit));
  }
  return text;
}

}  // namespace

std::string fidelity_table(const std::vector<FidelityResult>& results) {
  std::size_t width = 4;
  for (const FidelityResult& result : results) width = std::max(width, result.of.name.size());
  std::string text = fmt::format(
      "| {:<{}} | step ms | path m | position rms m | bar | max m | bar | velocity rms m/s | bar | turn rms deg/s | "
      "bar "
      "| heading rms deg | bar | ok |\n|:{:-<{}}-|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|\n",
      "case", width, "", width);
  for (const FidelityResult& result : results) {
    const FidelityBars& bars = result.of.bars;
    text += fmt::format(
        "| {:<{}} | {:7g} | {:6.1f} | {:14.2g} | {} | {:7.2g} | {} | {:16.2g} | {} | {:14.2g} | {} | "
        "{:15.2g} | {} | {} |\n",
        result.of.name, width, result.step_s * 1000, result.path_m, result.position_rms_m,
        bar_text(bars.position_rms_m), result.position_max_m, bar_text(bars.position_max_m), result.velocity_rms_mps,
        bar_text(bars.velocity_rms_mps), result.turn_rms_degps, bar_text(bars.turn_rms_degps), result.heading_rms_deg,
        bar_text(bars.heading_rms_deg), result.missed.empty() ? "yes" : "NO");
  }
  return text;
}

std::string fidelity_line(const FidelityResult& result, std::size_t number, std::size_t count) {
  std::string text =
      fmt::format("{} of {}: {}: position rms {:.3g} m", number, count, result.of.name, result.position_rms_m);
  if (!result.missed.empty()) text += fmt::format(", bars missed: {}", result.missed.size());
  return text;
}

void write_fidelity_report(const std::string& folder, const std::string& text,
                           const std::vector<FidelityResult>& results, bool csv) {
  const std::filesystem::path plots = std::filesystem::path(folder) / "fidelity";
  std::filesystem::create_directories(plots);
  std::string page = "# Fidelity\n\nWritten by `shoal fidelity`.\n\n" + text + "\n## The table\n\n" +
                     fidelity_table(results) +
                     "\n[end_states.csv](fidelity/end_states.csv) has the state at the end of each case.\n\n";
  std::string group, end_states = "case,quantity,reference,simulated,difference\n";
  for (const FidelityResult& result : results) {
    if (result.of.group != group) page += "## " + result.of.title + "\n\n";
    group = result.of.group;
    page += section_of(result);
    end_states += end_state_of(result);
    plot(plots / (result.of.name + ".png"), result);
    if (csv) write(plots / (result.of.name + ".csv"), states_header() + rows_of(result, result.ours, ',', false));
  }
  write(plots / "end_states.csv", end_states);
  write(std::filesystem::path(folder) / "fidelity.md", page);
}

void write_fidelity_mutations(const std::string& folder, const std::string& page, const std::string& table) {
  const std::filesystem::path at = folder;
  std::filesystem::create_directories(at / "fidelity");
  write(at / "fidelity_coefficients.md", page);
  write(at / "fidelity" / "coefficients.csv", table);
}

}  // namespace verification
