// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/lidar3d.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "devices/ranging/ray_casting.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/point_cloud_t.hpp"
#include "sim/config/presets.hpp"
#include "sim/world/world.hpp"

namespace devices {

const sim::Presets& lidar3d_presets();  // lidar3d_presets.yaml

namespace {

constexpr int max_rings = 1000;  // ring numbers have 16 bits in the message

}  // namespace

void Lidar3d::Params::read(sim::ParamReader& in) {
  lidar3d_presets().read(in, *this, {"none"}, "preset of a product by its data sheet; the keys below override it");
  // Rings and columns.
  in.read("rings", rings, sim::between(1, max_rings), "beams above each other, evenly spread");
  in.read_deg("lowest_deg", lowest_rad, sim::between(-90, 90), "elevation of the first ring");
  in.read_deg("highest_deg", highest_rad, sim::between(-90, 90), "elevation of the last ring");
  in.read("ring_angles_deg", ring_angles_deg, sim::between(-90, 90),
          "elevation of each ring, instead of the three keys above");
  in.read("columns", columns, sim::between(1, 100000), "directions in a turn; the turn is a report period long");
  laser.read(in);
  if (in.describing()) return;
  // Check angles, number of rays and rate.
  if (lowest_rad > highest_rad) in.error("lowest_deg", "'lowest_deg' must be <= highest_deg");
  if (ring_angles_deg.size() > std::size_t{max_rings})
    in.error("ring_angles_deg",
             fmt::format("'ring_angles_deg' must have at most {} angles, got {}", max_rings, ring_angles_deg.size()));
  const RayFactor rows = ring_angles_deg.empty() ? RayFactor{"rings", double(rings)}
                                                 : RayFactor{"ring_angles_deg", double(ring_angles_deg.size())};
  const RayFactor factors[] = {rows, {"columns", double(columns)}, {"beam_samples", double(laser.beam_samples)}};
  check_rays(in, factors);
  const double rate_hz = rate_hz_of(in, default_rate_hz);
  if (rate_hz > 0 && rate_hz < 0.001)
    in.error("rate_hz",
             fmt::format("'rate_hz' of a head that turns must be >= 0.001, or 'every_step', got {:g}", rate_hz));
}

Lidar3d::Lidar3d(const Params& params, const sim::DeviceContext& context)
    : config_(context.config), receiver_(params.laser, context) {
  change(params);
}

std::optional<sim::FieldOfView> Lidar3d::field_of_view() const {
  sim::FieldOfView view{sim::FieldOfView::Kind::fan, params_.laser.range_max_m, params_.laser.range_min_m};
  view.from_rad = -std::numbers::pi;
  view.to_rad = std::numbers::pi;
  return view;
}

void Lidar3d::change(const Params& params) {
  params_ = params;
  receiver_.change(params.laser);
  elevations_rad_.clear();
  for (const double angle_deg : params.ring_angles_deg) elevations_rad_.push_back(sim::degrees_to_radians(angle_deg));
  if (elevations_rad_.empty()) {
    const double gap_rad = params.rings > 1 ? (params.highest_rad - params.lowest_rad) / (params.rings - 1) : 0;
    for (int ring = 0; ring < params.rings; ++ring) elevations_rad_.push_back(params.lowest_rad + ring * gap_rad);
  }
  ring_rays_.clear();
  for (const double elevation_rad : elevations_rad_) {
    const sim::Matrix3d up = Eigen::AngleAxisd(-elevation_rad, sim::Vector3d::UnitY()).toRotationMatrix();
    for (const sim::Vector3d& d : receiver_.beam_pattern()) ring_rays_.push_back(up * d);
  }
  returns_.assign(elevations_rad_.size() * static_cast<std::size_t>(params.columns), params.laser.range_max_m);
  turn_end_ = sim::Time{-1};  // restarts the rotation
  next_column_ = 0;
  digest_.renew();
}

sim::Vector3d Lidar3d::direction_S(int column, int ring) const {
  const double azimuth_rad = -std::numbers::pi + 2 * std::numbers::pi * column / params_.columns;
  const double elevation_rad = elevations_rad_[static_cast<std::size_t>(ring)];
  return {std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}

sim::Time Lidar3d::offset(int column) const {
  return -turn_length_ * (params_.columns - 1 - column) / params_.columns;
}

void Lidar3d::start_turn(const sim::SweepContext& context) {
  // A rotation that follows the previous one lasts until the next sample.  Others, at the start, after a pause and at a
  // new rate, last one period.
  if (turn_end_ == context.from)
    turn_length_ = context.next_sample - context.from;
  else
    turn_length_ = config_.rate_hz > 0 ? sim::from_seconds(1 / config_.rate_hz) : context.now - context.from;
  turn_end_ = context.next_sample;
  next_column_ = 0;
  digest_.renew();
  while (next_column_ < params_.columns && turn_end_ + offset(next_column_) <= context.from) ++next_column_;
  returns_.assign(returns_.size(), params_.laser.range_max_m);
}

void Lidar3d::sweep(const sim::SweepContext& context) {
  step_ = context.now - context.from;
  if (turn_end_ != context.next_sample) start_turn(context);
  int last = next_column_;
  while (last < params_.columns && turn_end_ + offset(last) <= context.now) ++last;
  cast_columns(context, next_column_, last);
  next_column_ = last;
}

void Lidar3d::cast_columns(const sim::SweepContext& context, int first, int last) {
  // Rays of the columns from the pose at their times.
  rays_.clear();
  for (int column = first; column < last; ++column) {
    const sim::Pose X_WS = context.X_WS_at(turn_end_ + offset(column));
    const double azimuth_rad = -std::numbers::pi + 2 * std::numbers::pi * column / params_.columns;
    const double c = std::cos(azimuth_rad), s = std::sin(azimuth_rad);
    for (const sim::Vector3d& d : ring_rays_) {
      const sim::Vector3d direction_S(c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z());
      rays_.push_back({X_WS.translation(), X_WS.linear() * direction_S, params_.laser.range_max_m});
    }
  }
  if (rays_.empty()) return;
  // Cast them and convert the hits to returns.
  if (hits_.size() < rays_.size()) hits_.resize(rays_.size());
  const std::span<sim::RayHit> hits = std::span(hits_).first(rays_.size());
  context.world.scene().cast(rays_, receiver_.filter(), hits);
  const std::size_t samples = receiver_.beam_pattern().size();
  const std::size_t first_beam = static_cast<std::size_t>(first) * elevations_rad_.size();
  for (std::size_t i = 0; i < rays_.size() / samples; ++i)
    receiver_.receive(hits.subspan(i * samples, samples), std::span(rays_).subspan(i * samples, samples), returns_,
                      first_beam + i);
}

std::int64_t Lidar3d::rays() const {
  // Rays of one step; all rays before the first rotation.
  const auto all = static_cast<std::int64_t>(ring_rays_.size()) * params_.columns;
  return turn_length_ > step_ ? all * step_.count() / turn_length_.count() : all;
}

// The rotation was measured in sweep().
void Lidar3d::measure(const sim::SenseContext&) {}

void Lidar3d::disturb(double dt_s, sim::Random& random) {
  receiver_.disturb(returns_, dt_s, random);
}

void Lidar3d::visit_state(sim::StateArchive& archive) {
  archive(turn_end_, turn_length_, step_, next_column_, receiver_);
  const bool possible = next_column_ >= 0 && next_column_ <= params_.columns && turn_length_ >= sim::Time{0} &&
                        turn_length_ <= sim::StateArchive::max_time / params_.columns && step_ >= sim::Time{0};
  if (archive.restoring() && !possible) archive.fail("an invalid rotation of the laser's head");
  // A complete rotation is already published; a hash is sufficient.
  if (next_column_ == params_.columns)
    digest_.visit(archive, returns_.ranges_m, returns_.intensities, returns_.returned);
  else
    visit_begun_turn(archive);
}

void Lidar3d::visit_begun_turn(sim::StateArchive& archive) {
  archive.expect_count(elevations_rad_.size(), "rings");
  if (archive.restoring()) {
    returns_.assign(returns_.size(), params_.laser.range_max_m);
    digest_.renew();
  }
  const std::size_t passed = static_cast<std::size_t>(next_column_) * elevations_rad_.size();
  archive.raw(returns_.ranges_m.data(), passed * sizeof(double));
  archive.raw(returns_.intensities.data(), passed * sizeof(double));
  archive.raw(returns_.returned.data(), passed);
}

void fill(const Lidar3d& lidar, shoal::point_cloud_t& message) {
  const LaserReturns& returns = lidar.returns();
  message.x_m.clear();
  message.y_m.clear();
  message.z_m.clear();
  message.intensities.clear();
  message.rings.clear();
  message.time_offsets_us.clear();
  // Beams are numbered by columns, as the head turns, so that the points of a cloud are in the order of their times.
  std::size_t beam = 0;
  for (int column = 0; column < lidar.columns(); ++column)
    for (int ring = 0; ring < lidar.rings(); ++ring, ++beam) {
      if (returns.returned[beam] != LaserReturns::echo) continue;
      const sim::Vector3d p_S = returns.ranges_m[beam] * lidar.direction_S(column, ring);
      message.x_m.push_back(static_cast<float>(p_S.x()));
      message.y_m.push_back(static_cast<float>(p_S.y()));
      message.z_m.push_back(static_cast<float>(p_S.z()));
      message.intensities.push_back(static_cast<float>(returns.intensities[beam]));
      message.rings.push_back(static_cast<std::int16_t>(ring));
      message.time_offsets_us.push_back(static_cast<std::int32_t>(lidar.offset(column).count()));
    }
  message.count = static_cast<std::int32_t>(message.x_m.size());
}

SHOAL_SENSOR("lidar3d", Lidar3d, shoal::point_cloud_t);

}  // namespace devices
