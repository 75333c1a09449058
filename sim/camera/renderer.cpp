// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/renderer.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "sim/base/thread_pool.hpp"
#include "sim/camera/water_view.hpp"

namespace sim {

namespace {

/// Rays per tile.  They have nearly the same direction, so that the scene can trace them as packets.
constexpr int tile_rays = WaterRays::size;
constexpr double shadow_range_m = 10'000;
constexpr float nothing_seen_m = std::numeric_limits<float>::infinity();

/// Default colors: of fixed parts, of the ground, and of moving parts by group number.
const Color fixed_color = {178, 170, 156};
const Color ground_color = {196, 198, 196};
const Color group_colors[] = {{70, 120, 190},  {214, 106, 62}, {92, 156, 88},  {190, 74, 96},
                              {134, 102, 176}, {58, 150, 158}, {210, 170, 70}, {124, 112, 100}};

float raised_to_64(float x) {
  for (int i = 0; i < 6; ++i) x *= x;
  return x;
}

/// Returns the share of a footprint around x that is covered by lines of width 0.02 at the whole numbers.
float line_share(double x, float footprint) {
  constexpr float width = 0.02F;
  // Round to the nearest whole number by adding and subtracting 1.5 * 2^52, which is faster than std::round.
  constexpr double large = 0x1.8p52;
  const double nearest = (x + large) - large;
  const auto off = static_cast<float>(std::abs(x - nearest));
  const float seen = std::max(footprint, 0.25F * width);
  const float covered = std::clamp((0.5F * (width + seen) - off) / seen, 0.0F, std::min(1.0F, width / seen));
  return covered;
}

}  // namespace

struct Renderer::Tile {
  int column = 0, row = 0;    ///< position of the first ray, in rays
  int columns = 0, rows = 0;  ///< size in rays
  int seeing = 0;             ///< number of rays within the field of view
  std::array<Ray, tile_rays> rays;
  std::array<RayHit, tile_rays> hits;
  std::array<int, tile_rays> number;  ///< index in `rays` of each position in the tile; -1: outside the field of view
  std::array<float, tile_rays> along_axis;
  std::array<Ray, tile_rays> shadow_rays;
  std::array<int, tile_rays> shadow_of;  ///< index in `rays`
  std::array<std::uint8_t, tile_rays> blocked, in_shadow;
  WaterRays water;
  // Last ones used, kept from tile to tile.
  Paint paint;
  PosedPart posed;
};

Renderer::Renderer(const PhysicsWorld& physics, std::shared_ptr<const PixelRays> rays, const RenderOptions& options,
                   std::shared_ptr<TextureLibrary> textures)
    : physics_(physics),
      rays_(std::move(rays)),
      options_(options),
      textures_(std::move(textures)),
      sky_(options.light),
      to_sun_W_(options.light.to_sun_W()),
      sky_strength_(static_cast<float>(options.light.sky)) {
  // Only color images need surfaces, and their textures may be large.
  if (options_.kind != ImageKind::color) return;
  for (int i = 0; i < physics_.materials(); ++i) surfaces_.push_back(make_surface(i, true));
}

Renderer::Surface Renderer::make_surface(int material, bool strict) const {
  const MaterialConfig& config = physics_.material(material);
  Surface surface;
  if (const auto color = parse_color(config.color)) {
    surface.has_color = true;
    surface.color = linear_color(*color);
  }
  surface.gloss = static_cast<float>(config.gloss);
  try {
    surface.texture = textures_->get(config.texture, "material '" + config.name + "'");
  } catch (const ConfigError&) {
    if (strict) throw;
  }
  return surface;
}

void Renderer::add_surfaces() {
  if (options_.kind != ImageKind::color) return;
  for (int i = static_cast<int>(surfaces_.size()); i < physics_.materials(); ++i)
    surfaces_.push_back(make_surface(i, false));
}

void Renderer::clear(Frame& frame) const {
  const auto empty = [this](auto& image, int channels, auto value) {
    image.width = rays_->width, image.height = rays_->height, image.channels = channels;
    image.data.assign(image.size(), value);
  };
  if (options_.kind == ImageKind::color) empty(frame.light, 3, 0.0F);
  if (options_.kind == ImageKind::depth || (options_.kind == ImageKind::color && options_.with_depth))
    empty(frame.depth_m, 1, nothing_seen_m);
  if (options_.kind == ImageKind::parts || options_.kind == ImageKind::groups) empty(frame.labels, 1, std::uint16_t{0});
}

void Renderer::render(const Pose& X_WS, Frame& frame) {
  clear(frame);
  render_rows(X_WS, 0, rays_->height, 1, frame);
}

void Renderer::render_rows(const Pose& X_WS, int first, int end, float weight, Frame& frame) {
  // Choose the shape of tiles: whole pixels, nearly square; wide and flat when a single row is rendered.
  const int n = rays_->per_side;
  int high = 1;
  while (2 * high * n <= 8 && 2 * high <= end - first) high *= 2;
  add_surfaces();
  // Render rows of tiles, which threads share.
  physics_.scene().prepare();
  const auto render_row = [&](std::size_t i) {
    const int row = first + static_cast<int>(i) * high;
    render_tiles(X_WS, row, std::min(high, end - row), std::max(1, tile_rays / (high * n * n)), weight, frame);
  };
  const auto rows_of_tiles = static_cast<std::size_t>((std::max(end - first, 0) + high - 1) / high);
  if (physics_.scene().concurrent()) return for_each_within(rows_of_tiles, render_row);
  for (std::size_t i = 0; i < rows_of_tiles; ++i) render_row(i);
}

void Renderer::render_tiles(const Pose& X_WS, int row, int high, int wide, float weight, Frame& frame) const {
  const int n = rays_->per_side;
  Tile tile;
  for (int column = 0; column < rays_->width; column += wide) {
    tile.column = column * n, tile.row = row * n;
    tile.columns = std::min(wide, rays_->width - column) * n;
    tile.rows = high * n;
    gather(tile, X_WS);
    cast(tile);
    if (options_.kind == ImageKind::color) {
      find_shadows(tile);
      fill_light(tile, weight, frame);
      if (options_.with_depth) fill_values(tile, frame);
    } else {
      fill_values(tile, frame);
    }
  }
}

void Renderer::gather(Tile& tile, const Pose& X_WS) const {
  const Matrix3d R_WS = X_WS.linear();
  tile.seeing = 0;
  int place = 0;
  for (int row = 0; row < tile.rows; ++row) {
    const Eigen::Vector3f* directions_S = rays_->row(tile.row + row) + tile.column;
    for (int column = 0; column < tile.columns; ++column, ++place) {
      const Eigen::Vector3f& direction_S = directions_S[column];
      tile.number[place] = -1;
      // A zero direction marks a pixel outside of the lens.
      if (direction_S.isZero(0)) continue;
      Ray& ray = tile.rays[tile.seeing];
      ray.origin_W = X_WS.translation();
      ray.direction_W = R_WS * direction_S.cast<double>();
      ray.range_max_m = options_.range_max_m;
      tile.along_axis[tile.seeing] = direction_S.x();
      tile.number[place] = tile.seeing++;
    }
  }
}

void Renderer::cast(Tile& tile) const {
  const auto count = static_cast<std::size_t>(tile.seeing);
  physics_.scene().cast(std::span(tile.rays).first(count), options_.filter, std::span(tile.hits).first(count));
}

void Renderer::find_shadows(Tile& tile) const {
  std::fill_n(tile.in_shadow.begin(), tile.seeing, std::uint8_t{0});
  if (!sky_.sun_is_up() || !options_.light.shadows) return;
  std::size_t count = 0;
  for (int i = 0; i < tile.seeing; ++i) {
    const RayHit& hit = tile.hits[i];
    if (!hit.hit() || hit.normal_W.dot(to_sun_W_) <= 0) continue;
    // Offset the origin from the surface by more than the rounding error, to avoid self-shadowing.
    const double off_m = 1e-3 + 1e-5 * hit.range_m;
    Ray& ray = tile.shadow_rays[count];
    ray.origin_W = tile.rays[i].origin_W + hit.range_m * tile.rays[i].direction_W + off_m * hit.normal_W;
    ray.direction_W = to_sun_W_;
    ray.range_max_m = shadow_range_m;
    tile.shadow_of[count++] = i;
  }
  // Parts that the camera filters out, such as its own vehicle, still cast shadows.
  const RayFilter filter{~0u, -1, RayKind::light};
  physics_.scene().find_blocked(std::span(tile.shadow_rays).first(count), filter, std::span(tile.blocked).first(count));
  for (std::size_t i = 0; i < count; ++i) tile.in_shadow[tile.shadow_of[i]] = tile.blocked[i];
}

void Renderer::fill_light(Tile& tile, float weight, Frame& frame) const {
  const int n = rays_->per_side;
  const float share = weight / static_cast<float>(n * n);
  if (options_.water) light_water(tile);
  int place = 0;
  for (int row = 0; row < tile.rows; ++row)
    for (int column = 0; column < tile.columns; ++column, ++place) {
      const int i = tile.number[place];
      if (i < 0) continue;
      LinearColor light;
      if (options_.water)
        light = {tile.water.light[0][i], tile.water.light[1][i], tile.water.light[2][i]};
      else
        light = light_on(tile, i);
      float* rgb = frame.light.at((tile.column + column) / n, (tile.row + row) / n);
      for (int channel = 0; channel < 3; ++channel) rgb[channel] += share * light[channel];
    }
}

LinearColor Renderer::light_on(Tile& tile, int ray) const {
  const RayHit& hit = tile.hits[ray];
  if (!hit.hit()) return sky_.from(tile.rays[ray].direction_W.cast<float>());
  return shade(tile, ray, rays_->pixel_angle * static_cast<float>(hit.range_m));
}

void Renderer::light_water(Tile& tile) const {
  WaterRays& water = tile.water;
  const auto count = static_cast<std::size_t>(tile.seeing);
  for (std::size_t i = 0; i < count; ++i) water.range_m[i] = static_cast<float>(tile.hits[i].range_m);
  options_.water->find_surface(std::span(tile.rays).first(count), water);
  for (std::size_t i = 0; i < count; ++i) {
    // The light of the sky through or from the surface is that of the water.
    LinearColor light = LinearColor::Zero();
    if (tile.hits[i].hit() || !(water.crossing_m[i] < water.range_m[i])) light = light_on(tile, static_cast<int>(i));
    for (int channel = 0; channel < 3; ++channel) water.light[channel][i] = light[channel];
  }
  options_.water->light(water);
}

void Renderer::fill_values(const Tile& tile, Frame& frame) const {
  const int n = rays_->per_side;
  int place = 0;
  for (int row = 0; row < tile.rows; ++row)
    for (int column = 0; column < tile.columns; ++column, ++place) {
      const int i = tile.number[place];
      const int u = (tile.column + column) / n, v = (tile.row + row) / n;
      const bool seen = i >= 0 && tile.hits[i].hit();
      if (options_.kind == ImageKind::depth || options_.kind == ImageKind::color) {
        const double factor = seen && !options_.depth_along_ray ? static_cast<double>(tile.along_axis[i]) : 1.0;
        *frame.depth_m.at(u, v) = seen ? static_cast<float>(tile.hits[i].range_m * factor) : nothing_seen_m;
        continue;
      }
      int label = 0;
      if (seen && options_.kind == ImageKind::parts) label = tile.hits[i].part + 1;
      if (seen && options_.kind == ImageKind::groups) label = physics_.parts()[tile.hits[i].part].group + 1;
      *frame.labels.at(u, v) = static_cast<std::uint16_t>(std::min(label, 65535));
    }
}

const Pose& Renderer::X_PW(Tile& tile, int part) const {
  if (tile.posed.part != part) tile.posed = {part, physics_.X_WP(part).inverse()};
  return tile.posed.X_PW;
}

const Renderer::Paint& Renderer::paint(Tile& tile, int part_number, int material_number) const {
  Paint& found = tile.paint;
  if (found.part == part_number && found.material == material_number) return found;
  const PartInfo& part = physics_.parts()[static_cast<std::size_t>(part_number)];
  const Surface& material = surfaces_[static_cast<std::size_t>(material_number)];
  found = {part_number, material_number, material.gloss, nullptr, false, material.color};
  // Vehicles without colors get one each, so that they can be distinguished; fixed objects look like ground.
  const bool fixed = physics_.bodies()[static_cast<std::size_t>(part.body)]->fixed();
  if (part.color) {
    found.color = linear_color(*part.color);
  } else if (material.texture) {
    found.texture = material.texture.get();
  } else if (!material.has_color && !fixed) {
    found.color = linear_color(group_colors[static_cast<std::size_t>(part.group) % std::size(group_colors)]);
  } else if (!material.has_color) {
    found.grid = part.plane;
    found.color = linear_color(part.plane ? ground_color : fixed_color);
  }
  return found;
}

LinearColor Renderer::albedo(Tile& tile, const Paint& paint, const RayHit& hit, const Vector3d& p_W,
                             float footprint_m) const {
  if (!paint.grid && paint.texture == nullptr) return paint.color;
  const Pose& X_PW = this->X_PW(tile, hit.part);
  const Vector3d p_P = X_PW * p_W;
  if (paint.texture != nullptr) return paint.texture->color(p_P, X_PW.linear() * hit.normal_W, footprint_m);
  // Planes show a grid of 1 m as a scale for distances.
  const float line = std::max(line_share(p_P.x(), footprint_m), line_share(p_P.y(), footprint_m));
  return paint.color * (1 - 0.35F * line);
}

LinearColor Renderer::shade(Tile& tile, int number, float footprint_m) const {
  const RayHit& hit = tile.hits[number];
  const Ray& ray = tile.rays[number];
  const Vector3d p_W = ray.origin_W + hit.range_m * ray.direction_W;
  const Eigen::Vector3f normal = hit.normal_W.cast<float>(), direction = ray.direction_W.cast<float>();
  // Footprint at grazing incidence: geometric mean of its two extents, a compromise between sharpness and aliasing.
  const float slant = std::max(0.05F, -normal.dot(direction));
  const Paint& paint = this->paint(tile, hit.part, hit.material);
  const LinearColor own = albedo(tile, paint, hit, p_W, footprint_m / std::sqrt(slant));
  // Ambient light by the share of the hemisphere that is sky; the ground reflects less.
  const float open = 0.5F * (1 + normal.z());
  LinearColor light = own * (sky_strength_ * (0.45F + 0.55F * open));
  const float toward = normal.dot(sky_.to_sun_W());
  // Add diffuse light of the sun and the highlight (Blinn 1977).
  if (!sky_.sun_is_up() || tile.in_shadow[number] != 0 || toward <= 0) return light;
  light += own.cwiseProduct(sky_.sun()) * toward;
  if (paint.gloss > 0) {
    const Eigen::Vector3f half = (sky_.to_sun_W() - direction).normalized();
    light += sky_.sun() * (paint.gloss * raised_to_64(std::max(0.0F, normal.dot(half))));
  }
  return light;
}

std::string Renderer::label_name(const PhysicsWorld& physics, ImageKind kind, std::uint16_t label) {
  if (label == 0) return "nothing";
  const std::size_t number = label - 1U;
  if (kind == ImageKind::groups) return physics.group_name(static_cast<int>(number));
  if (number >= physics.parts().size() || physics.parts()[number].group < 0) return "gone";
  return physics.parts()[number].name;
}

Image8 develop(const FloatImage& light, float gain) {
  Image8 image(light.width, light.height, light.channels);
  develop_rows(light, gain, 0, light.height, image);
  return image;
}

void develop_rows(const FloatImage& light, float gain, int first, int end, Image8& image) {
  const auto width = static_cast<std::size_t>(light.width);
  for (int row = first; row < end; ++row) {
    const float* from = light.data.data() + static_cast<std::size_t>(row) * width * light.channels;
    std::uint8_t* to = image.data.data() + static_cast<std::size_t>(row) * width * image.channels;
    if (light.channels == image.channels)
      for (std::size_t i = 0; i < width * light.channels; ++i) to[i] = srgb_from_linear(gain * from[i]);
    else
      for (std::size_t i = 0; i < width; ++i) to[i] = srgb_from_linear(gain * luminance(from + 3 * i));
  }
}

float auto_gain(const FloatImage& light) {
  // Sum in double precision to limit the rounding error.
  double sum = 0;
  const std::size_t pixels = light.data.size() / 3;
  for (std::size_t i = 0; i < pixels; ++i) sum += std::min(1.0F, luminance(light.data.data() + 3 * i));
  const double mean = pixels > 0 ? sum / static_cast<double>(pixels) : 0;
  return static_cast<float>(std::clamp(0.18 / std::max(mean, 1e-6), 1.0 / 64, 64.0));
}

FloatImage grey_of(const FloatImage& light) {
  FloatImage grey(light.width, light.height, 1);
  for (std::size_t i = 0; i < grey.data.size(); ++i) grey.data[i] = luminance(light.data.data() + 3 * i);
  return grey;
}

}  // namespace sim
