// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/camera/lamp.hpp"
#include "sim/camera/optics.hpp"
#include "sim/camera/sky_light.hpp"
#include "sim/camera/texture.hpp"
#include "sim/camera/water_light.hpp"
#include "sim/image/image.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/scene/light.hpp"

namespace sim {

class WaterView;

/// Quantity stored in the pixels of an image.
enum class ImageKind { color, depth, parts, groups, normals, flow };

/// Options of a renderer.
struct RenderOptions {
  ImageKind kind = ImageKind::color;
  /// Selects the parts in the image.  Parts of transparent materials are always invisible.
  RayFilter filter{~0u, -1, RayKind::light};
  double range_max_m = 10'000;   ///< along the ray; parts beyond it are invisible
  bool depth_along_ray = false;  ///< true: depth is the range; false: distance along the optical axis (x of S)
  LightConfig light;
  const WaterView* water = nullptr;  ///< water in color images; null: it is invisible.  Must outlive the renderer
  bool with_depth = false;           ///< color images have depth, too
  std::vector<Lamp> lamps;           ///< light of color images, without shadows
};

/// Velocity of the camera, for optical flow.
struct CameraMotion {
  Vector3d v_WS_W = Vector3d::Zero();  ///< m/s
  Vector3d w_WS_W = Vector3d::Zero();  ///< rad/s
};

/// Image being rendered.  Depending on the kind of the image one member is filled and the others stay empty: `light`
/// holds linear RGB, `depth_m` depth (infinity: no hit), `labels` a segmentation (see Renderer::label_name), `vectors`
/// normals or optical flow.  Normals are unit vectors x, y, z in S, zero without a hit.  Optical flow is the velocity
/// of what a pixel sees in the image, to the right and downwards, px/s; where nothing is hit, that of the horizon.
struct Frame {
  FloatImage light;
  FloatImage depth_m;
  Image16 labels;
  FloatImage vectors;
};

/// Renders images of a world by ray casting.  Surfaces are lit by the sun (Lambert's law, with shadows) and by the sky,
/// with a highlight after Blinn (1977).  It uses neither GPU nor display and is reproducible bit by bit.  PixelRays
/// models the lens, develop() the exposure.  A renderer is used by one thread at a time; several renderers may run
/// concurrently when Scene::concurrent() is true.  Where it is called within work that a ThreadPool shares, the threads
/// of the pool share the rows of the image, with the same pixels for any number of threads.
class Renderer {
 public:
  /// Throws ConfigError when a texture of an existing material cannot be read.  Unreadable textures of materials that
  /// are added later are ignored.
  Renderer(const PhysicsWorld& physics, std::shared_ptr<const PixelRays> rays, const RenderOptions& options,
           std::shared_ptr<TextureLibrary> textures);

  /// Sets the frame to the size of the image and clears it: black, infinite depth, label 0.
  void clear(Frame& frame) const;
  /// Renders rows [first, end) with the camera at X_WS and the world in its present state.  Light is multiplied by
  /// `weight` and added; depth and labels are replaced.  The image is complete when end == height.
  void render_rows(const Pose& X_WS, int first, int end, float weight, Frame& frame);
  /// Sets the velocity of the camera at the next rows, for optical flow.
  void set_motion(const CameraMotion& motion) { motion_ = motion; }
  /// Clears the frame and renders all rows.
  void render(const Pose& X_WS, Frame& frame);

  const PixelRays& rays() const { return *rays_; }
  /// Replaces the rays by those of another lens, of the same number.
  void set_rays(std::shared_ptr<const PixelRays> rays) { rays_ = std::move(rays); }
  const RenderOptions& options() const { return options_; }

  /// Returns the name of a label, such as `rover1/chassis/hull` or `rover1`.  Label 0 means no hit; part n and group n
  /// have label n + 1.
  static std::string label_name(const PhysicsWorld& physics, ImageKind kind, std::uint16_t label);

 private:
  /// Optical properties of a material.
  struct Surface {
    bool has_color = false;
    LinearColor color = LinearColor::Zero();
    float gloss = 0;
    std::shared_ptr<const Texture> texture;
  };
  struct Tile;
  /// Part with its inverse pose.
  struct PosedPart {
    int part = -1;
    Pose X_PW = Pose::Identity();
  };

