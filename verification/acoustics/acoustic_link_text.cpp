// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "experiment/files/gnuplot.hpp"
#include "experiment/files/scratch_directory.hpp"
#include "verification/acoustics/acoustic_link.hpp"

// Output of a link: readable tables, CSV for programs, plots.

namespace verification {

namespace {

std::string row_text(const char* name, sim::Decibels value, const std::string& remark) {
  std::string text = fmt::format("{:<25}{:>8.1f} dB", name, value.dB());
  if (!remark.empty()) text += "  " + remark;
  return text + "\n";
}

const char* model_name(const sim::AbsorptionConfig& absorption) {
  using Model = sim::AbsorptionConfig::Model;
  return absorption.model == Model::thorp               ? "thorp"
         : absorption.model == Model::francois_garrison ? "francois_garrison"
                                                        : "constant";
}

/// Signal with the echoes in the window over noise and later echoes.
sim::Decibels snr_with_echoes(const LinkBudget& budget) {
  const sim::PowerRatio both = sim::to_power(budget.noise) + sim::to_power(*budget.late);
  return budget.level + *budget.echoes - sim::to_decibels(both);
}

}  // namespace

std::string budget_text(const AcousticLink& link, const LinkBudget& budget, const sim::AcousticsConfig& acoustics) {
  const sim::SpreadingConfig& spreading = acoustics.spreading;
  // Source level and propagation.
  std::string text = row_text("source level", link.source_level, "re 1 uPa at 1 m");
  text += row_text("directivity, sender", budget.from_gain, "");
  text += row_text("spreading", budget.spreading,
                   budget.bent ? "of the ray, by its tube"
                   : spreading.transition_range_m
                       ? fmt::format("spherical to {:g} m, then cylindrical; {:.1f} m", *spreading.transition_range_m,
                                     budget.range_m)
                       : fmt::format("{:g} log10({:.1f} m)", 10 * spreading.factor, budget.range_m));
  text += row_text("absorption", budget.absorption,
                   fmt::format("{:.3f} dB/km at {:g} Hz, {}", budget.absorption_dBpkm, link.centre_Hz,
                               model_name(acoustics.absorption)));
  text += row_text("directivity, receiver", budget.to_gain, "");
  const bool silent = budget.level.dB() == -HUGE_VAL;
  const char* const path = !budget.bent     ? "direct path"
                           : !budget.shadow ? "first ray"
                           : silent         ? "in a shadow: no ray arrives"
                                            : "in a shadow";
  text += row_text("level at the receiver", budget.level, fmt::format("re 1 uPa, {}", path));
  // Multipath.
  if (budget.echoes)
    text += row_text(
        "echoes in the window", *budget.echoes,
        fmt::format("phases {}; delays spread by {:.2f} ms rms",
                    acoustics.multipath->phases == sim::MultipathConfig::Phases::random ? "averaged" : "of the paths",
                    1000 * budget.delay_spread_s));
  if (budget.late && budget.late->dB() > -HUGE_VAL) text += row_text("echoes that disturb", *budget.late, "re 1 uPa");
  // Noise.
  text +=
      row_text("noise per hertz", budget.noise_per_Hz,
               fmt::format("re 1 uPa^2/Hz; shipping {:g}, wind {:g} m/s", acoustics.noise.shipping, budget.wind_mps));
  if (budget.noise_reduction.dB() != 0)
    text += row_text("directivity index", -budget.noise_reduction, "of the receiver against noise from all sides");
  text += row_text("noise in the band", budget.noise, fmt::format("re 1 uPa; {:g} Hz", link.bandwidth_Hz));
  // Signal-to-noise ratio and travel time.
  text += row_text("signal over noise", budget.snr, path);
  if (budget.echoes && budget.late) text += row_text("signal over noise, echoes", snr_with_echoes(budget), "");
  if (!silent)
    text += fmt::format("{:<25}{:>8.4f} s   over {:.1f} m, {:.2f} m/s on average\n", "travel time",
                        budget.travel_time_s, budget.range_m, budget.range_m / std::max(budget.travel_time_s, 1e-12));
  if (budget.bent && !silent)
    text += fmt::format("{:<25}{:>8.2f} deg over the horizontal; at the receiver {:.2f} deg\n", "launch angle",
                        budget.launch_rad * 180 / std::numbers::pi, budget.arrival_rad * 180 / std::numbers::pi);
  return text;
}

std::string packets_text(const AcousticLink& link, const LinkBudget& budget, const std::vector<AcousticPacket>& packets,
                         const std::vector<double>& delivered) {
  std::string text = fmt::format("{:<10}{:>8}{:>7}{:>8}{:>10}{:>11}{:>15}{:>10}\n", "modulation", "bit/s", "bytes",
                                 "time_s", "Eb/N0_dB", "bit_error", "all_bits_right", "delivered");
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const AcousticPacket& packet = packets[i];
    const sim::PowerRatio energy =
        sim::energy_per_bit(sim::to_power(budget.snr + link.coding_gain), link.bandwidth_Hz, packet.bit_rate_bps);
    const double bit_error = sim::bit_error_probability(packet.modulation, energy);
    text += fmt::format("{:<10}{:>8g}{:>7}{:>8.3f}{:>10.1f}{:>11.3g}{:>15.4f}{:>10.4f}\n",
                        sim::to_string(packet.modulation), packet.bit_rate_bps, packet.bytes,
                        sim::packet_duration_s(8 * packet.bytes, packet.bit_rate_bps), sim::to_decibels(energy).dB(),
                        bit_error, sim::packet_success_probability(bit_error, 8 * packet.bytes), delivered[i]);
  }
  return text;
}

