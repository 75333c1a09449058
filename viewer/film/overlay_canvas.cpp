// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/overlay_canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace viewer {
namespace {

constexpr double nearest_m = 0.02;  ///< lines closer to the camera are cut off
constexpr double widest = 100;      ///< tangent of the largest angle from its axis that a line is drawn at

/// Cuts off the part of a line where `normal` . p < `min`; false: that is all of it.
bool cut(sim::Vector3d& from, sim::Vector3d& to, const sim::Vector3d& normal, double min) {
  const double from_m = normal.dot(from) - min, to_m = normal.dot(to) - min;
  if (from_m < 0 && to_m < 0) return false;
  const sim::Vector3d edge = from + from_m / (from_m - to_m) * (to - from);
  if (from_m < 0) from = edge;
  if (to_m < 0) to = edge;
  return true;
}

}  // namespace

OverlayCanvas::OverlayCanvas(RenderedScene& rendered, const SceneView& view)
    : image_(rendered.image),
      depth_m_(rendered.depth_m),
      optics_(view.optics),
      X_SW_(view.X_WS.inverse()),
      straight_(view.optics.lens == sim::OpticsConfig::Lens::pinhole && view.optics.distortion.empty()),
      unit_px_(std::max(1.25F, static_cast<float>(view.optics.height) / 320.0F)) {}

OverlayCanvas::Place OverlayCanvas::place_of(const sim::Vector2d& pixel, double depth_m) const {
  return {static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), static_cast<float>(1 / depth_m)};
}

std::optional<OverlayCanvas::Place> OverlayCanvas::project(const sim::Vector3d& p_S) const {
  if (p_S.x() < nearest_m) return std::nullopt;
  const auto pixel = optics_.project(p_S);
  // Far outside of the image the numbers of pixels mean nothing, and a line would take long.
  if (!pixel || !(pixel->norm() < 1e6)) return std::nullopt;
  return place_of(*pixel, p_S.x());
}

std::optional<sim::Vector2d> OverlayCanvas::pixel(const sim::Vector3d& p_W) const {
  const auto place = project(X_SW_ * p_W);
  if (!place) return std::nullopt;
  return sim::Vector2d(static_cast<double>(place->u), static_cast<double>(place->v));
}

void OverlayCanvas::line(const sim::Vector3d& from_W, const sim::Vector3d& to_W, const Pen& pen) {
  sim::Vector3d from_S = X_SW_ * from_W, to_S = X_SW_ * to_W;
  if (!cut(from_S, to_S, sim::Vector3d::UnitX(), 1.001 * nearest_m)) return;
  // A line that passes beside the camera would end at infinity.
  for (const sim::Vector3d& side : {sim::Vector3d(widest, 1, 0), sim::Vector3d(widest, -1, 0),
                                    sim::Vector3d(widest, 0, 1), sim::Vector3d(widest, 0, -1)}) {
    if (straight_ && !cut(from_S, to_S, side, 0)) return;
  }
  // A lens with distortion bends lines.
  const int pieces = straight_ ? 1 : 12;
  auto last = project(from_S);
  for (int i = 1; i <= pieces; ++i) {
    const auto next = project(from_S + static_cast<double>(i) / pieces * (to_S - from_S));
    if (last && next) segment(*last, *next, pen, true);
    last = next;
  }
}

void OverlayCanvas::polyline(std::span<const sim::Vector3d> points_W, const Pen& pen) {
  for (std::size_t i = 1; i < points_W.size(); ++i) line(points_W[i - 1], points_W[i], pen);
}

void OverlayCanvas::ellipse(const sim::Vector3d& center_W, const sim::Vector3d& axis_W,
                            const sim::Vector3d& other_axis_W, const Pen& pen) {
  constexpr int corners = 72;
  std::vector<sim::Vector3d> points_W;
  for (int i = 0; i <= corners; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / corners;
    points_W.push_back(center_W + std::cos(angle_rad) * axis_W + std::sin(angle_rad) * other_axis_W);
  }
  polyline(points_W, pen);
}

void OverlayCanvas::dot(const sim::Vector3d& p_W, const Pen& pen) {
  if (const auto place = project(X_SW_ * p_W)) segment(*place, *place, pen, true);
}

