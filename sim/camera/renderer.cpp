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

/// Thresholds of an ordered dither of 8 x 8 pixels, from -0.5 to 0.5 (Bayer 1973).
std::array<float, 64> bayer_pattern() {
  std::array<float, 64> pattern{};
  for (unsigned row = 0; row < 8; ++row)
    for (unsigned column = 0; column < 8; ++column) {
      unsigned order = 0;
      for (unsigned bit = 0; bit < 3; ++bit) {
        const unsigned x = (column >> bit) & 1, y = (row >> bit) & 1;
        order |= ((2 * (x ^ y)) | y) << (2 * (2 - bit));
      }
      pattern[8 * row + column] = (static_cast<float>(order) + 0.5F) / 64 - 0.5F;
    }
  return pattern;
}

/// Returns the sRGB level of linear light plus a part of a level.
std::uint8_t dithered(float light, float part) {
  const std::uint8_t level = srgb_from_linear(light);
  if (level == 0 || level == 255) return level;
  // Where the light is between the neighboring levels.
  const float here = linear_from_srgb(level), up = linear_from_srgb(static_cast<std::uint8_t>(level + 1));
  const float down = linear_from_srgb(static_cast<std::uint8_t>(level - 1));
  const float off = light > here ? (light - here) / (up - here) : (light - here) / (here - down);
  const float value = off + part;
  return static_cast<std::uint8_t>(level + (value > 0.5F ? 1 : value < -0.5F ? -1 : 0));
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
  std::array<LinearColor, tile_rays> lit;  ///< light of lamps that is reflected
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
  if (options_.kind == ImageKind::normals) empty(frame.vectors, 3, 0.0F);
  if (options_.kind == ImageKind::flow) empty(frame.vectors, 2, 0.0F);
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
  lamps_.clear();
  eye_W_ = X_WS.translation();
  for (const Lamp& lamp : options_.lamps) {
    const Vector3d p_SL_W = X_WS.linear() * lamp.X_SL.translation();
    const Vector3d axis_W = X_WS.linear() * lamp.X_SL.linear().col(0);
    lamps_.push_back({p_SL_W.cast<float>(), axis_W.cast<float>(), lamp.color, lamp.spread});
  }
  // Render rows of tiles, which threads share.
  physics_.scene().prepare();
  const auto render_row = [&](std::size_t i) {
    const int row = first + static_cast<int>(i) * high;
    render_tiles(X_WS, row, std::min(high, end - row), std::max(1, tile_rays / (high * n * n)), weight, frame);
  };
  const auto rows_of_tiles = static_cast<std::size_t>((std::max(end - first, 0) + high - 1) / high);
  if (physics_.scene().concurrent())
    for_each_within(rows_of_tiles, render_row);
  else
    for (std::size_t i = 0; i < rows_of_tiles; ++i) render_row(i);
  if (options_.kind == ImageKind::color && options_.water && options_.water->has_particles() && options_.with_depth)
    options_.water->draw_particles(
        X_WS, *rays_->optics, rays_->refraction, lamps_,
        {frame.light, frame.depth_m, options_.depth_along_ray, first, end, weight,
         rays_->starts_S.empty() ? std::numeric_limits<double>::lowest() : rays_->starts_S.front().x()});
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
    } else if (options_.kind == ImageKind::normals || options_.kind == ImageKind::flow) {
      fill_vectors(tile, X_WS, frame);
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
      if (!rays_->starts_S.empty())
        ray.origin_W += R_WS * rays_->starts_S[static_cast<std::size_t>(&direction_S - rays_->row(0))].cast<double>();
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
  if (!lamps_.empty() || !options_.water) std::fill_n(tile.lit.begin(), tile.seeing, LinearColor::Zero());
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
        light = light_on(tile, i) + tile.lit[static_cast<std::size_t>(i)];
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
  if (lamps_.empty()) return;
  for (std::size_t i = 0; i < count; ++i)
    for (int channel = 0; channel < 3; ++channel) water.lit[channel][i] = tile.lit[i][channel];
  light_lamps(options_.water->water_light(), lamps_, water);
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
        // Depth along the axis counts from the origin of S, range from where the ray begins.
        const double start_m = rays_->starts_S.empty() || options_.depth_along_ray ? 0 : rays_->starts_S.front().x();
        *frame.depth_m.at(u, v) = seen ? static_cast<float>(tile.hits[i].range_m * factor + start_m) : nothing_seen_m;
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
  if (!lamps_.empty()) tile.lit[static_cast<std::size_t>(number)] = lamp_light(own, normal, p_W - eye_W_);
  // Add diffuse light of the sun and the highlight (Blinn 1977).
  if (!sky_.sun_is_up() || tile.in_shadow[number] != 0 || toward <= 0) return light;
  const LinearColor diffuse = own.cwiseProduct(sky_.sun()) * toward;
  light += options_.water && options_.water->has_caustics() ? diffuse * options_.water->caustic(p_W) : diffuse;
  if (paint.gloss > 0) {
    const Eigen::Vector3f half = (sky_.to_sun_W() - direction).normalized();
    light += sky_.sun() * (paint.gloss * raised_to_64(std::max(0.0F, normal.dot(half))));
  }
  return light;
}

