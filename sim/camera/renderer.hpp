// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/camera/optics.hpp"
#include "sim/camera/texture.hpp"
#include "sim/image/image.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/scene/light.hpp"

namespace sim {

/// What an image is of.
enum class ImageKind { color, depth, parts, groups };

struct RenderOptions {
  ImageKind kind = ImageKind::color;
  /// Parts of materials that let light through are never seen.
  RayFilter filter{~0u, -1, RayKind::light};
  double range_max_m = 10'000;   ///< along the ray; what is farther is not seen
  bool depth_along_ray = false;  ///< depth is the range; else the distance along the optical axis (x of S)
  LightConfig light;
};

/// One image in progress: `light` holds a color image in linear RGB, `depth_m` depth (infinity: nothing), `labels` a
/// segmentation (see Renderer::label_name); the others stay empty.
struct Frame {
  FloatImage light;
  FloatImage depth_m;
  Image16 labels;
  void visit_state(StateArchive& archive) { archive(light, depth_m, labels); }
};

/// Makes images of a world, ray by ray: Lambert's law under a sun with shadows and a sky, a Blinn-Phong highlight.
/// No GPU, no display; the same bits in every run.  Knows neither lens nor exposure: see PixelRays and develop().
/// One thread at a time; several renderers may work at once when the scene allows it.
class Renderer {
 public:
  /// Throws ConfigError for a texture that cannot be read, of a material that the world has now.  For one that is
  /// added later, such a texture is left out.
  Renderer(const PhysicsWorld& physics, std::shared_ptr<const PixelRays> rays, const RenderOptions& options,
           std::shared_ptr<TextureLibrary> textures);

  /// An empty frame of the right size: black, infinitely far, label 0.
  void clear(Frame& frame) const;
  /// Renders rows [first, end) with the camera at X_WS and the world as it is.  Light is added times `weight`; depth
  /// and labels are replaced.  Everything when end == height.
  void render_rows(const Pose& X_WS, int first, int end, float weight, Frame& frame);
  /// All rows.
  void render(const Pose& X_WS, Frame& frame);

  const PixelRays& rays() const { return *rays_; }
  const RenderOptions& options() const { return options_; }

  /// What a label stands for: `rover1/chassis/hull` or `rover1`.  0 is what is not seen, part n and group n are n + 1.
  static std::string label_name(const PhysicsWorld& physics, ImageKind kind, std::uint16_t label);

 private:
  /// A material as it looks.
  struct Surface {
    bool known = false;
    bool has_color = false;
    LinearColor color = LinearColor::Zero();
    float gloss = 0;
    std::shared_ptr<const Texture> texture;
  };
  struct Tile;
  struct PosedPart {
    int part = -1;
    Pose X_PW = Pose::Identity();
  };

  Surface make_surface(int material, bool strict) const;
  const Surface& surface(int material);
  /// Asked for again and again: neighbouring pixels mostly see one part.
  const Pose& X_PW(int part);
  LinearColor albedo(const RayHit& hit, const Vector3d& p_W, float footprint_m);
  LinearColor sky(const Eigen::Vector3f& direction_W) const;
  LinearColor shade(const RayHit& hit, const Ray& ray, bool in_shadow, float footprint_m);
  void gather(Tile& tile, const Pose& X_WS) const;
  void cast(Tile& tile) const;
  void find_shadows(Tile& tile) const;
  void fill_light(Tile& tile, float weight, Frame& frame);
  void fill_values(const Tile& tile, Frame& frame) const;

  const PhysicsWorld& physics_;
  std::shared_ptr<const PixelRays> rays_;
  RenderOptions options_;
  std::shared_ptr<TextureLibrary> textures_;
  std::vector<Surface> surfaces_;  // by number of the material
  PosedPart posed_;                // the last one, while rows are rendered
  Vector3d to_sun_W_;
  Eigen::Vector3f to_sun_f_W_;
  bool sun_is_up_;
  LinearColor sun_, zenith_, horizon_, ground_;
  float sky_strength_;
};

/// Light to sRGB: times `gain`, cut at white.
Image8 develop(const FloatImage& light, float gain);
/// The gain that brings the mean brightness to a middle grey of 18 %.
float auto_gain(const FloatImage& light);
/// Grey by brightness.
FloatImage grey_of(const FloatImage& light);

}  // namespace sim
