// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "devices/common/reading_digest.hpp"
#include "sim/camera/lamp.hpp"
#include "sim/camera/renderer.hpp"
#include "sim/camera/water_optics.hpp"
#include "sim/camera/water_view.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Exposure of images.
struct ExposureParams {
  /// Balance of the colors.
  enum class WhiteBalance { none, gray_world };
  bool automatic = false;  ///< automatic gain: the mean of each image is middle grey
  double gain = 1;         ///< gain of the light, in addition to `automatic`
  WhiteBalance white_balance = WhiteBalance::none;
  sim::Vector3d color_gains = sim::Vector3d::Ones();  ///< of red, green and blue, without white_balance
  void read(sim::ParamReader& in);
};

/// Camera rendered without GPU or display.  Its optical axis is +x of the sensor frame S; +y is left in the image and
/// +z up.  See docs/models/cameras.md.
class Camera final : public sim::Sensor {
 public:
  static constexpr const char* meaning =
      "Camera: color, grey, depth, segmentation, normals or optical flow; pinhole or fisheye.";
  static constexpr double default_rate_hz = 20;
  static constexpr bool casts_rays = true;
  static constexpr bool sweeps = true;
  static constexpr const char* fixed_keys[] = {"image",    "readout_s", "exposure_time_s", "blur_samples",
                                               "right_of", "water",     "lamps",           "flat_port"};
  static constexpr bool reuses_message = true;
  /// Kind of image: color, grey, depth, segmentation by part or by vehicle, normals, optical flow.
  enum class Kind { rgb, grey, depth, parts, vehicles, normals, flow };
  /// Encoding of the message.
  enum class Encoding { raw, raw16, png, jpeg };
  /// Depth along the optical axis, or range along the ray.
  enum class DepthAlong { axis, ray };
  static constexpr sim::ChoiceWords<DepthAlong> depth_along_words{{"axis", DepthAlong::axis}, {"ray", DepthAlong::ray}};
  struct Params {
    sim::OpticsConfig optics;
    Kind image = Kind::rgb;
    Encoding encoding = Encoding::raw;
    int jpeg_quality = 85;
    double range_max_m = 10'000;
    DepthAlong depth_along = DepthAlong::axis;
    int antialias = 1;
    ExposureParams exposure;
    sim::NoiseParams noise;          ///< error of levels 0 to 255, or of depth, m
    double depth_noise_per_m = 0;    ///< standard deviation of depth over depth squared, 1/m
    double full_well_electrons = 0;  ///< shot noise: electrons of a white pixel; 0: none
    double read_noise_electrons = 0;
    double readout_s = 0;
    double exposure_time_s = 0;
    int blur_samples = 4;
    bool sees_own_vehicle = false;
    std::vector<std::string> see_through;       ///< part categories
    std::optional<sim::WaterLookConfig> water;  ///< unset: the water is invisible
    std::vector<sim::LampConfig> lamps;
    std::optional<sim::FlatPortConfig> flat_port;  ///< unset: rays continue in water as in air, as behind a dome
    std::string right_of;                          ///< left camera of a stereo pair; empty: no stereo pair
    void read(sim::ParamReader& in);
    /// Returns the size of the pixels of an image in bytes; 0 for compressed images.
    double message_bytes() const;

   private:
    void check_time(sim::ParamReader& in) const;
    void check_kind(sim::ParamReader& in) const;
  };

