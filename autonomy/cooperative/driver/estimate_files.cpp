// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/estimate_files.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/LU>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "autonomy/filters/chi_square.hpp"
#include "bridges/log/event_log.hpp"
#include "bridges/log/record_file.hpp"
#include "experiment/score/trajectory/estimate_file.hpp"
#include "experiment/score/trajectory/mrclam_files.hpp"
#include "shoal/message_codec.hpp"

namespace navigation {

namespace {

std::ofstream opened(const std::filesystem::path& path) {
  std::ofstream file(path);
  if (!file) throw std::runtime_error("cannot write '" + path.string() + "'");
  return file;
}

void write_csv(std::ofstream file, const std::vector<OfflineRun::Published>& estimates) {
  file << "time_s,utime,x_m,y_m,z_m,vx_mps,vy_mps,yaw_rad,cov_xx_m2,cov_xy_m2,cov_yy_m2\n";
  for (const auto& [time_us, message] : estimates) {
    file << fmt::format("{:.6f},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.6f},{:.6g},{:.6g},{:.6g}\n", seconds(time_us),
                        message.utime, message.position_m[0], message.position_m[1], message.position_m[2],
                        message.velocity_mps[0], message.velocity_mps[1], message.yaw_rad, message.covariance_m2[0],
                        message.covariance_m2[1], message.covariance_m2[4]);
  }
}

void write_tum(const std::string& path, const std::vector<OfflineRun::Published>& estimates) {
  experiment::TumFile file(path);
  for (const auto& [time_us, message] : estimates)
    file.add(seconds(time_us), Eigen::Vector3d(message.position_m),
             Eigen::Quaterniond(Eigen::AngleAxisd(message.yaw_rad, Eigen::Vector3d::UnitZ())));
  file.close();
}

void write_mrclam(const std::string& path, const std::string& vehicle,
                  const std::vector<OfflineRun::Published>& estimates) {
  experiment::MrclamPoses file(path, vehicle);
  for (const auto& [time_us, message] : estimates)
    file.add(seconds(time_us), message.position_m[0], message.position_m[1], message.yaw_rad);
  file.close();
}

void write_log(const std::string& path, const NavRecord& record, const OfflineRun& run) {
  bridges::EventLogWriter log(bridges::create_record_file(path, bridges::Existing::overwrite));
  // In the order of time, then of the vehicles.
  std::vector<std::size_t> next(run.estimates.size(), 0);
  for (std::int64_t number = 0;; ++number) {
    std::size_t first = run.estimates.size();
    for (std::size_t i = 0; i < run.estimates.size(); ++i)
      if (next[i] < run.estimates[i].size() &&
          (first == run.estimates.size() ||
           run.estimates[i][next[i]].time_us < run.estimates[first][next[first]].time_us))
        first = i;
    if (first == run.estimates.size()) break;
    const OfflineRun::Published& published = run.estimates[first][next[first]++];
    if (!log.write(number, record.epoch_utime + published.time_us, record.team->vehicles[first].name + ".estimate",
                   shoal::encode(published.message)))
      throw std::runtime_error("cannot write '" + path + "'");
  }
  if (!log.flush()) throw std::runtime_error("cannot write '" + path + "'");
}

}  // namespace

NavScore score_of(const std::vector<OfflineRun::Published>& estimates, const std::vector<NavRecord::Truth>& truth,
                  std::int64_t epoch_utime, std::int64_t from_us) {
  NavScore score;
  double squares = 0;
  for (const auto& [time_us, message] : estimates) {
    const auto true_W = true_position(truth, message.utime - epoch_utime);
    if (time_us < from_us || !true_W) continue;
    const Vector2 error(message.position_m[0] - true_W->x(), message.position_m[1] - true_W->y());
    Matrix2 P;
    P << message.covariance_m2[0], message.covariance_m2[1], message.covariance_m2[3], message.covariance_m2[4];
    const bool is_covariance = P(0, 0) > 0 && P.determinant() > 0;
    const double nees = is_covariance ? error.dot(P.inverse() * error) : std::numeric_limits<double>::infinity();
    squares += error.squaredNorm();
    score.nees += nees;
    score.inside_95 += nees <= autonomy::chi_square_95_2 ? 1 : 0;
    ++score.samples;
  }
  score.rms_m = std::sqrt(squares / score.samples);
  score.nees /= score.samples;
  score.inside_95 /= score.samples;
  return score;
}

void write_estimates(const std::string& folder, const NavRecord& record, const OfflineRun& run) {
  const std::filesystem::path below = std::filesystem::path(folder) / run.algorithm;
  std::error_code failed;
  std::filesystem::create_directories(below, failed);
  if (failed) throw std::runtime_error("cannot make the folder '" + below.string() + "': " + failed.message());
  write_log(below.string() + ".lcm", record, run);
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const std::string& name = record.team->vehicles[i].name;
    write_csv(opened(below / (name + ".csv")), run.estimates[i]);
    write_tum((below / (name + ".tum")).string(), run.estimates[i]);
    write_mrclam((below / ("Robot" + std::to_string(i + 1) + "_Estimate.dat")).string(), name, run.estimates[i]);
  }
}

}  // namespace navigation