LinearColor Renderer::lamp_light(const LinearColor& albedo, const Eigen::Vector3f& normal_W,
                                 const Vector3d& to_hit_W) const {
  // In air nothing is absorbed.
  static const WaterLight dry;
  const WaterLight& water = options_.water && options_.water->is_under() ? options_.water->water_light() : dry;
  const Eigen::Vector3f p_W = to_hit_W.cast<float>();
  LinearColor sum = LinearColor::Zero();
  for (const LampLight& lamp : lamps_) {
    const Eigen::Vector3f to_lamp_W = lamp.position_W - p_W;
    const float distance_m = to_lamp_W.norm(), toward = normal_W.dot(to_lamp_W);
    if (toward <= 0 || distance_m <= 0) continue;
    sum += lamp_light_at(water, lamp, p_W) * (toward / distance_m);
  }
  return albedo.cwiseProduct(sum);
}

Vector2d Renderer::flow(const Tile& tile, int number, const Pose& X_WS) const {
  const RayHit& hit = tile.hits[number];
  const Ray& ray = tile.rays[number];
  // Motion of the point relative to the camera, seen in its axes.  Where nothing is hit only the camera turns.
  const Vector3d p_SP_W = hit.hit() ? Vector3d(hit.range_m * ray.direction_W) : ray.direction_W;
  Vector3d v_SP_W = -motion_.w_WS_W.cross(p_SP_W);
  if (hit.hit()) {
    const int body_number = physics_.parts()[static_cast<std::size_t>(hit.part)].body;
    const Body& body = *physics_.bodies()[static_cast<std::size_t>(body_number)];
    v_SP_W -= motion_.v_WS_W;
    if (!body.fixed())
      v_SP_W += body.v_WB_W() + body.w_WB_W().cross(X_WS.translation() + p_SP_W - body.X_WB().translation());
  }
  const Matrix3d R_SW = X_WS.linear().transpose();
  const Vector3d p_S = R_SW * p_SP_W, v_S = R_SW * v_SP_W;
  // Central difference over a millionth of the distance.
  const double speed_mps = v_S.norm();
  if (speed_mps == 0) return Vector2d::Zero();
  const double half_s = 1e-6 * p_S.norm() / speed_mps;
  const auto before = rays_->optics->project(p_S - half_s * v_S), after = rays_->optics->project(p_S + half_s * v_S);
  return before && after ? Vector2d((*after - *before) / (2 * half_s)) : Vector2d::Zero();
}

