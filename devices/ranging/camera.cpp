// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/camera.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "devices/ranging/ray_casting.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

/// Maximum size of a message in LCM 1.3.1, 16 MiB, with a reserve for the metadata.
constexpr int max_message_bytes = (16 << 20) - (64 << 10);

/// Data shared by the cameras of a world: decoded textures, and the rays of equal lenses.
struct SharedByCameras {
  std::shared_ptr<sim::TextureLibrary> textures = std::make_shared<sim::TextureLibrary>();
  std::map<std::string, std::weak_ptr<const sim::PixelRays>> rays;

  /// `port`: null: without one.
  std::shared_ptr<const sim::PixelRays> rays_of(const sim::OpticsConfig& config, int per_side,
                                                const sim::FlatPortConfig* port = nullptr) {
    std::string key = config.text() + " " + std::to_string(per_side);
    if (port != nullptr) key += fmt::format(" {} {} {}", port->distance_m, port->glass_m, port->glass_index);
    auto& known = rays[key];
    auto found = known.lock();
    if (!found) known = found = make_rays(config, per_side, port);
    return found;
  }

  static std::shared_ptr<const sim::PixelRays> make_rays(const sim::OpticsConfig& config, int per_side,
                                                         const sim::FlatPortConfig* port) {
    const sim::Optics optics(config);
    return port == nullptr ? sim::make_pixel_rays(optics, per_side) : sim::make_pixel_rays(optics, per_side, *port);
  }
};

const sim::SharedKind<SharedByCameras> shared_by_cameras;

bool takes_light(Camera::Kind kind) {
  return kind == Camera::Kind::rgb || kind == Camera::Kind::grey;
}

sim::ImageKind render_kind(Camera::Kind kind) {
  switch (kind) {
    case Camera::Kind::depth:
      return sim::ImageKind::depth;
    case Camera::Kind::parts:
      return sim::ImageKind::parts;
    case Camera::Kind::vehicles:
      return sim::ImageKind::groups;
    case Camera::Kind::normals:
      return sim::ImageKind::normals;
    case Camera::Kind::flow:
      return sim::ImageKind::flow;
    default:
      return sim::ImageKind::color;
  }
}

/// Returns the baseline of the stereo pair in which a camera is the right one.  Throws ConfigError when the images of
/// the two are not those of one lens, displaced to the right, at the same times.
double baseline_of(const Camera::Params& params, const sim::DeviceContext& context) {
  if (params.right_of.empty()) return 0;
  const sim::DeviceConfig& right = context.config;
  const auto check = [&](bool holds, const std::string& what) {
    if (!holds)
      sim::throw_config_error(right.place, "vehicle '" + context.vehicle.name() + "': device '" + right.name + "'",
                              "'right_of': " + what);
  };
  // The left one may follow it in the file: at this point only its configuration exists.
  const auto& devices = context.vehicle.config().devices;
  const auto left = std::find_if(devices.begin(), devices.end(),
                                 [&](const sim::DeviceConfig& device) { return device.name == params.right_of; });
  const auto* of_left =
      left == devices.end() ? nullptr : dynamic_cast<const sim::detail::ParamsOf<Camera::Params>*>(left->params.get());
  const std::string name = "'" + sim::shortened(sim::printable(params.right_of)) + "'";
  check(of_left != nullptr && &*left != &right, "the vehicle has no other camera " + name);
  const sim::OpticsConfig& optics = params.optics;
  check(optics.lens == sim::OpticsConfig::Lens::pinhole && optics.distortion.empty(),
        "a stereo pair needs pinholes without distortion");
  check(optics.text() == of_left->params.optics.text(), "its lens and size must be those of " + name);
  const Camera::Params& other = of_left->params;
  check(params.readout_s == other.readout_s && params.exposure_time_s == other.exposure_time_s,
        "its readout_s and exposure_time_s must be those of " + name);
  check(params.flat_port == other.flat_port, "its flat_port must be that of " + name);
  check(right.rate_hz == left->rate_hz && right.phase_s && right.phase_s == left->phase_s,
        "it needs rate_hz and phase_s, equal to those of " + name);
  check(right.body == left->body, "it must be on the body of " + name);
  const sim::Pose X_LR = left->X_BS().inverse() * right.X_BS();
  const sim::Vector3d p_LR = X_LR.translation();
  constexpr double rounding = 1e-5;  // of numbers in a file
  check(X_LR.linear().isIdentity(rounding) && std::hypot(p_LR.x(), p_LR.z()) < rounding && p_LR.y() < -rounding,
        fmt::format(
            "it must look as {} does, from a place to the right of it; in its frame it is at [{:g}, {:g}, {:g}], "
            "turned by {:.3g} deg",
            name, p_LR.x(), p_LR.y(), p_LR.z(), sim::radians_to_degrees(Eigen::AngleAxisd(X_LR.linear()).angle())));
  return p_LR.norm();
}

}  // namespace

