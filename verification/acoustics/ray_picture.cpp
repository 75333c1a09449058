// SPDX-License-Identifier: BSD-3-Clause
#include "verification/acoustics/ray_picture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "experiment/files/gnuplot.hpp"
#include "experiment/files/scratch_directory.hpp"
#include "sim/acoustics/propagation/propagation.hpp"
#include "sim/acoustics/rays/ray_tables.hpp"

namespace verification {

namespace {

constexpr int fan_steps = 800;

/// Rays of a fan: dense about the horizontal, where rays bend most.
std::vector<double> fan_angles_rad() {
  std::vector<double> angles;
  for (int i = -24; i <= 24; ++i) {
    const double share = i / 24.0;
    angles.push_back((4 * share + 16 * share * share * share) * std::numbers::pi / 180);
  }
  return angles;
}

}  // namespace

RayField ray_field(double source_m, double range_m, double frequency_Hz, const sim::AcousticsConfig& acoustics,
                   const sim::Medium& medium, std::optional<double> water_depth_m) {
  RayField field;
  field.source_m = source_m;
  field.range_m = range_m;
  const sim::MultipathConfig* const multipath = acoustics.multipath ? &*acoustics.multipath : nullptr;
  const double water_m =
      multipath != nullptr && multipath->water_depth_m ? *multipath->water_depth_m : water_depth_m.value_or(HUGE_VAL);
  // Without a bottom the image shows the depths of the profile and of both ends.
  const std::vector<double> rows_m = medium.profile_depths_m();
  field.deepest_m =
      std::isfinite(water_m) ? water_m : std::max({100.0, 2 * source_m, rows_m.empty() ? 0 : 1.5 * rows_m.back()});
  sim::RayTables tables([&](double z_m) { return medium.sound_speed_at_depth_mps(z_m); }, rows_m);
  const sim::Eigenrays& rays = tables.of(water_m);
  for (const sim::SoundProfile::Knot& knot : rays.profile().knots())
    if (knot.depth_m < field.deepest_m) field.profile.push_back(knot);
  field.profile.push_back({field.deepest_m, rays.profile().speed_mps(field.deepest_m)});
  // The fan.
  field.fan_step_m = range_m / fan_steps;
  for (const double angle_rad : fan_angles_rad())
    field.fan.push_back(
        sim::trace_ray(rays.profile(), source_m, angle_rad, std::min(water_m, 1e5), field.fan_step_m, fan_steps));
  // The losses.
  field.columns = 240;
  field.rows = 120;
  const double still_m = medium.still_surface_m();
  const sim::Vector3d source_W(0, 0, still_m - source_m);
  std::vector<sim::SoundRay> found;
  for (int column = 0; column < field.columns; ++column)
    for (int row = 0; row < field.rows; ++row) {
      RayField::Point point{(column + 0.5) * range_m / field.columns, (row + 0.5) * field.deepest_m / field.rows, 0,
                            true};
      rays.find({source_m, point.depth_m, point.range_m, water_m, multipath != nullptr ? multipath->max_bounces : 0},
                found);
      const sim::Vector3d point_W(point.range_m, 0, still_m - point.depth_m);
      sim::MultipathMedium water;
      water.frequency_Hz = frequency_Hz;
      water.sound_speed_mps = 1 / medium.mean_slowness_spm(source_W.z(), point_W.z());
      water.absorption_dBpkm = sim::absorption_dBpkm(acoustics.absorption, frequency_Hz, medium, source_W, point_W);
      water.wind_mps = acoustics.noise.wind_mps.value_or(medium.mean_wind_mps());
      sim::PowerRatio power;
      for (const sim::PathGain& gain : sim::ray_gains(found, multipath, water)) power += sim::to_power(gain.gain);
      for (const sim::SoundRay& ray : found) point.shadow = point.shadow && ray.bounces() > 0;
      point.loss_dB = -sim::to_decibels(power).dB();
      field.points.push_back(point);
    }
  return field;
}

void draw_rays(const RayField& field, const std::string& title, const std::string& png) {
  const experiment::ScratchDirectory scratch;
  std::ofstream profile(scratch.path / "profile.dat"), fan(scratch.path / "fan.dat"), loss(scratch.path / "loss.dat"),
      shadow(scratch.path / "shadow.dat");
  for (const sim::SoundProfile::Knot& knot : field.profile)
    profile << fmt::format("{:.4f} {:.3f}\n", knot.speed_mps, knot.depth_m);
  for (const sim::RayTrace& ray : field.fan) {
    for (std::size_t i = 0; i < ray.depth_m.size(); ++i)
      fan << fmt::format("{:.3f} {:.3f}\n", static_cast<double>(i) * field.fan_step_m, ray.depth_m[i]);
    fan << "\n\n";
  }
  const auto [slowest, fastest] =
      std::minmax_element(field.profile.begin(), field.profile.end(),
                          [](const auto& a, const auto& b) { return a.speed_mps < b.speed_mps; });
  const double speed_step_mps = std::max(1.0, std::ceil((fastest->speed_mps - slowest->speed_mps) / 2));
  double min_dB = HUGE_VAL, max_dB = 0;
  for (const RayField::Point& point : field.points)
    if (std::isfinite(point.loss_dB)) {
      min_dB = std::min(min_dB, point.loss_dB);
      max_dB = std::max(max_dB, point.loss_dB);
    }
  for (const RayField::Point& point : field.points) {
    loss << fmt::format("{:.3f} {:.3f} {:.2f}\n", point.range_m, point.depth_m,
                        std::isfinite(point.loss_dB) ? point.loss_dB : NAN);
    // Diagonal stripes.
    const auto stripe = std::floor((point.range_m / field.range_m * 96 + point.depth_m / field.deepest_m * 48) / 2);
    const bool dark = point.shadow && std::fmod(stripe, 2) == 0;
    shadow << fmt::format("{:.3f} {:.3f} 40 40 40 {}\n", point.range_m, point.depth_m, dark ? 110 : 0);
  }
  for (std::ofstream* file : {&profile, &fan, &loss, &shadow}) file->close();
  const std::string script = fmt::format(
      "set terminal pngcairo size 1200,560\nset output {}\nset multiplot title {} noenhanced\nset yrange [{}:0]\n"
      "set lmargin at screen 0.07\nset rmargin at screen 0.2\nset tmargin at screen 0.88\nset bmargin at screen 0.13\n"
      "set grid\nset xtics {:.0f}\nset xlabel 'speed of sound (m/s)'\nset ylabel 'depth (m)'\n"
      "plot 'profile.dat' using 1:2 with lines lw 2 notitle\n"
      "set lmargin at screen 0.25\nset rmargin at screen 0.89\nunset grid\nset ylabel ''\nset xtics autofreq\n"
      "set xlabel 'range (m)'\nset xrange [0:{}]\nset cblabel 'loss (dB); striped: no ray without a "
      "bounce'\n"
      "set palette rgb 33,13,10 negative\nset cbrange [{:.0f}:{:.0f}] reverse\n"
      "plot 'loss.dat' using 1:2:3 with image notitle, 'shadow.dat' using 1:2:3:4:5:6 with rgbalpha notitle, "
      "'fan.dat' using 1:2 with lines lc rgb '#60000000' lw 0.7 notitle, "
      "'-' using 1:2 with points pt 7 ps 1.4 lc rgb 'black' notitle\n0 {}\ne\nunset multiplot\n",
      experiment::gnuplot_text(std::filesystem::absolute(png).string()), experiment::gnuplot_text(title),
      field.deepest_m, speed_step_mps, field.range_m, std::isfinite(min_dB) ? std::max(min_dB, max_dB - 60) : 0,
      std::max(max_dB, 1.0), field.source_m);
  std::ofstream(scratch.path / "plot.gp") << script;
  if (!experiment::run_gnuplot(scratch.path.string(), "plot.gp", std::chrono::seconds(60), [] { return false; }))
    throw std::runtime_error("gnuplot could not draw " + png);
}

}  // namespace verification
