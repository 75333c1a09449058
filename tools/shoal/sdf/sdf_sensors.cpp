// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "sim/config/message_text.hpp"
#include "tools/shoal/sdf/sdf_devices.hpp"
#include "tools/shoal/sdf/sdf_reader.hpp"
#include "tools/shoal/urdf/vehicle_text.hpp"

namespace tools {

namespace {

using std::numbers::pi;

std::string degrees_text(double angle_rad) {
  return short_number(sim::radians_to_degrees(angle_rad));
}

/// A sensor on its way to a device: keys that fit are kept, others become notes.
class SensorReading {
 public:
  SensorReading(const SdfSensor& sensor, SdfDevices& devices)
      : devices_(devices), element_(sensor.element), link_(sensor.link), X_LS_(sensor.X_LS) {
    name_ = element_.text("name", "sensor");
    element_.set_who("sensor '" + sim::shortened(sim::printable(name_)) + "'");
    const double rate_hz = element_.child_number("update_rate").value_or(0);
    if (rate_hz > 0) keys_.add("rate_hz", std::clamp(rate_hz, 1e-6, 1e6));
  }

  const XmlElement& element() const { return element_; }
  const std::string& name() const { return name_; }
  FlowMap& keys() { return keys_; }
  void turn(const sim::Pose& X) { X_LS_ = X_LS_ * X; }
  void note(const XmlElement& at, const std::string& text) {
    devices_.vehicle().notes.push_back({at.place(), element_.who() + ": " + text});
  }
  void note_others(const XmlElement& element, std::initializer_list<std::string_view> known) {
    XmlElement shown = element;
    shown.set_who(element_.who());
    note_rest(shown, known, devices_.vehicle().notes);
  }
  /// Adds the noise of a child of `parent`, whose own element may be between them.
  void add_noise(const std::string& key, const std::optional<XmlElement>& parent, double unit = 1) {
    const std::optional<XmlElement> noise = parent ? parent->child("noise") : std::nullopt;
    const std::string text = noise ? noise_text(*noise, unit, devices_.vehicle().notes) : "";
    if (!text.empty()) keys_.add(key, text);
  }
  /// Adds the noise of x, which Shoal has for all axes.
  void add_noise_of_axes(const std::string& key, const std::optional<XmlElement>& quantity, double unit = 1) {
    if (!quantity) return;
    std::array<std::string, 3> texts;
    const std::array<const char*, 3> axes{"x", "y", "z"};
    std::vector<ImportNote> known;
    for (std::size_t i = 0; i < 3; ++i)
      if (const auto axis = quantity->child(axes[i]))
        if (const auto noise = axis->child("noise"))
          texts[i] = noise_text(*noise, unit, i == 0 ? devices_.vehicle().notes : known);
    if (texts[1] != texts[0] || texts[2] != texts[0])
      note(*quantity,
           fmt::format("the noise of y and z of <{}> is not imported: all axes get that of x", quantity->name()));
    if (!texts[0].empty()) keys_.add(key, texts[0]);
  }
  void add(const std::string& type, const std::string& suffix = "") {
    devices_.add(element_, name_ + suffix, type, link_, X_LS_, keys_.entries());
  }