void ExposureParams::read(sim::ParamReader& in) {
  in.read("auto", automatic, "automatic exposure: the mean of each image becomes middle grey");
  in.read("gain", gain, sim::above_to(0, 1000), "factor of the brightness, in addition to auto");
  in.read_choice("white_balance", white_balance,
                 {{"none", WhiteBalance::none}, {"gray_world", WhiteBalance::gray_world}},
                 "rgb: gray_world: all colors of each image get the same mean");
  in.read("color_gains", color_gains, sim::above_to(0, 1000), "rgb: gains of red, green and blue: a fixed balance");
  if (in.describing()) return;
  if (white_balance != WhiteBalance::none && in.has("color_gains"))
    in.error("color_gains", "needs either 'white_balance' or 'color_gains', not both");
}

void Camera::Params::read(sim::ParamReader& in) {
  in.read_choice("image", image,
                 {{"rgb", Kind::rgb},
                  {"grey", Kind::grey},
                  {"depth", Kind::depth},
                  {"segmentation_parts", Kind::parts},
                  {"segmentation_vehicles", Kind::vehicles},
                  {"normals", Kind::normals},
                  {"flow", Kind::flow}},
                 "kind of image");
  optics.read(in);
  // Encoding.
  in.read_choice("encoding", encoding,
                 {{"raw", Encoding::raw}, {"raw16", Encoding::raw16}, {"png", Encoding::png}, {"jpeg", Encoding::jpeg}},
                 "encoding of the message; raw16: depth in mm, 0 where there is none; png of depth too");
  in.read("jpeg_quality", jpeg_quality, sim::between(1, 100), "quality of JPEG images");
  // Rendering.
  in.read("range_max_m", range_max_m, sim::above_to(0, 100'000), "maximum range along the ray");
  in.read_choice("depth_along", depth_along, depth_along_words,
                 "depth: distance along the optical axis, or range of the ray");
  in.read("antialias", antialias, sim::between(1, 4), "rgb, grey: number of rays along each side of a pixel");
  in.read("exposure", exposure, "rgb, grey: exposure");
  // Noise.
  in.read("noise", noise, "rgb, grey: error of each level from 0 to 255; depth: of each depth, m");
  in.read("depth_noise_per_m", depth_noise_per_m, sim::at_least(0),
          "depth: standard deviation over depth squared, 1/m, as of a stereo camera");
  in.read_or_word("full_well_electrons", full_well_electrons, sim::above(0), {"unlimited"},
                  "rgb, grey: electrons of a white pixel, for shot noise; unlimited: no shot noise");
  in.read("read_noise_electrons", read_noise_electrons, sim::at_least(0), "rgb, grey: with full_well_electrons");
  // Rolling shutter and motion blur.
  in.read("readout_s", readout_s, sim::between(0, 10),
          "rolling shutter: the first row is exposed this long before the last, which is at the sample time");
  in.read("exposure_time_s", exposure_time_s, sim::between(0, 10),
          "rgb, grey: motion blur over this time up to the sample");
  in.read("blur_samples", blur_samples, sim::between(2, 64), "images that are averaged for a blurred one");
  in.read("sees_own_vehicle", sees_own_vehicle, "its own vehicle is visible in the image");
  in.read_references("see_through", see_through, "category", "categories of parts that are not visible in the image");
  // Water.
  in.read("water", water, "the water as the camera sees it; unset: it is invisible");
  in.read_list("lamps", lamps, "lamp", "rgb, grey: lamps that the camera carries, whose light only it sees");
  in.read("flat_port", flat_port, "plane window before the lens, which refracts under water; unset: a dome");
  in.read(
      "right_of", right_of,
      "the left camera of the stereo pair in which this is the right one: with its lens, rate and phase, and to the "
      "right of it; unset: no pair");
  if (in.describing()) return;
  // Check combinations of keys and the size of messages.
  check_kind(in);
  if (encoding == Encoding::raw16 && image != Kind::depth) in.error("encoding", "'raw16' is for images of depth");
  if (encoding == Encoding::jpeg && !takes_light(image)) in.error("encoding", "'jpeg' is for images rgb and grey");
  if (static_cast<double>(optics.width) * optics.height * antialias * antialias > sim::max_image_pixels)
    in.error("antialias", "'antialias' makes more than " + std::to_string(sim::max_image_pixels) + " rays in an image");
  if (exposure_time_s > 0 && readout_s > 0)
    in.error("exposure_time_s", "must have either 'readout_s' or 'exposure_time_s', not both");
  if (exposure_time_s > 0 && !takes_light(image)) in.error("exposure_time_s", "is for images rgb and grey");
  if (read_noise_electrons > 0 && full_well_electrons == 0)
    in.error("read_noise_electrons", "'read_noise_electrons' needs 'full_well_electrons'");
  check_time(in);
  if (message_bytes() > max_message_bytes)
    in.error(in.has("height") ? "height" : "width",
             fmt::format("an image must have at most {} bytes, got {:.0f}: the bus carries no more; 'encoding' png or "
                         "jpeg makes it smaller",
                         max_message_bytes, message_bytes()));
}

void Camera::Params::check_kind(sim::ParamReader& in) const {
  const bool color_balance =
      exposure.white_balance != ExposureParams::WhiteBalance::none || exposure.color_gains != sim::Vector3d::Ones();
  if (color_balance && image != Kind::rgb) in.error("exposure", "white_balance and color_gains are for images rgb");
  if (water && !takes_light(image)) in.error("water", "'water' is for images rgb and grey");
  if (!lamps.empty() && !takes_light(image)) in.error("lamps", "'lamps' is for images rgb and grey");
  const bool vectors = image == Kind::normals || image == Kind::flow;
  for (const char* key : {"noise", "depth_noise_per_m", "full_well_electrons", "antialias", "exposure"})
    if (vectors && in.has(key)) in.error(key, fmt::format("'{}' is not for images normals and flow", key));
  if (image == Kind::flow && encoding != Encoding::raw) in.error("encoding", "'encoding' must be raw for images flow");
  if (image == Kind::flow && readout_s > 0) in.error("readout_s", "'readout_s' is not for images flow");
  if (image == Kind::flow && flat_port) in.error("flat_port", "'flat_port' is not for images flow");
}

void Camera::Params::check_time(sim::ParamReader& in) const {
  const char* key = readout_s > 0 ? "readout_s" : "exposure_time_s";
  const double span_s = std::max(readout_s, exposure_time_s);
  const double rate_hz = rate_hz_of(in, default_rate_hz);
  if (span_s > 0 && rate_hz == 0) in.error(key, fmt::format("'{}' needs a 'rate_hz', not every_step", key));
  if (span_s * rate_hz > 1 + 1e-9)
    in.error(key, fmt::format("'{}' must be at most 1 / rate_hz, got {:g} s at {:g} Hz", key, span_s, rate_hz));
}

double Camera::Params::message_bytes() const {
  if (encoding == Encoding::png || encoding == Encoding::jpeg) return 0;
  const double bytes = image == Kind::rgb       ? 3
                       : image == Kind::grey    ? 1
                       : image == Kind::depth   ? (encoding == Encoding::raw ? 4 : 2)
                       : image == Kind::normals ? 12
                       : image == Kind::flow    ? 8
                                                : 2;
  return bytes * optics.width * optics.height;
}

Camera::Camera(const Params& params, const sim::DeviceContext& context)
    : world_(context.world),
      shared_(context.host.shared),
      physics_(context.world.physics()),
      vehicle_(context.vehicle),
      config_(context.config),
      step_(sim::from_seconds(context.world.config().physics.step_s)),
      own_group_(context.vehicle.group()),
      baseline_m_(baseline_of(params, context)),
      X_BS_(context.config.X_BS()),
      body_(context.body),
      noise_(context, params, params.image == Kind::rgb ? 3 : 1) {
  change(params);
  // Before its first image the camera has a black one of the right size.
  renderer_->clear(frame_);
  levels_ = sim::develop(params_.image == Kind::grey ? sim::grey_of(frame_.light) : frame_.light, 1);
  depth_m_ = frame_.depth_m;
}

std::optional<sim::FieldOfView> Camera::field_of_view() const {
  const sim::Optics optics(params_.optics);
  sim::FieldOfView view{sim::FieldOfView::Kind::frustum, params_.range_max_m};
  view.horizontal_rad = 2 * std::atan(optics.width() / (2 * optics.focal_x_px()));
  view.vertical_rad = 2 * std::atan(optics.height() / (2 * optics.focal_y_px()));
  return view;
}

int Camera::rays_per_side(const Params& params) {
  return takes_light(params.image) ? params.antialias : 1;  // depths and labels must not be averaged
}

void Camera::zoom(double fov_rad) {
  zoomed_fov_rad_ = fov_rad;
  if (params_.optics.fov_rad == fov_rad) return;
  params_.optics.fov_rad = fov_rad;
  lens_moved_ = true;
}

void Camera::change(const Params& params) {
  Params next = params;
  if (zoomed_fov_rad_ > 0) {
    next.optics.fov_rad = zoomed_fov_rad_;
    if (params.optics.fov_rad != given_fov_rad_ || next.optics.text() != params_.optics.text())
      throw std::runtime_error("its lens belongs to a zooming camera, and cannot be set");
  }
  if (next.water && !world_.medium().has_water())
    sim::throw_config_error(config_.place, "vehicle '" + vehicle_.name() + "': device '" + config_.name + "'",
                            "'water': the world has no water");
  // Nothing changes unless all can be made.
  std::unique_ptr<sim::WaterView> water;
  if (next.water) water = std::make_unique<sim::WaterView>(world_.medium(), world_.config().light, *water_look(next));
  SharedByCameras& shared = shared_.of(shared_by_cameras);
  sim::RenderOptions options;
  options.kind = render_kind(params.image);
  options.filter =
      make_ray_filter(physics_, sim::RayKind::light, params.see_through, own_group_, params.sees_own_vehicle);
  options.range_max_m = params.range_max_m;
  options.depth_along_ray = params.depth_along == DepthAlong::ray;
  options.light = world_.config().light;
  options.water = water.get();
  options.with_depth = water && water->has_particles();
  for (const sim::LampConfig& lamp : next.lamps) options.lamps.push_back(lamp.lamp(X_BS_));
  auto dry_rays = shared.rays_of(next.optics, rays_per_side(next));
  auto wet_rays = next.flat_port ? shared.rays_of(next.optics, rays_per_side(next), &*next.flat_port) : nullptr;
  auto renderer = std::make_unique<sim::Renderer>(physics_, dry_rays, options, shared.textures);
  given_fov_rad_ = params.optics.fov_rad;
  params_ = std::move(next);
  renderer_ = std::move(renderer);  // before the water that the old one uses
  water_ = std::move(water);
  dry_rays_ = std::move(dry_rays);
  wet_rays_ = std::move(wet_rays);
  lens_moved_ = false;
  renderer_->clear(in_progress_);
  next_exposure_ = 0;
  next_sample_ = swept_at_;  // unknown until the next sweep
}

int Camera::exposures() const {
  if (params_.readout_s > 0) return params_.optics.height;
  return params_.exposure_time_s > 0 ? params_.blur_samples : 1;
}

void Camera::expose(int exposure, const sim::Pose& X_WS) {
  // The rays of a lens that moves are its own, and are made only when they are needed.
  if (lens_moved_) {
    dry_rays_ = SharedByCameras::make_rays(params_.optics, rays_per_side(params_), nullptr);
    if (wet_rays_) wet_rays_ = SharedByCameras::make_rays(params_.optics, rays_per_side(params_), &*params_.flat_port);
    renderer_->set_rays(dry_rays_);
  }
  lens_moved_ = false;
  if (wet_rays_) renderer_->set_rays(world_.medium().in_water(X_WS.translation()) ? wet_rays_ : dry_rays_);
  if (water_) water_->update(X_WS.translation());
  if (params_.image == Kind::flow) renderer_->set_motion({body_.velocity_at_W(X_BS_.translation()), body_.w_WB_W()});
  if (params_.readout_s > 0)
    renderer_->render_rows(X_WS, exposure, exposure + 1, 1, in_progress_);
  else
    renderer_->render_rows(X_WS, 0, params_.optics.height, 1.0F / static_cast<float>(exposures()), in_progress_);
}

sim::Time Camera::before_sample(int exposure) const {
  const int count = exposures();
  if (count < 2) return sim::Time{0};
  const double span_s = params_.readout_s > 0 ? params_.readout_s : params_.exposure_time_s;
  return sim::from_seconds(span_s * (count - 1 - exposure) / (count - 1));
}

void Camera::remember(const sim::SweepContext& context) {
  if (places_.empty() || places_.back().at != context.from) {  // first step, or the camera was without power
    places_.clear();
    places_.push_back({context.from, context.X_WS_from});
  }
  places_.push_back({context.now, context.X_WS});
  while (places_.size() > 2 && places_[1].at <= context.now - before_sample(0)) places_.pop_front();
}

sim::Pose Camera::X_WS_at(sim::Time at) const {
  if (at <= places_.front().at) return places_.front().X_WS;
  const auto after =
      std::lower_bound(places_.begin(), places_.end(), at, [](const Place& p, sim::Time t) { return p.at < t; });
  if (after == places_.end()) return places_.back().X_WS;
  const auto before = std::prev(after);
  return sim::SweepContext{world_, vehicle_, before->at, after->at, before->X_WS, after->X_WS, {}}.X_WS_at(at);
}

void Camera::sweep(const sim::SweepContext& context) {
  swept_at_ = context.now;
  next_sample_ = context.next_sample;
  const int count = exposures();
  if (count < 2) return;
  remember(context);
  for (; next_exposure_ < count; ++next_exposure_) {
    const sim::Time at = context.next_sample - before_sample(next_exposure_);
    if (at > context.now) return;
    // The time may precede this step when the previous image ended late, at a rate that does not divide the step rate.
    expose(next_exposure_, X_WS_at(at));
  }
}

std::int64_t Camera::rays() const {
  int due = next_exposure_;
  while (due < exposures() && next_sample_ - before_sample(due) <= swept_at_ + step_) ++due;
  const auto image = static_cast<std::int64_t>(renderer_->rays().directions_S.size());
  return (due - next_exposure_) * (params_.readout_s > 0 ? image / params_.optics.height : image);
}

void Camera::measure(const sim::SenseContext& context) {
  for (; next_exposure_ < exposures(); ++next_exposure_) expose(next_exposure_, context.X_WS);
  next_exposure_ = 0;
  image_digest_.renew();
  // Lower bound of the next sample time, until the next sweep sets it.
  const double steps = config_.rate_hz > 0 ? 1 / (config_.rate_hz * sim::to_seconds(step_)) : 1;
  next_sample_ = context.now + step_ * std::max<std::int64_t>(1, static_cast<std::int64_t>(steps + 1e-9));
  std::swap(frame_, in_progress_);
  renderer_->clear(in_progress_);
  if (params_.image == Kind::depth) depth_m_ = frame_.depth_m;
  if (!takes_light(params_.image)) return;
  develop();
}

std::optional<sim::WaterLook> Camera::water_look(const Params& params) const {
  if (!params.water) return std::nullopt;
  sim::WaterLook look;
  look.optics = params.water->optics();
  look.waves_range_m = std::min(look.waves_range_m, params.range_max_m);
  look.caustics = params.water->has_caustics();
  look.particles_per_m3 = params.water->particles();
  look.seed = static_cast<std::uint64_t>(world_.config().run.seed);
  return look;
}

void Camera::develop() {
  gain_ = static_cast<float>(params_.exposure.gain);
  balance_ = params_.exposure.white_balance == ExposureParams::WhiteBalance::gray_world
                 ? sim::gray_world_gains(frame_.light)
                 : sim::LinearColor(params_.exposure.color_gains.cast<float>());
  const bool balanced = balance_ != sim::LinearColor::Ones();
  digital_gain_ = 1;
  if (params_.exposure.automatic) {
    sim::FloatImage seen = frame_.light;
    for (std::size_t i = 0; balanced && i < seen.data.size(); ++i)
      seen.data[i] *= balance_[static_cast<Eigen::Index>(i % 3)];
    constexpr float max_gain = 64, max_gain_in_water = 1e4F;
    gain_ *= sim::auto_gain(seen, water_ ? max_gain_in_water : max_gain);
    // A sensor is exposed so that no color fills its pixels; the rest is done with its numbers.
    if (balanced) digital_gain_ = std::max(1.0F, 2 * gain_ * sim::brightest_mean(frame_.light));
  }
  if (params_.image == Kind::grey)
    light_ = sim::grey_of(frame_.light);
  else
    std::swap(light_, frame_.light);
  levels_ = balanced ? sim::develop(light_, gain_ * balance_) : sim::develop(light_, gain_);
}

void Camera::add_sensor_noise(sim::Random& random) {
  const double full = params_.full_well_electrons;
  const double read_variance = params_.read_noise_electrons * params_.read_noise_electrons;
  for (std::size_t i = 0; i < light_.data.size(); ++i) {
    const double electrons = full * std::clamp(static_cast<double>(gain_ / digital_gain_ * light_.data[i]), 0.0, 1.0);
    const double counted = electrons + std::sqrt(electrons + read_variance) * random.gaussian();
    const float balance = light_.channels == 3 ? balance_[static_cast<Eigen::Index>(i % 3)] : 1;
    levels_.data[i] = sim::srgb_from_linear(digital_gain_ * balance * static_cast<float>(counted / full));
  }
}

void Camera::disturb(double dt_s, sim::Random& random) {
  if (takes_light(params_.image)) {
    // Shot noise depends on the light of a pixel; the other noise is added to it as read out.
    if (params_.full_well_electrons > 0) add_sensor_noise(random);
    values_.assign(levels_.data.begin(), levels_.data.end());
    noise_.apply(std::span<double>(values_), dt_s, random);
    for (std::size_t i = 0; i < values_.size(); ++i)
      levels_.data[i] = static_cast<std::uint8_t>(std::clamp(values_[i], 0.0, 255.0) + 0.5);
  } else if (params_.image == Kind::depth) {
    values_.assign(depth_m_.data.begin(), depth_m_.data.end());
    if (params_.depth_noise_per_m > 0)
      for (double& depth : values_)
        // The depth of a stereo pair is f b / d, so an error of the disparity d grows with the square of the depth.
        if (std::isfinite(depth)) depth += params_.depth_noise_per_m * depth * depth * random.gaussian();
    noise_.apply(std::span<double>(values_), dt_s, random);
    for (std::size_t i = 0; i < values_.size(); ++i)
      if (std::isfinite(depth_m_.data[i])) depth_m_.data[i] = static_cast<float>(std::max(0.0, values_[i]));
  }
}

void Camera::visit_state(sim::StateArchive& archive) {
  archive(noise_, places_, swept_at_, next_sample_, next_exposure_);
  if (next_exposure_ < 0 || next_exposure_ > exposures())
    archive.fail("the snapshot has an image after " + std::to_string(next_exposure_) + " exposures of " +
                 std::to_string(exposures()));
  const auto visit = [&archive](auto& image) {
    archive.expect_count(image.data.size(), "values in an image");
    archive.raw(image.data.data(), image.data.size() * sizeof image.data[0]);
  };
  const bool has_vectors = params_.image == Kind::normals || params_.image == Kind::flow;
  // Exposed part of the next image.
  if (archive.restoring()) renderer_->clear(in_progress_);
  if (next_exposure_ > 0) {
    visit(in_progress_.light);
    visit(in_progress_.depth_m);
    visit(in_progress_.labels);
    if (has_vectors) visit(in_progress_.vectors);
  }
  if (has_vectors)
    image_digest_.visit(archive, frame_.vectors.data);
  else
    image_digest_.visit(archive, levels_.data, depth_m_.data, frame_.labels.data);
}

std::string Camera::label_text() const {
  std::vector<std::uint16_t> seen(frame_.labels.data);
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  std::string text;
  for (const std::uint16_t label : seen)
    text += std::to_string(label) + " " + sim::Renderer::label_name(physics_, render_kind(params_.image), label) + "\n";
  return text;
}

}  // namespace devices