void Renderer::fill_vectors(const Tile& tile, const Pose& X_WS, Frame& frame) const {
  const Matrix3d R_SW = X_WS.linear().transpose();
  const int n = rays_->per_side;
  int place = 0;
  for (int row = 0; row < tile.rows; ++row)
    for (int column = 0; column < tile.columns; ++column, ++place) {
      const int i = tile.number[place];
      if (i < 0) continue;
      float* values = frame.vectors.at((tile.column + column) / n, (tile.row + row) / n);
      if (options_.kind == ImageKind::flow) {
        const Vector2d flow_pxps = flow(tile, i, X_WS);
        for (int axis = 0; axis < 2; ++axis) values[axis] = static_cast<float>(flow_pxps[axis]);
      } else if (tile.hits[i].hit()) {
        const Vector3d normal_S = R_SW * tile.hits[i].normal_W;
        for (int axis = 0; axis < 3; ++axis) values[axis] = static_cast<float>(normal_S[axis]);
      }
    }
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

Image8 develop(const FloatImage& light, const LinearColor& gain) {
  Image8 image(light.width, light.height, light.channels);
  const float grey = luminance(gain.data());
  for (std::size_t i = 0; i < light.data.size(); ++i)
    image.data[i] =
        srgb_from_linear((light.channels == 3 ? gain[static_cast<Eigen::Index>(i % 3)] : grey) * light.data[i]);
  return image;
}

void develop_rows_dithered(const FloatImage& light, const LinearColor& gain, int first, int end, Image8& image) {
  static const std::array<float, 64> pattern = bayer_pattern();
  for (int row = first; row < end; ++row)
    for (int column = 0; column < light.width; ++column) {
      const float* from = light.at(column, row);
      const float rgb[3] = {gain[0] * from[0], gain[1] * from[1], gain[2] * from[2]};
      const float threshold = pattern[static_cast<std::size_t>(8 * (row % 8) + column % 8)];
      std::uint8_t* to = image.at(column, row);
      if (image.channels == 1) to[0] = dithered(luminance(rgb), threshold);
      for (int i = 0; i < image.channels && image.channels == 3; ++i) to[i] = dithered(rgb[i], threshold);
    }
}

float auto_gain(const FloatImage& light, float max_gain) {
  // Sum in double precision to limit the rounding error.
  double sum = 0;
  const std::size_t pixels = light.data.size() / 3;
  for (std::size_t i = 0; i < pixels; ++i) sum += std::min(1.0F, luminance(light.data.data() + 3 * i));
  const double mean = pixels > 0 ? sum / static_cast<double>(pixels) : 0;
  return static_cast<float>(std::clamp(0.18 / std::max(mean, 1e-6), 1.0 / 64, static_cast<double>(max_gain)));
}

namespace {

std::array<double, 3> sums_of(const FloatImage& light) {
  std::array<double, 3> sums{};
  for (std::size_t i = 0; i + 2 < light.data.size(); i += 3)
    for (std::size_t channel = 0; channel < 3; ++channel) sums[channel] += light.data[i + channel];
  return sums;
}

}  // namespace

float brightest_mean(const FloatImage& light) {
  const auto sums = sums_of(light);
  return static_cast<float>(3 * *std::max_element(sums.begin(), sums.end()) /
                            static_cast<double>(std::max<std::size_t>(1, light.data.size())));
}

LinearColor gray_world_gains(const FloatImage& light) {
  const auto sums = sums_of(light);
  const double brightest = std::max({sums[0], sums[1], sums[2]});
  if (!(brightest > 0)) return LinearColor::Ones();
  float means[3];
  LinearColor gains;
  for (int i = 0; i < 3; ++i) {
    means[i] = static_cast<float>(sums[static_cast<std::size_t>(i)] / brightest);
    gains[i] = 1 / std::max(means[i], 1.0F / 64);
  }
  const float balanced[3] = {gains[0] * means[0], gains[1] * means[1], gains[2] * means[2]};
  return gains * (luminance(means) / luminance(balanced));
}

FloatImage grey_of(const FloatImage& light) {
  FloatImage grey(light.width, light.height, 1);
  for (std::size_t i = 0; i < grey.data.size(); ++i) grey.data[i] = luminance(light.data.data() + 3 * i);
  return grey;
}

}  // namespace sim