  /// Look of a material on a part.
  struct Paint {
    int part = -1, material = -1;
    float gloss = 0;
    const Texture* texture = nullptr;  // null: `color`
    bool grid = false;                 // lines on the color
    LinearColor color = LinearColor::Zero();
  };

  /// Returns the properties of a material.  `strict`: an unreadable texture is an error.
  Surface make_surface(int material, bool strict) const;
  /// Notes the properties of materials that were added.
  void add_surfaces();
  /// Renders a row of tiles of `wide` x `high` pixels, from `row` on.
  void render_tiles(const Pose& X_WS, int row, int high, int wide, float weight, Frame& frame) const;
  /// Returns the inverse pose of a part, cached because neighboring pixels mostly hit the same part.
  const Pose& X_PW(Tile& tile, int part) const;
  /// Returns the look of a material on a part, cached as its pose is.
  const Paint& paint(Tile& tile, int part, int material) const;
  /// Returns the diffuse color at a hit; `footprint_m`: size of the projected pixel.
  LinearColor albedo(Tile& tile, const Paint& paint, const RayHit& hit, const Vector3d& p_W, float footprint_m) const;
  /// Returns the light of lamps that a hit reflects, at its place; `to_hit_W`: from the camera.
  LinearColor lamp_light(const LinearColor& albedo, const Eigen::Vector3f& normal_W, const Vector3d& to_hit_W) const;
  /// Returns the optical flow of a ray of the tile, px/s.
  Vector2d flow(const Tile& tile, int ray, const Pose& X_WS) const;
  /// Writes normals or optical flow of a tile to the frame.
  void fill_vectors(const Tile& tile, const Pose& X_WS, Frame& frame) const;
  /// Returns the light reflected at the hit of a ray of the tile.
  LinearColor shade(Tile& tile, int ray, float footprint_m) const;
  /// Returns the light on a ray of the tile, without water.
  LinearColor light_on(Tile& tile, int ray) const;
  /// Computes the light on the rays of a tile, with that of the water.
  void light_water(Tile& tile) const;
  /// Collects the rays of a tile.
  void gather(Tile& tile, const Pose& X_WS) const;
  /// Casts the rays of a tile.
  void cast(Tile& tile) const;
  /// Casts shadow rays from the hits to the sun.
  void find_shadows(Tile& tile) const;
  /// Adds the light of a tile to the frame.
  void fill_light(Tile& tile, float weight, Frame& frame) const;
  /// Writes depth or labels of a tile to the frame.
  void fill_values(const Tile& tile, Frame& frame) const;

  const PhysicsWorld& physics_;
  std::shared_ptr<const PixelRays> rays_;
  RenderOptions options_;
  std::shared_ptr<TextureLibrary> textures_;
  std::vector<Surface> surfaces_;  // by material number
  SkyLight sky_;
  Vector3d to_sun_W_;
  float sky_strength_;
  Vector3d eye_W_ = Vector3d::Zero();
  std::vector<LampLight> lamps_;  // in the directions of the world, for the rows being rendered
  CameraMotion motion_;
};

/// Converts linear light to sRGB: multiplied by `gain`, clipped at white.
Image8 develop(const FloatImage& light, float gain);
/// The same with a gain of each color.  An image of one channel has the mean of the gains, by luminance.
Image8 develop(const FloatImage& light, const LinearColor& gain);
/// Does so in rows [first, end), with the gain of each color, and adds a pattern of less than a level that hides steps
/// of smooth colors: the ordered dither of Bayer (1973).
void develop_rows_dithered(const FloatImage& light, const LinearColor& gain, int first, int end, Image8& image);
/// Does so in rows [first, end).  An `image` of one channel gets the luminance of light of three.
void develop_rows(const FloatImage& light, float gain, int first, int end, Image8& image);
/// Returns the gain that brings the mean luminance to middle grey, 18 %, from 1/64 to `max_gain`.
float auto_gain(const FloatImage& light, float max_gain = 64);
/// Returns the mean of the color that is brightest.
float brightest_mean(const FloatImage& light);
/// Returns gains of the colors that give all the same mean, in the mean of the luminance 1 (gray world, Buchsbaum
/// 1980).  None is more than 64 times another.
LinearColor gray_world_gains(const FloatImage& light);
/// Returns the luminance of an RGB image as one channel.
FloatImage grey_of(const FloatImage& light);

}  // namespace sim
