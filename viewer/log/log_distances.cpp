// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/log_distances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "bridges/base/json_text.hpp"
#include "viewer/log/log_poses.hpp"

namespace viewer {
namespace {

using Json = nlohmann::json;

/// Poses this close in time are of the same time.
constexpr std::int64_t same_time_us = 1000;

/// Position of a point of a body in the world; none: these poses lack the body.
std::optional<sim::Vector3d> position_of(const LogPoses::Poses& poses, const std::string& body,
                                         const sim::Vector3d& p_B) {
  const auto found = std::find(poses.names->begin(), poses.names->end(), body);
  const auto i = static_cast<std::size_t>(found - poses.names->begin());
  if (i >= poses.message.position_m.size()) return std::nullopt;
  const std::vector<double>& p = poses.message.position_m[i];
  const std::vector<float>& q = poses.message.orientation[i];
  return sim::Vector3d(p[0], p[1], p[2]) + sim::Quaterniond(q[0], q[1], q[2], q[3]).normalized() * p_B;
}

}  // namespace

LogDistances::LogDistances(const std::string& path_a, const LogIndex& a, const std::string& path_b, const LogIndex& b,
                           const std::string& scene)
    : a_(path_a, a),
      b_(path_b, b),
      start_us_(std::max(a.start_us(), b.start_us())),
      end_us_(std::min(a.end_us(), b.end_us())) {
  read_vehicles(scene);
  if (end_us_ >= start_us_ && !vehicles_.empty()) times_ = max_times;
}

void LogDistances::read_vehicles(const std::string& scene) {
  const Json json = Json::parse(scene, nullptr, false);
  try {
    for (const Json& vehicle : json.at("vehicles")) {
      const Json& pose = vehicle.at("pose");
      if (vehicles_.size() >= max_vehicles) {
        ++left_out_;
        continue;
      }
      vehicles_.push_back({vehicle.at("name").get<std::string>(),
                           json.at("bodies").at(vehicle.at("body").get<std::size_t>()).at("name").get<std::string>(),
                           {pose.at(0).get<double>(), pose.at(1).get<double>(), pose.at(2).get<double>()},
                           {}});
    }
  } catch (const Json::exception&) {  // a damaged scene: the vehicles up to here
  }
}

void LogDistances::add_time(std::int64_t time_us) {
  const LogPoses::Poses* const a = a_.at(time_us);
  if (a == nullptr || (!t_us_.empty() && a->time_us == t_us_.back())) return;
  const LogPoses::Poses* const b = b_.at(a->time_us);
  // Logs with other rates have no pose at exactly this time; beyond the tolerance the motion itself would be the
  // distance.
  const bool comparable = b != nullptr && std::abs(b->time_us - a->time_us) <= same_time_us;
  t_us_.push_back(a->time_us);
  for (Vehicle& vehicle : vehicles_) {
    double distance_m = std::numeric_limits<double>::quiet_NaN();
    if (comparable) {
      const auto p_a = position_of(*a, vehicle.body, vehicle.p_BV), p_b = position_of(*b, vehicle.body, vehicle.p_BV);
      if (p_a && p_b) distance_m = (*p_a - *p_b).norm();
    }
    vehicle.distance_m.push_back(distance_m);
  }
}

bool LogDistances::compute(std::chrono::steady_clock::time_point deadline) {
  while (done_ < times_ && std::chrono::steady_clock::now() < deadline) {
    const double share = static_cast<double>(done_) / static_cast<double>(times_ - 1);
    add_time(start_us_ + std::llround(share * static_cast<double>(end_us_ - start_us_)));
    ++done_;
  }
  return done_ >= times_;
}

std::string LogDistances::text(const std::optional<LogDifference>& difference) const {
  Json vehicles = Json::array();
  for (const Vehicle& vehicle : vehicles_) {
    Json distances = Json::array();
    // Micrometers: more digits would only make the message longer.
    constexpr double per_m = 1e6;
    for (const double d : vehicle.distance_m)
      distances.push_back(std::isfinite(d) ? Json(std::round(d * per_m) / per_m) : Json(nullptr));
    vehicles.push_back({{"name", vehicle.name}, {"distance_m", std::move(distances)}});
  }
  return bridges::json_text({{"op", "distances"},
                             {"t_us", t_us_},
                             {"differs_us", difference ? Json(difference->time_us) : Json(nullptr)},
                             {"left_out", left_out_},
                             {"vehicles", std::move(vehicles)}});
}

namespace {

/// Calls `use` with the elements of equal times until it returns false; returns the number of such pairs.
template <typename Timed, typename Use>
std::size_t for_equal_times(const std::vector<Timed>& a, const std::vector<Timed>& b, const Use& use) {
  std::size_t pairs = 0;
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (i->time_us != j->time_us) {
      if (i->time_us < j->time_us)
        ++i;
      else
        ++j;
      continue;
    }
    ++pairs;
    if (!use(*i, *j)) break;
    ++i;
    ++j;
  }
  return pairs;
}

/// Returns whether a body that both have is at another pose.
bool differ(const LogPoses::Poses& a, const LogPoses::Poses& b) {
  std::map<std::string_view, std::size_t> index;
  for (std::size_t i = 0; i < a.names->size() && i < a.message.position_m.size(); ++i) index.emplace((*a.names)[i], i);
  for (std::size_t j = 0; j < b.names->size() && j < b.message.position_m.size(); ++j) {
    const auto found = index.find((*b.names)[j]);
    if (found == index.end()) continue;
    const std::size_t i = found->second;
    if (a.message.position_m[i] != b.message.position_m[j] || a.message.orientation[i] != b.message.orientation[j])
      return true;
  }
  return false;
}

}  // namespace

std::optional<LogDifference> first_difference(const std::string& path_a, const LogIndex& a, const std::string& path_b,
                                              const LogIndex& b) {
  std::optional<LogDifference> difference;
  // Hashes: they have all of the state.
  const std::size_t hashes =
      for_equal_times(a.hashes(), b.hashes(), [&](const LogIndex::Hash& one, const LogIndex::Hash& other) {
        if (one.hash == other.hash) return true;
        difference = LogDifference{one.time_us, one.step, "sim.hash"};
        return false;
      });
  if (hashes > 0) return difference;
  // Poses, of logs without hashes.
  LogPoses poses_a(path_a, a), poses_b(path_b, b);
  for_equal_times(a.bodies(), b.bodies(), [&](const LogIndex::Mark& one, const LogIndex::Mark& other) {
    const LogPoses::Poses* const here = poses_a.at(one.time_us);
    const LogPoses::Poses* const there = poses_b.at(other.time_us);
    if (here == nullptr || there == nullptr || !differ(*here, *there)) return true;
    difference = LogDifference{one.time_us, std::nullopt, "poses"};
    return false;
  });
  return difference;
}

}  // namespace viewer