float OverlayCanvas::text_width(const std::string& text) const {
  return text.empty() ? 0 : unit_px_ * (character_width * static_cast<float>(text.size()) - 1.8F);
}

void OverlayCanvas::label(const sim::Vector3d& p_W, const std::string& text, const Pen& pen) {
  const auto place = project(X_SW_ * p_W);
  if (!place) return;
  Pen own = pen;
  const int column = static_cast<int>(place->u), row = static_cast<int>(place->v);
  if (is_hidden(column, row, place->inverse_depth)) own.opacity *= 0.6F;
  LabelPlace own_place{place->u - 0.5F * text_width(text), place->v - 4 * unit_px_, text_width(text)};
  // Each round moves it upwards, so it ends above the highest label at the latest.
  const float line_px = text_height() + 3 * unit_px_;
  const auto covers = [&](const LabelPlace& other) {
    return std::abs(own_place.v - other.v) < line_px && own_place.u < other.u + other.width &&
           other.u < own_place.u + own_place.width;
  };
  for (auto other = std::ranges::find_if(labels_, covers); other != labels_.end();
       other = std::ranges::find_if(labels_, covers))
    own_place.v = other->v - line_px;
  labels_.push_back(own_place);
  this->text(own_place.u, own_place.v, text, own);
}

void OverlayCanvas::text(float u, float v, const std::string& text, const Pen& pen) {
  // A dark edge, so that it can be read on any ground.
  Pen edge = pen;
  edge.color = {0, 0, 0};
  edge.opacity = 0.45F * pen.opacity;
  edge.width_px = 2.6F * unit_px_;
  strokes(u, v, text, edge);
  Pen own = pen;
  own.width_px = std::max(1.0F, 0.85F * unit_px_);
  strokes(u, v, text, own);
}

void OverlayCanvas::strokes(float u, float v, const std::string& text, const Pen& pen) {
  constexpr float base_line = 2;
  for (const char character : text) {
    const std::string_view points = strokes_of(character);
    std::optional<Place> last;
    for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
      if (points[i] == ' ') {
        last.reset();
        ++i;
      }
      const Place next{u + unit_px_ * static_cast<float>(points[i] - '0'),
                       v - unit_px_ * (static_cast<float>(points[i + 1] - '0') - base_line), 1};
      if (last) segment(*last, next, pen, false);
      last = next;
    }
    u += unit_px_ * character_width;
  }
}

bool OverlayCanvas::is_hidden(int column, int row, float inverse_depth) const {
  if (column < 0 || row < 0 || column >= depth_m_.width || row >= depth_m_.height) return false;
  // Tolerance: what lies on a surface is seen.
  const float in_front_m = *depth_m_.at(column, row);
  return in_front_m * inverse_depth < 0.98F && 1 / inverse_depth - in_front_m > 0.05F;
}

void OverlayCanvas::blend(int column, int row, float opacity, const Pen& pen) {
  std::uint8_t* pixel = image_.at(column, row);
  for (int channel = 0; channel < std::min(image_.channels, 3); ++channel) {
    const float before = pixel[channel];
    pixel[channel] = static_cast<std::uint8_t>(
        std::lround(before + opacity * (static_cast<float>(pen.color[static_cast<std::size_t>(channel)]) - before)));
  }
}