std::string csv_text(const std::vector<RangeRow>& rows, const std::vector<AcousticPacket>& packets) {
  std::string text = "range_m,travel_time_s,level_dB,noise_dB,snr_dB";
  for (const AcousticPacket& packet : packets) text += ",delivered_" + packet.name;
  const bool echoes = !rows.empty() && rows.front().budget.echoes && rows.front().budget.late;
  text += echoes ? ",snr_with_echoes_dB\n" : "\n";
  for (const RangeRow& row : rows) {
    const LinkBudget& budget = row.budget;
    const bool arrives = budget.level.dB() > -HUGE_VAL;
    text += fmt::format("{:g},{:.6f},{:.3f},{:.3f},{:.3f}", budget.range_m, arrives ? budget.travel_time_s : NAN,
                        budget.level.dB(), budget.noise.dB(), budget.snr.dB());
    for (const double delivered : row.delivered) text += fmt::format(",{:.6f}", delivered);
    if (echoes) text += fmt::format(",{:.3f}", snr_with_echoes(budget).dB());
    text += "\n";
  }
  return text;
}

void draw_over_range(const std::vector<RangeRow>& rows, const std::vector<AcousticPacket>& packets,
                     const std::string& title, const std::string& png) {
  const experiment::ScratchDirectory scratch;
  std::ofstream(scratch.path / "data.csv") << csv_text(rows, packets);
  std::string script = fmt::format(
      "set datafile separator ','\nset terminal pngcairo size 900,640\nset output {}\n"
      "set multiplot layout 2,1 title {} noenhanced\nset grid\nset autoscale xfix\nset key outside right "
      "noenhanced\nset lmargin 9\n"
      "set rmargin 30\nset xlabel 'range (m)'\nset ylabel 'signal over noise (dB)'\n"
      "plot 'data.csv' skip 1 using 1:5 with lines lw 2 title 'mean, in the band'\n"
      "set ylabel 'delivered'\nset yrange [-0.02:1.02]\nplot ",
      experiment::gnuplot_text(std::filesystem::absolute(png).string()), experiment::gnuplot_text(title));
  for (std::size_t i = 0; i < packets.size(); ++i)
    script +=
        fmt::format("{}'data.csv' skip 1 using 1:{} with lines lw 2 title {}", i == 0 ? "" : ", ", 6 + i,
                    experiment::gnuplot_text(fmt::format("{} {:g} bit/s, {} B", sim::to_string(packets[i].modulation),
                                                         packets[i].bit_rate_bps, packets[i].bytes)));
  std::ofstream(scratch.path / "plot.gp") << script << "\nunset multiplot\n";
  if (experiment::run_gnuplot(scratch.path.string(), "plot.gp", std::chrono::seconds(30), [] { return false; })) return;
  // gnuplot names its first error in the first line.
  std::ifstream reported(scratch.path / "plot.log");
  std::string line;
  std::getline(reported, line);
  throw std::runtime_error("gnuplot did not draw " + png + (line.empty() ? "" : ": " + line));
}

}  // namespace verification
