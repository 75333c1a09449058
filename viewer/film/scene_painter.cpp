// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/scene_painter.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <atomic>

namespace viewer {

namespace {

/// Rows that a thread renders at once: whole tiles.
constexpr int strip_rows = 8;

std::string key_of(const std::optional<sim::WaterLook>& look) {
  if (!look) return "dry";
  std::string key = fmt::format("{} {} {} {}", look->waves_range_m, look->caustics, look->particles_per_m3, look->seed);
  for (const sim::LinearColor* color : {&look->optics.absorption, &look->optics.scattering})
    key += fmt::format(" {} {} {}", (*color)[0], (*color)[1], (*color)[2]);
  return key;
}

std::string key_of(const std::vector<sim::Lamp>& lamps) {
  std::string key;
  for (const sim::Lamp& lamp : lamps) {
    for (const double value : lamp.X_SL.matrix().reshaped()) key += fmt::format(" {}", value);
    key += fmt::format(" {} {} {} {}", lamp.color[0], lamp.color[1], lamp.color[2], lamp.spread);
  }
  return key;
}

}  // namespace

/// Renderers of the views with one lens and one set of options.
struct ScenePainter::Lens {
  std::string key;
  std::unique_ptr<sim::WaterView> water;
  std::vector<std::unique_ptr<sim::Renderer>> renderers;  // of the strips, by turns
};

ScenePainter::ScenePainter(const sim::World& world, int threads)
    : world_(world), threads_(threads), textures_(std::make_shared<sim::TextureLibrary>()) {}

ScenePainter::~ScenePainter() = default;

ScenePainter::Lens& ScenePainter::lens_of(const SceneView& view) {
  constexpr std::size_t max_lenses = 8;
  // A view that zooms has another lens in each image.
  const bool behind_port = view.flat_port && world_.medium().in_water(view.X_WS.translation());
  const std::string key = fmt::format(
      "{} {} {} {} {} {} {} {} {}", view.optics.text(), view.antialias, static_cast<int>(view.options.kind),
      view.options.filter.categories, view.options.filter.exclude_group, view.options.range_max_m, key_of(view.water),
      key_of(view.options.lamps),
      behind_port
          ? fmt::format("{} {} {}", view.flat_port->distance_m, view.flat_port->glass_m, view.flat_port->glass_index)
          : "");
  const auto known = std::find_if(lenses_.begin(), lenses_.end(), [&](const auto& lens) { return lens->key == key; });
  if (known != lenses_.end()) return **known;
  if (lenses_.size() >= max_lenses) lenses_.erase(lenses_.begin());
  // Rays and renderers, one for each thread.
  auto lens = std::make_unique<Lens>();
  lens->key = key;
  sim::RenderOptions options = view.options;
  options.with_depth = options.kind == sim::ImageKind::color;
  options.water = nullptr;
  if (options.with_depth && view.water && world_.medium().has_water()) {
    lens->water = std::make_unique<sim::WaterView>(world_.medium(), options.light, *view.water);
    options.water = lens->water.get();
  }
  const sim::Optics optics(view.optics);
  const auto rays = behind_port ? sim::make_pixel_rays(optics, view.antialias, *view.flat_port)
                                : sim::make_pixel_rays(optics, view.antialias);
  for (int i = 0; i < std::max(1, threads_.threads()); ++i)
    lens->renderers.push_back(std::make_unique<sim::Renderer>(world_.physics(), rays, options, textures_));
  lenses_.push_back(std::move(lens));
  return *lenses_.back();
}

void ScenePainter::render(Lens& lens, const SceneView& view) {
  if (lens.water) lens.water->update(view.X_WS.translation());
  world_.scene().prepare();
  lens.renderers.front()->clear(frame_);
  // Color images are developed at once, while the rows are in the cache.
  const sim::LinearColor color_gain = lens.water && view.follows_daylight
                                          ? sim::LinearColor(view.gain * lens.water->gain())
                                          : sim::LinearColor::Constant(view.gain);
  const int height = view.optics.height;
  const bool is_color = view.options.kind == sim::ImageKind::color;
  if (is_color) rendered_.image = sim::Image8(view.optics.width, height, view.grey ? 1 : 3);
  const auto render_strip = [&](sim::Renderer& renderer, int first) {
    const int end = std::min(first + strip_rows, height);
    renderer.render_rows(view.X_WS, first, end, 1, frame_);
    if (!is_color) return;
    // The smooth colors of water would show steps.
    if (lens.water)
      sim::develop_rows_dithered(frame_.light, color_gain, first, end, rendered_.image);
    else
      sim::develop_rows(frame_.light, view.gain, first, end, rendered_.image);
  };
  if (!world_.scene().concurrent()) {
    for (int row = 0; row < height; row += strip_rows) render_strip(*lens.renderers.front(), row);
    return;
  }
  // Each renderer takes the next strip when it has rendered one, for strips differ in their cost.
  std::atomic<int> next_row = 0;
  threads_.for_each(lens.renderers.size(), [&](std::size_t i) {
    for (int row = next_row.fetch_add(strip_rows); row < height; row = next_row.fetch_add(strip_rows))
      render_strip(*lens.renderers[i], row);
  });
}

RenderedScene& ScenePainter::paint(const SceneView& view) {
  render(lens_of(view), view);
  if (view.options.kind == sim::ImageKind::depth)
    rendered_.image = sim::depth_image(frame_.depth_m);
  else if (view.options.kind != sim::ImageKind::color)
    rendered_.image = sim::label_image(frame_.labels);
  else
    std::swap(rendered_.depth_m, frame_.depth_m);
  return rendered_;
}

}  // namespace viewer