 private:
  SdfDevices& devices_;
  XmlElement element_;
  std::string name_, link_;
  sim::Pose X_LS_;
  FlowMap keys_;
};

void add_imu(SensorReading& sensor) {
  const std::optional<XmlElement> imu = sensor.element().child("imu");
  if (imu) {
    sensor.add_noise_of_axes("gyro_noise", imu->child("angular_velocity"));
    sensor.add_noise_of_axes("accel_noise", imu->child("linear_acceleration"));
    sensor.note_others(*imu, {"angular_velocity", "linear_acceleration", "enable_orientation"});
    if (imu->child("enable_orientation") && imu->child_flag("enable_orientation", false))
      sensor.note(*imu->child("enable_orientation"), "its orientation is not imported: an `ahrs` reports one");
  }
  sensor.add("imu");
}

void add_navsat(SensorReading& sensor, const char* kind) {
  if (const auto navsat = sensor.element().child(kind)) {
    if (const auto position = navsat->child("position_sensing")) {
      sensor.add_noise("horizontal_noise", position->child("horizontal"));
      sensor.add_noise("vertical_noise", position->child("vertical"));
    }
    if (const auto velocity = navsat->child("velocity_sensing")) {
      sensor.add_noise("velocity_noise", velocity->child("horizontal"));
      if (const auto vertical = velocity->child("vertical"))
        sensor.note(*vertical, "the noise of the vertical velocity is not imported: it is that of the horizontal one");
    }
  }
  sensor.add("gps");
}

/// Directions of a scan along one axis: their number, and the angles of the first and the last.
struct ScanAxis {
  double count = 1, first_rad = 0, last_rad = 0;
};

ScanAxis read_scan(const XmlElement& lidar, const char* axis, double count) {
  ScanAxis read{count, 0, 0};
  const std::optional<XmlElement> scan = lidar.child("scan");
  const std::optional<XmlElement> found = scan ? scan->child(axis) : std::nullopt;
  if (!found) return read;
  read.count =
      std::round(found->child_number("samples").value_or(count) * found->child_number("resolution").value_or(1));
  read.first_rad = found->child_number("min_angle").value_or(0);
  read.last_rad = found->child_number("max_angle").value_or(0);
  if (read.last_rad < read.first_rad) found->refuse("<min_angle> must not be above <max_angle>");
  return read;
}

void add_range_of_lidar(SensorReading& sensor, const XmlElement& lidar) {
  constexpr double far_m = 1000;  // `inf` is common
  if (const auto range = lidar.child("range")) {
    const double low = range->limited_child_number("min").value_or(0);
    const double high = range->limited_child_number("max").value_or(far_m);
    sensor.keys().add("range_min_m", std::max(low, 0.0));
    if (high > low && high > 0) sensor.keys().add("range_max_m", std::min(high, far_m));
    if (high > far_m) sensor.note(*range, "its <max> becomes 1000 m");
    const double resolution_m = range->child_number("resolution").value_or(0);
    if (resolution_m > 0) sensor.keys().add("resolution_m", resolution_m);
  }
  sensor.add_noise("noise", lidar);
}

void add_lidar(SensorReading& sensor) {
  const std::optional<XmlElement> ray = sensor.element().child("ray");
  const std::optional<XmlElement> lidar = ray ? ray : sensor.element().child("lidar");
  constexpr double max_rays = 100000, max_rings = 1000;
  const XmlElement& from = lidar ? *lidar : sensor.element();
  const ScanAxis fan = read_scan(from, "horizontal", 640), rings = read_scan(from, "vertical", 1);
  const double fov_rad = fan.last_rad - fan.first_rad;
  if (!(fan.count >= 1 && rings.count >= 1 && rings.count <= max_rings && fan.count <= max_rays) ||
      fov_rad > 2 * pi + 0.01)
    return sensor.note(from,
                       fmt::format("it is not imported: {:.6g} by {:.6g} directions over {} deg are not those of a "
                                   "lidar of Shoal",
                                   fan.count, rings.count, degrees_text(fov_rad)));
  // The fan of Shoal lies evenly about its x axis.
  sensor.turn(sim::make_pose(sim::Vector3d::Zero(), {0, 0, (fan.first_rad + fan.last_rad) / 2}));
  const bool is_3d = rings.count > 1;
  if (is_3d) {
    constexpr double full_turn = 2 * pi - 0.1;
    sensor.keys().add("rings", rings.count);
    sensor.keys().add("lowest_deg", degrees_text(std::max(rings.first_rad, -pi / 2)));
    sensor.keys().add("highest_deg", degrees_text(std::min(rings.last_rad, pi / 2)));
    const double turns = fov_rad > 0 ? 2 * pi / fov_rad : 1;
    sensor.keys().add("columns", std::clamp(std::round(fan.count * turns), 1.0, max_rays / rings.count));
    if (fov_rad < full_turn) sensor.note(from, "its horizontal field of view is not imported: a lidar3d turns fully");
  } else {
    sensor.keys().add("beams", fan.count);
    sensor.keys().add("fov_deg", degrees_text(std::min(fov_rad, 2 * pi)));
  }
  add_range_of_lidar(sensor, from);
  sensor.add(is_3d ? "lidar3d" : "lidar");
}

void add_image_keys(SensorReading& sensor, const XmlElement& camera) {
  const std::optional<XmlElement> image = camera.child("image");
  const auto pixels = [&](const char* name, double initial) {
    const double count = image ? image->child_number(name).value_or(initial) : initial;
    return std::clamp(std::round(count), 1.0, 8192.0);
  };
  sensor.keys().add("width", pixels("width", 320));
  sensor.keys().add("height", pixels("height", 240));
  constexpr double default_fov = 1.047;  // of SDF
  sensor.keys().add("fov_deg",
                    degrees_text(std::clamp(camera.child_number("horizontal_fov").value_or(default_fov), 0.001, 3.1)));
  if (const auto clip = camera.child("clip"))
    if (const double far_m = clip->limited_child_number("far").value_or(0); far_m > 0)
      sensor.keys().add("range_max_m", std::min(far_m, 1e5));
}

void add_camera(SensorReading& sensor, const std::string& type) {
  const std::optional<XmlElement> camera = sensor.element().child("camera");
  const bool has_depth = type.find("depth") != std::string::npos || type.starts_with("rgbd");
  const bool is_wide = type.starts_with("wide");
  if (camera) {
    add_image_keys(sensor, *camera);
    const std::optional<XmlElement> image = camera->child("image");
    const bool is_grey = image && image->child_text("format").starts_with("L");
    if (is_grey && !has_depth) sensor.keys().add("image", "grey");
    sensor.note_others(*camera, {"horizontal_fov", "image", "clip", "noise", "pose", "optical_frame_id", "save",
                                 "camera_info_topic", "trigger_topic", "triggered", "depth_camera", "visibility_mask"});
  }
  if (is_wide) sensor.keys().add("lens", "fisheye");
  FlowMap& keys = sensor.keys();
  if (type == "segmentation" || type == "segmentation_camera") keys.add("image", "segmentation_parts");
  if (has_depth) {
    // A camera of Shoal has one kind of image.
    SensorReading depth = sensor;
    depth.keys().add("image", "depth");
    depth.add_noise("noise", camera);
    depth.add("camera", type.starts_with("rgbd") ? "_depth" : "");
    if (!type.starts_with("rgbd")) return;
    return sensor.add("camera");
  }
  constexpr double levels = 255;  // noise of SDF is a share of the full brightness
  sensor.add_noise("noise", camera, levels);
  sensor.add("camera");
}

void add_magnetometer(SensorReading& sensor) {
  constexpr double microtesla = 1e6;
  sensor.add_noise_of_axes("field_noise", sensor.element().child("magnetometer"), microtesla);
  sensor.add("compass");
}

void add_air_pressure(SensorReading& sensor) {
  if (const auto air = sensor.element().child("air_pressure")) {
    sensor.add_noise("pressure_noise", air->child("pressure"));
    if (air->child_number("reference_altitude").value_or(0) != 0)
      sensor.note(*air->child("reference_altitude"),
                  "<reference_altitude> is not imported: `medium: air` has the pressure of the world");
  }
  sensor.add("pressure");
}

/// A DVL of four beams that are a quarter of a turn apart.  In gz-sensors (AcousticBeam, beamsFrameTransform) a beam of
/// rotation r and tilt t points to (-sin t cos r, sin t sin r, -cos t): its azimuth is 180 degrees minus r.
void add_dvl(SensorReading& sensor) {
  std::optional<XmlElement> dvl = sensor.element().child("gz:dvl");
  if (!dvl) dvl = sensor.element().child("ignition:dvl");
  const std::optional<XmlElement> arrangement = dvl ? dvl->child("arrangement") : std::nullopt;
  double tilt_rad = sim::degrees_to_radians(30);
  if (arrangement) {
    const double unit = arrangement->text("degrees", "false") == "true" ? sim::degrees_to_radians(1) : 1;
    const std::vector<XmlElement> beams = arrangement->children("beam");
    std::set<long> quarters;
    double first_rad = 0;
    for (const XmlElement& beam : beams) {
      const double azimuth_rad = pi - unit * beam.child_number("rotation").value_or(0);
      if (quarters.empty()) {
        first_rad = azimuth_rad;
        tilt_rad = unit * beam.child_number("tilt").value_or(0);
      }
      quarters.insert((std::lround((azimuth_rad - first_rad) / (pi / 2)) % 4 + 4) % 4);
    }
    if (beams.size() != 4 || quarters.size() != 4)
      sensor.note(*arrangement,
                  "its beams are not imported as they are: those of Shoal are four, a quarter turn apart");
    tilt_rad = std::clamp(tilt_rad, sim::degrees_to_radians(5), sim::degrees_to_radians(60));
    sensor.keys().add("beam_angle_deg", degrees_text(tilt_rad));
    sensor.keys().add("first_azimuth_deg", degrees_text(sim::wrap_angle(first_rad)));
  }
  if (dvl) {
    const double low_m = dvl->child_number("minimum_range").value_or(0);
    const double high_m = dvl->child_number("maximum_range").value_or(0);
    if (low_m > 0) sensor.keys().add("altitude_min_m", low_m * std::cos(tilt_rad));
    if (high_m > low_m) sensor.keys().add("altitude_max_m", std::min(high_m * std::cos(tilt_rad), 1e4));
    if (const auto tracking = dvl->child("tracking")) {
      sensor.add_noise("beam_noise", tracking->child("bottom_mode"));
      if (const auto water = tracking->child("water_mass_mode"))
        sensor.note(*water, "<water_mass_mode> is not imported: give `layer_from_m` and `layer_to_m`");
    }
    if (const auto frame = dvl->child("reference_frame"))
      sensor.note(*frame, "<reference_frame> is not imported: reports are in the sensor's frame, x forward, z up");
  }
  sensor.add("dvl");
}

/// Type of a sensor: of a custom one the type that its plugin names.
std::string type_of_sensor(const XmlElement& element) {
  const std::string type = element.text("type", "none");
  if (type != "custom") return type;
  return element.text("gz:type", element.text("ignition:type", type));
}

void add_force_torque(SensorReading& sensor, const std::string& joint, SdfDevices& devices) {
  const auto known = devices.vehicle().joint_names.find(joint);
  if (known == devices.vehicle().joint_names.end())
    return sensor.note(sensor.element(), "it is not imported: the joint that it measures is not one of the vehicle's");
  sensor.keys().add_text("joint", known->second);
  if (const auto measured = sensor.element().child("force_torque")) {
    sensor.add_noise_of_axes("force_noise", measured->child("force"));
    sensor.add_noise_of_axes("torque_noise", measured->child("torque"));
  }
  sensor.add("joint_load");
}

/// Adds the device of a sensor; false: Shoal has none like it.
bool add_known_sensor(const SdfSensor& from, const std::string& type, SensorReading& sensor, SdfDevices& devices) {
  static const std::set<std::string> cameras = {"camera",
                                                "depth",
                                                "depth_camera",
                                                "rgbd",
                                                "rgbd_camera",
                                                "wideanglecamera",
                                                "wide_angle_camera",
                                                "segmentation",
                                                "segmentation_camera"};
  if (type == "imu")
    add_imu(sensor);
  else if (type == "gps" || type == "navsat")
    add_navsat(sensor, type == "gps" ? "gps" : "navsat");
  else if (type == "ray" || type == "lidar" || type == "gpu_ray" || type == "gpu_lidar")
    add_lidar(sensor);
  else if (type == "magnetometer")
    add_magnetometer(sensor);
  else if (type == "air_pressure")
    add_air_pressure(sensor);
  else if (type == "dvl")
    add_dvl(sensor);
  else if (type == "contact")
    sensor.add("bumper");
  else if (type == "force_torque")
    add_force_torque(sensor, from.joint, devices);
  else if (cameras.contains(type))
    add_camera(sensor, type);
  else
    return false;
  return true;
}

void add_sensor(const SdfSensor& from, SdfDevices& devices) {
  SensorReading sensor(from, devices);
  const std::string type = type_of_sensor(sensor.element());
  if (add_known_sensor(from, type, sensor, devices))
    return sensor.note_others(sensor.element(), {"pose",         "update_rate",
                                                 "always_on",    "visualize",
                                                 "topic",        "enable_metrics",
                                                 "gz_frame_id",  "ignition_frame_id",
                                                 "frame_id",     "camera_info_topic",
                                                 "imu",          "gps",
                                                 "navsat",       "ray",
                                                 "lidar",        "camera",
                                                 "magnetometer", "air_pressure",
                                                 "contact",      "force_torque",
                                                 "gz:dvl",       "ignition:dvl"});
  const std::string why = type == "altimeter" ? "that of Shoal is a sonar; `pressure` and `gps` have heights"
                                              : "no device of Shoal is like it";
  sensor.note(sensor.element(),
              fmt::format("a sensor of type '{}' is not imported: {}", sim::shortened(sim::printable(type)), why));
}

}  // namespace

std::string noise_text(const XmlElement& noise, double unit, std::vector<ImportNote>& notes) {
  const std::string type = noise.text("type", noise.child_text("type", "none"));
  if (type == "none") return "";
  if (type != "gaussian" && type != "gaussian_quantized") {
    notes.push_back({noise.place(), "noise of type '" + sim::shortened(sim::printable(type)) + "' is not imported"});
    return "";
  }
  const auto value = [&](const char* name) { return unit * noise.child_number(name).value_or(0); };
  FlowMap map;
  if (value("mean") != 0) map.add("bias", value("mean"));
  if (value("stddev") > 0) map.add("gaussian_std", value("stddev"));
  const double bias_std = std::hypot(value("bias_mean"), value("bias_stddev"));
  if (bias_std > 0) map.add("bias_std", bias_std);
  const double time_s = noise.child_number("dynamic_bias_correlation_time").value_or(0);
  if (value("dynamic_bias_stddev") > 0 && time_s > 0) {
    map.add("gauss_markov_std", value("dynamic_bias_stddev") * std::sqrt(time_s / 2));
    map.add("gauss_markov_time_s", time_s);
  }
  if (value("precision") > 0) map.add("quantization", value("precision"));
  return map.empty() ? "" : map.text();
}

SdfDevices::SdfDevices(ImportedVehicle& vehicle) : vehicle_(vehicle), names_("sensor", {"joints", "group", "player"}) {
  std::vector<ImportNote> none;
  for (const ImportedJoint& joint : vehicle.joints) names_.add(joint.name, joint.place, none);
}

bool SdfDevices::add(const XmlElement& element, const std::string& name, const std::string& type,
                     const std::string& link, const sim::Pose& X_LS, const YamlEntries& keys) {
  const auto place = vehicle_.links.find(link);
  if (place == vehicle_.links.end() || place->second.body.empty()) {
    vehicle_.notes.push_back({element.place(), element.who() + ": it is not imported: its link was left out"});
    return false;
  }
  const std::string& body = place->second.body;
  vehicle_.devices.push_back({names_.add(name, element.place(), vehicle_.notes), type,
                              body == vehicle_.bodies.front().name ? "" : body, place->second.X_BL * X_LS, keys});
  return true;
}

void add_sensors(const SdfModel& model, SdfDevices& devices) {
  for (const SdfSensor& sensor : model.sensors) {
    try {
      add_sensor(sensor, devices);
    } catch (const sim::ConfigError& error) {
      // A wrong value of a sensor leaves out that sensor.
      const std::string text = error.what();
      const std::size_t place = text.find(": ", sensor.element.place().file->size());
      devices.vehicle().notes.push_back(
          {sensor.element.place(), text.substr(place + 2) + ": this sensor is not imported"});
    }
  }
}

}  // namespace tools