void OverlayCanvas::segment(const Place& from, const Place& to, const Pen& pen, bool tested) {
  // Rows, or columns of a flat line, in which it lies within the image.
  const float half = 0.5F * pen.width_px;
  const bool flat = std::abs(to.u - from.u) >= std::abs(to.v - from.v);
  const float length = std::hypot(to.u - from.u, to.v - from.v);
  const auto along = [flat](const Place& place) { return flat ? place.u : place.v; };
  const int count = flat ? image_.width : image_.height, across_count = flat ? image_.height : image_.width;
  const float low = std::min(along(from), along(to)) - half - 1, high = std::max(along(from), along(to)) + half + 1;
  const int first = static_cast<int>(std::clamp(low, 0.0F, static_cast<float>(count)));
  const int last = static_cast<int>(std::clamp(high, -1.0F, static_cast<float>(count - 1)));
  for (int i = first; i <= last; ++i) {
    const float center = static_cast<float>(i) + 0.5F;
    const float extent = along(to) - along(from);
    const float share = std::abs(extent) < 1e-3F ? 0.5F : std::clamp((center - along(from)) / extent, 0.0F, 1.0F);
    const float across = flat ? from.v + share * (to.v - from.v) : from.u + share * (to.u - from.u);
    const float reach = 1.5F * half + 1.5F;
    if (!(across > -reach && across < static_cast<float>(across_count) + reach)) continue;
    const int start = std::max(0, static_cast<int>(across - reach));
    const int end = std::min(across_count - 1, static_cast<int>(across + reach));
    for (int j = start; j <= end; ++j) {
      // Share of the pixel that the line covers, by the distance of its center from the line.
      const float u = flat ? center : static_cast<float>(j) + 0.5F, v = flat ? static_cast<float>(j) + 0.5F : center;
      float at = 0;
      if (length > 1e-3F)
        at = std::clamp(((u - from.u) * (to.u - from.u) + (v - from.v) * (to.v - from.v)) / (length * length), 0.0F,
                        1.0F);
      const float away = std::hypot(u - from.u - at * (to.u - from.u), v - from.v - at * (to.v - from.v));
      const float covered = std::clamp(half + 0.5F - away, 0.0F, 1.0F);
      if (covered <= 0) continue;
      const int column = flat ? i : j, row = flat ? j : i;
      const float inverse_depth = from.inverse_depth + at * (to.inverse_depth - from.inverse_depth);
      const bool hidden = tested && is_hidden(column, row, inverse_depth);
      blend(column, row, covered * pen.opacity * (hidden ? pen.hidden_opacity : 1.0F), pen);
    }
  }
}

namespace {

constexpr std::array<std::string_view, 95> strokes{
    // Space to /
    "", "2824 2222", "1816 3836", "1218 3238 0444 0646", "473818070615354443321203 2921", "0248 0818170708 3343423233",
    "4207182837150403122244", "2826", "38262432", "18262412", "2723 0644 0446", "2723 0545", "232211", "0545", "2222",
    "0248",
    // 0 to @
    "183847433212030718 1337", "172822 1232", "07183847460242", "0718384746354443321203 1535", "380444 3832",
    "480805354443321203", "473818070312324344351504", "084812", "15060718384746351504031232434435",
    "031232434738180706153546", "2626 2323", "2626 232211", "370533", "0646 0444", "173513", "071838474624 2222",
    "3336161434 334347381807031242",
    // A to Z
    "022842 1434", "02083847463505 3544433202", "4738180703123243", "02082846442202", "48080242 0535", "480802 0535",
    "47381807031232434525", "0208 4248 0545", "1838 2822 1232", "4843321203", "0208 480542", "080242", "0208254842",
    "02084248", "183847433212030718", "02083847463505", "183847433212030718 2442", "02083847463505 2542",
    "473818070615354443321203", "0848 2822", "080312324348", "082248", "0812263248", "0248 0842", "082548 2522",
    "08480242",
    // [ to `
    "38282232", "0842", "18282212", "162836", "0141", "1827",
    // a to z
    "16364542 441403123243", "0802 0516364543321203", "4536160503123243", "4842 4536160503123243",
    "04444536160503123243", "38282722 1636", "4641301001 4536160504133344", "0802 0516364542", "2622 2828",
    "36312010 3838", "0802 360442", "2822", "0206 05162522 25364542", "0206 0516364542", "163645433212030516",
    "0600 0516364543321203", "4640 4536160503123243", "0206 051636", "45361605143443321203", "28233242 1646",
    "0603123243 4642", "062246", "0612253246", "0246 0642", "0603123243 4641301001", "06460242",
    // { to ~
    "38272615242332", "2820", "18272635242312", "05163445"};

}  // namespace

std::string_view strokes_of(char character) {
  const auto code = static_cast<unsigned char>(character);
  return code >= 32 && code < 127 ? strokes[code - std::size_t{32}] : strokes['?' - 32];
}

}  // namespace viewer