  Camera(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  auto noises() { return std::tie(noise_); }
  void sweep(const sim::SweepContext& context) override;
  void displaced() override { places_.clear(); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  std::optional<sim::FieldOfView> field_of_view() const override;
  std::int64_t rays() const override;
  void visit_state(sim::StateArchive& archive) override;

  /// Sets the horizontal field of view, rad, from the next exposure on, in place of that of the parameters.
  void zoom(double fov_rad);

  const Params& params() const { return params_; }
  /// Returns the distance to the left camera of its stereo pair, m; 0: it is not the right one of a pair.
  double baseline_m() const { return baseline_m_; }
  /// Returns filter, range and light of the images.
  const sim::RenderOptions& render_options() const { return renderer_->options(); }
  /// Return the last image.  Only the image of the configured kind is filled.
  const sim::Image8& levels() const { return levels_; }        ///< rgb, grey
  const sim::FloatImage& depth_m() const { return depth_m_; }  ///< depth; infinity: no hit
  const sim::Image16& labels() const { return frame_.labels; }
  const sim::FloatImage& vectors() const { return frame_.vectors; }  ///< normals, flow: see sim::Frame
  /// Returns the light of the last image, rgb or grey, before exposure, balance of colors, noise and levels.
  const sim::FloatImage& light() const { return light_; }
  /// Returns the water in the images; empty: it is invisible.
  std::optional<sim::WaterLook> water_look(const Params& params) const;
  /// Returns the names of the labels in the last image, one line `LABEL NAME` each.
  std::string label_text() const;

 private:
  /// Returns the number of exposures per image: rows of a rolling shutter, or images averaged for motion blur.
  int exposures() const;
  /// Returns the time from an exposure to the sample of its image.
  sim::Time before_sample(int exposure) const;
  void expose(int exposure, const sim::Pose& X_WS);
  /// Records the poses of the camera during an image.
  void remember(const sim::SweepContext& context);
  /// Returns the pose at a time, clamped to the recorded interval.
  sim::Pose X_WS_at(sim::Time at) const;
  void add_sensor_noise(sim::Random& random);
  /// Sets gain and balance of the colors, and the levels.
  void develop();

  /// Pose of the camera at a time.
  struct Place {
    sim::Time at{0};
    sim::Pose X_WS = sim::Pose::Identity();
    void visit_state(sim::StateArchive& archive) { archive(at, X_WS); }
  };

  const sim::World& world_;
  sim::SharedByDevices& shared_;
  const sim::PhysicsWorld& physics_;
  const sim::Vehicle& vehicle_;
  const sim::DeviceConfig& config_;
  sim::Time step_;
  int own_group_;
  /// Returns the rays along each side of a pixel.
  static int rays_per_side(const Params& params);

  Params params_;
  double given_fov_rad_ = 0;   // that of the parameters, before it zooms
  double zoomed_fov_rad_ = 0;  // 0: that of the parameters
  bool lens_moved_ = false;    // the rays are those of another field of view
  double baseline_m_ = 0;
  sim::Pose X_BS_;
  const sim::Body& body_;
  std::unique_ptr<sim::WaterView> water_;
  std::shared_ptr<const sim::PixelRays> dry_rays_, wet_rays_;  // with a flat port: in air, in water
  std::unique_ptr<sim::Renderer> renderer_;
  sim::NoiseOf<&Params::noise> noise_;
  sim::Frame in_progress_, frame_;  // image being exposed, and last image
  int next_exposure_ = 0;
  std::deque<Place> places_;                // poses at the ends of steps, latest last
  sim::Time swept_at_{0}, next_sample_{0};  // for rays()
  sim::FloatImage light_;                   // last image without noise, in color or grey
  float gain_ = 1;
  float digital_gain_ = 1;                               // the part of it that is not exposure
  sim::LinearColor balance_ = sim::LinearColor::Ones();  // gains of the colors
  sim::Image8 levels_;
  sim::FloatImage depth_m_;
  ReadingDigest image_digest_;  // of the last image
  std::vector<double> values_;  // buffer for noise
};

/// FourCC codes of bot_core's pixel formats as signed 32-bit integers.  PNG, and two or three floats in a pixel, are
/// not defined by bot_core; their codes are the letters `PNG `, `F3X2` and `F3X3`, least significant byte first.
enum PixelFormat : std::int32_t {
  pixel_format_grey = 1497715271,
  pixel_format_rgb = 859981650,
  pixel_format_mjpeg = 1196444237,
  pixel_format_le_grey16 = 909199180,
  pixel_format_float_grey32 = 842221382,
  pixel_format_float_2 = 'F' | '3' << 8 | 'X' << 16 | '2' << 24,
  pixel_format_float_3 = 'F' | '3' << 8 | 'X' << 16 | '3' << 24,
  pixel_format_png = 'P' | 'N' << 8 | 'G' << 16 | ' ' << 24
};

}  // namespace devices
