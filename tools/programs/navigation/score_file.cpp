// SPDX-License-Identifier: BSD-3-Clause
#include "tools/programs/navigation/score_file.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "autonomy/cooperative/driver/estimate_files.hpp"
#include "bridges/base/json_text.hpp"

namespace navigation {

namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace

void ScoreFile::add(const OfflineRun& run) {
  OfAlgorithm& entry = algorithms_.emplace_back();
  entry.name = run.algorithm;
  entry.us_per_event = 1e6 * run.cpu_s / static_cast<double>(std::max<std::size_t>(run.events, 1));
  const double hours = seconds(record_.end_us) / 3600;
  for (std::size_t i = 0; i < run.estimates.size(); ++i)
    entry.vehicles.push_back(
        {score_of(run.estimates[i], record_.truth[i], record_.epoch_utime, std::llround(1e6 * from_s_)),
         hours > 0 ? static_cast<double>(run.payload_bytes[i]) / hours : 0});
}

void ScoreFile::leave_out(const std::string& name, const std::string& why) {
  OfAlgorithm& entry = algorithms_.emplace_back();
  entry.name = name;
  entry.left_out = why;
}

void ScoreFile::write(const std::string& path) const {
  Json json{
      {"world", record_.world}, {"frame_bytes", frame_bytes_}, {"from_s", from_s_}, {"algorithms", Json::array()}};
  for (const OfAlgorithm& algorithm : algorithms_) {
    // An algorithm that cannot work here is listed with the reason, so that a study can tell it from one that is
    // missing.
    if (!algorithm.left_out.empty()) {
      json["algorithms"].push_back({{"name", algorithm.name}, {"left_out", algorithm.left_out}});
      continue;
    }
    Json entry{{"name", algorithm.name}, {"us_per_event", algorithm.us_per_event}, {"vehicles", Json::object()}};
    for (std::size_t i = 0; i < algorithm.vehicles.size(); ++i) {
      const auto& [score, bytes_per_h] = algorithm.vehicles[i];
      entry["vehicles"][record_.team->vehicles[i].name] = {{"rms_m", number_or_null(score.rms_m)},
                                                           {"nees_mean", number_or_null(score.nees)},
                                                           {"inside_95_share", number_or_null(score.inside_95)},
                                                           {"samples", score.samples},
                                                           {"bytes_per_h", bytes_per_h}};
    }
    json["algorithms"].push_back(std::move(entry));
  }
  std::ofstream file(path);
  file << bridges::json_text(json, 1) << '\n';
  if (!file.flush()) throw std::runtime_error("cannot write '" + path + "'");
}

}  // namespace navigation
