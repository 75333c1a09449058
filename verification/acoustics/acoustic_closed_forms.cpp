// SPDX-License-Identifier: BSD-3-Clause
#include "verification/acoustics/acoustic_closed_forms.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <stdexcept>

#include "sim/acoustics/propagation/ambient_noise.hpp"
#include "sim/acoustics/propagation/modulation.hpp"
#include "sim/acoustics/propagation/sound_path.hpp"
#include "sim/acoustics/propagation/transmission_loss.hpp"
#include "sim/base/number.hpp"
#include "sim/medium/sea_water.hpp"

namespace verification {

namespace {

using sim::Decibels;
using sim::Modulation;

double number_in(const std::string& text) {
  if (const auto number = sim::read_number(text)) return *number;
  throw std::invalid_argument("'" + text + "' is not a number");
}

/// Numbers of `T=5;depth=10`.
class Parameters {
 public:
  explicit Parameters(const std::string& text) {
    std::istringstream all(text);
    for (std::string each; std::getline(all, each, ';');) {
      const std::size_t equals = each.find('=');
      if (equals != std::string::npos) values_[each.substr(0, equals)] = number_in(each.substr(equals + 1));
    }
  }
  double operator[](const std::string& key) const { return values_.at(key); }
  sim::PowerRatio EbN0() const { return sim::to_power(Decibels((*this)["EbN0_dB"])); }

 private:
  std::map<std::string, double> values_;
};

Decibels loss(const Parameters& p) {
  return sim::spreading_loss(p["range"], p["spreading"]) +
         sim::absorption_loss(p["range"], sim::thorp_dBpkm(p["f_kHz"]));
}

sim::AmbientNoise noise(const Parameters& p) {
  return {p["shipping"], p["wind_mps"], {}};
}

double link_value(const Parameters& p, const std::string& quantity) {
  if (quantity == "TL") return loss(p).dB();
  const Decibels in_band = noise(p).band_level(1000 * p["f_kHz"], p["bandwidth_Hz"]);
  return (Decibels(p["SL"]) - loss(p) - in_band + Decibels(p["DI"])).dB();
}

double travel_s(const Parameters& p) {
  sim::MediumConfig config;
  config.water.emplace().sound_speed_mps = p["c"];
  const sim::Medium medium(config, 9.80665, 1);
  return sim::travel_time_s(medium, {0, 0, -10}, {p["distance"], 0, -10});
}

using Compute = std::function<double(const Parameters&, const std::string& quantity)>;

const std::map<std::string, Compute>& computations() {
  static const std::map<std::string, Compute> all = {
      // Speed of sound, absorption and noise.
      {"sound_speed_mackenzie",
       [](const Parameters& p, const auto&) { return sim::mackenzie_mps(p["T"], p["S"], p["depth"]); }},
      {"sound_speed_medwin",
       [](const Parameters& p, const auto&) { return sim::medwin_mps(p["T"], p["S"], p["depth"]); }},
      {"sound_speed_unesco_chen_millero",
       [](const Parameters& p, const auto&) { return sim::chen_millero_mps(p["T68"], p["S"], p["p_dbar"]); }},
      {"absorption_thorp", [](const Parameters& p, const auto&) { return sim::thorp_dBpkm(p["f_kHz"]); }},
      {"ambient_noise_wenz_coates",
       [](const Parameters& p, const auto&) { return noise(p).spectral_level(p["f_kHz"]).dB(); }},
      // Links.
      {"acoustic_link", link_value},
      {"one_way_travel_time", [](const Parameters& p, const auto&) { return travel_s(p); }},
      // Bit errors.
      {"ber_bfsk_noncoherent",
       [](const Parameters& p, const auto&) { return sim::bit_error_probability(Modulation::fsk, p.EbN0()); }},
      {"ber_bpsk_coherent",
       [](const Parameters& p, const auto&) { return sim::bit_error_probability(Modulation::psk, p.EbN0()); }},
      {"ber_dpsk",
       [](const Parameters& p, const auto&) { return sim::bit_error_probability(Modulation::dpsk, p.EbN0()); }},
      {"ber_bfsk_rayleigh", [](const Parameters& p, const auto&) { return sim::bit_error_rayleigh_fsk(p.EbN0()); }},
      // Packets.
      {"packet_success_bfsk",
       [](const Parameters& p, const auto&) {
         return sim::packet_success_probability(Modulation::fsk, p.EbN0(), std::llround(8 * p["bytes"]));
       }},
      {"micromodem_packet_time",
       [](const Parameters& p, const auto&) {
         return sim::packet_duration_s(std::llround(8 * p["frame_bytes"] * p["frames"]), p["bps"]);
       }},
  };
  return all;
}

}  // namespace

bool ClosedFormRow::within() const {
  return std::abs(computed - expected) <= tolerance;
}

std::vector<ClosedFormRow> acoustic_closed_forms(const std::string& file) {
  std::ifstream in(file);
  std::vector<ClosedFormRow> rows;
  std::string line;
  if (!in) throw std::runtime_error(file + ": cannot be read");
  if (!std::getline(in, line)) throw std::runtime_error(file + ": is empty, or no file");
  for (int number = 2; std::getline(in, line); ++number) {
    // Split the row into fields.
    std::istringstream fields(line);
    std::string field[7];
    for (std::string& text : field) std::getline(fields, text, ',');
    const auto compute = computations().find(field[0]);
    if (compute == computations().end()) continue;
    // Compute the quantity of the row.
    try {
      ClosedFormRow row{field[0], field[1], field[2], field[4], number_in(field[3])};
      row.tolerance = number_in(field[5]) * (field[6] == "rel" ? std::abs(row.expected) : 1);
      row.computed = compute->second(Parameters(row.parameters), row.quantity);
      rows.push_back(row);
    } catch (const std::logic_error&) {  // not a number, or a parameter is missing
      throw std::runtime_error(fmt::format("{}:{}: no closed form of '{}'", file, number, field[0]));
    }
  }
  if (rows.empty()) throw std::runtime_error(file + ": has no closed forms about sound");
  return rows;
}

std::string closed_forms_text(const std::vector<ClosedFormRow>& rows) {
  std::string text =
      "| case | parameters | quantity | expected | computed | tolerance | |\n|---|---|---|---|---|---|---|\n";
  for (const ClosedFormRow& row : rows)
    text += fmt::format("| {} | {} | {} | {:.6g}{} | {:.6g} | {:.2g} | {} |\n", row.name, row.parameters, row.quantity,
                        row.expected, row.unit == "-" ? "" : " " + row.unit, row.computed, row.tolerance,
                        row.within() ? "ok" : "FAILS");
  return text;
}

}  // namespace verification
