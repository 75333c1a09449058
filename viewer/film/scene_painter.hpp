// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/thread_pool.hpp"
#include "sim/camera/renderer.hpp"
#include "sim/camera/water_view.hpp"
#include "sim/world/world.hpp"

namespace viewer {

/// Camera and its pose.
struct SceneView {
  sim::OpticsConfig optics;
  sim::Pose X_WS = sim::Pose::Identity();
  sim::RenderOptions options;
  bool grey = false;
  int antialias = 2;
  float gain = 1;
  std::optional<sim::WaterLook> water;  ///< none: the water is invisible
  /// Exposure under water follows the daylight at the depth of the camera, color by color.
  bool follows_daylight = true;
  std::optional<sim::FlatPortConfig> flat_port;
};

/// Image of a scene with the distance of each pixel along the optical axis (infinity: nothing there), for overlays.
struct RenderedScene {
  sim::Image8 image;
  sim::FloatImage depth_m;  ///< of color images
};

/// Renders images of a world in several threads.  What a camera needs is kept from image to image.
class ScenePainter {
 public:
  /// `world` must outlive this.  `threads` 0: one for each processor.
  explicit ScenePainter(const sim::World& world, int threads = 0);
  ~ScenePainter();

  /// Renders the world in its present state.  The image is valid until the next call.
  RenderedScene& paint(const SceneView& view);

 private:
  struct Lens;

  Lens& lens_of(const SceneView& view);
  void render(Lens& lens, const SceneView& view);

  const sim::World& world_;
  sim::ThreadPool threads_;
  std::shared_ptr<sim::TextureLibrary> textures_;
  std::vector<std::unique_ptr<Lens>> lenses_;
  sim::Frame frame_;
  RenderedScene rendered_;
};

}  // namespace viewer
