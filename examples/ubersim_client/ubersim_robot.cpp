// SPDX-License-Identifier: BSD-3-Clause
#include "ubersim_robot.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>
#include <string_view>
#include <vector>

namespace ubersim {
namespace {

using tinyxml2::XMLElement;
using Vector = std::array<double, 3>;

std::string text_of(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string text_of(const Vector& vector) {
  return "[" + text_of(vector[0]) + ", " + text_of(vector[1]) + ", " + text_of(vector[2]) + "]";
}

std::string shortened(const std::string& text) {
  return text.substr(0, 40);
}

std::string shown(const XMLElement& element) {
  const char* name = element.Attribute("name");
  return "<" + shortened(element.Name()) + ">" + (name != nullptr ? " '" + shortened(name) + "'" : "");
}

const XMLElement& child(const XMLElement& parent, const char* tag) {
  const XMLElement* found = parent.FirstChildElement(tag);
  int count = 0;
  for (const XMLElement* each = found; each != nullptr; each = each->NextSiblingElement(tag)) ++count;
  if (count == 1) return *found;
  throw Refused(shown(parent) + " must have one <" + tag + ">, got " + std::to_string(count));
}

/// Returns the text of a child element without blanks around it.
std::string text_in(const XMLElement& parent, const char* tag) {
  const char* found = child(parent, tag).GetText();
  const std::string text = found != nullptr ? found : "";
  const std::size_t first = text.find_first_not_of(" \t\r\n"), last = text.find_last_not_of(" \t\r\n");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

double number(const XMLElement& parent, const char* tag, double low = -1e3) {
  const std::string text = text_in(parent, tag);
  const std::string_view digits(text.data(), text.ends_with('f') ? text.size() - 1 : text.size());  // printed: 1.5708f
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc() && end == digits.data() + digits.size() && value >= low && value <= 1e3) return value;
  throw Refused(shown(parent) + ": <" + tag + "> must be a number from " + text_of(low) + " to 1000, got '" +
                shortened(text) + "'");
}

/// The paper has x to the right and y forward, Shoal x forward and y to the left.
Vector vector(const XMLElement& parent, const char* tag) {
  const XMLElement& element = child(parent, tag);
  return {number(element, "y"), 0 - number(element, "x"), number(element, "z")};
}

std::string name_of(const XMLElement& element) {
  const char* found = element.Attribute("name");
  const std::string name = found != nullptr ? found : "";
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const bool is_name =
      !name.empty() && name.size() < 32 && is_letter(name[0]) &&
      std::all_of(name.begin(), name.end(), [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
  if (is_name) return name;
  throw Refused("<" + std::string(element.Name()) + "> must have a name of 1 to 31 letters, digits and _, got '" +
                shortened(name) + "'");
}

/// The turn of <Orientation>, which must be about one axis.
Vector rpy_deg(const XMLElement& parent) {
  if (parent.FirstChildElement("Orientation") == nullptr) return {};
  const XMLElement& turn = child(parent, "Orientation");
  const Vector axis = vector(turn, "axis");
  Vector sizes{std::abs(axis[0]), std::abs(axis[1]), std::abs(axis[2])};
  std::sort(sizes.begin(), sizes.end());
  if (sizes != Vector{0, 0, 1}) throw Refused(shown(parent) + ": <axis> must be one of x, y and z");
  const double angle_deg = number(turn, "angle") * (180 / std::numbers::pi);
  return {0 + angle_deg * axis[0], 0 + angle_deg * axis[1], 0 + angle_deg * axis[2]};
}

struct Part {
  bool is_wheel = false;
  double mass_kg = 0, radius_m = 0;
  Vector position_m{};
};

bool is_one_of(std::string_view tag, std::initializer_list<std::string_view> tags) {
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

bool is_solid(const XMLElement& element) {
  return is_one_of(element.Name(), {"Box", "Sphere", "Cylinder"});
}

std::vector<const XMLElement*> children(const XMLElement& parent, std::initializer_list<std::string_view> tags) {
  std::vector<const XMLElement*> found;
  for (const XMLElement* each = parent.FirstChildElement(); each != nullptr; each = each->NextSiblingElement()) {
    found.push_back(each);
    if (is_one_of(each->Name(), tags)) continue;
    std::string known;
    for (const std::string_view tag : tags) known += (known.empty() ? "" : ", ") + std::string(tag);
    throw Refused(shown(parent) + " cannot have a <" + shortened(each->Name()) + ">, only: " + known);
  }
  return found;
}

/// The YAML of a robot, and what its balance depends on.
class Model {
 public:
  explicit Model(int width) : width_(width) {}

  void add_body(const XMLElement& body) {
    const std::string name = name_of(body);
    bodies_ += (bodies_.empty() ? "{name: " : ", {name: ") + name + ", parts: [";
    const char* between = "";
    for (const XMLElement* each : children(body, {"Box", "Sphere", "Cylinder", "Inclinometer", "CameraSensor"})) {
      if (!is_solid(*each)) {
        add_device(*each, name);
        continue;
      }
      bodies_ += between;
      add_part(*each);
      between = ", ";
    }
    bodies_ += "]}";
    if (first_body_parts_ == 0) first_body_parts_ = parts_.size();
  }

  void add_joint(const XMLElement& joint) {
    const std::string name = name_of(joint), tag = joint.Name();
    joints_ += (joints_.empty() ? "{name: " : ", {name: ") + name + ", bodies: [\"" + body_named(joint, "Body1") +
               "\", \"" + body_named(joint, "Body2") + "\"], anchor_m: " + text_of(vector(joint, "AnchorPos"));
    if (tag == "JointBallSocket") {
      joints_ += ", type: ball}";
      return;
    }
    const Vector axis2 = vector(joint, "Axis2");
    joints_ += ", type: hinge2, axis: " + text_of(vector(joint, "Axis1")) +
               ", axis2: {axis: " + text_of(Vector{0 - axis2[0], 0 - axis2[1], 0 - axis2[2]}) + "}}";  // forward
    start_device(name);
    devices_ += ", type: joint_drive, joint: " + name +
                ", axes: [1], max_velocity: 20, max_force: " + text_of(max_torque_Nm) + "}";
  }

  /// Latency of commands in s.
  std::string yaml(double latency_s) const {
    return "{shoal: 1, actuator_latency_s: " + text_of(latency_s) + ", bodies: [" + bodies_ + "], joints: [" + joints_ +
           "], devices: [" + devices_ + "]}";
  }
  const Part& wheel() const {
    const auto found = std::find_if(parts_.begin(), parts_.end(), [](const Part& each) { return each.is_wheel; });
    if (found == parts_.end()) throw Refused("<Entity> must have a <Cylinder>, a wheel");
    return *found;
  }
  /// Height of the origin when the wheels stand on the ground.
  double height_m() const {
    double height_m = wheel().radius_m - wheel().position_m[2];
    for (const Part& each : parts_)
      if (each.is_wheel) height_m = std::max(height_m, each.radius_m - each.position_m[2]);
    return height_m;
  }
  /// The tilt at which the center of mass of the first body is above the axle.
  double balanced_tilt_rad() const {
    double mass_kg = 0, x = 0, z = 0;
    for (std::size_t i = 0; i < first_body_parts_; ++i) {
      mass_kg += parts_[i].mass_kg;
      x += parts_[i].mass_kg * parts_[i].position_m[0];
      z += parts_[i].mass_kg * parts_[i].position_m[2];
    }
    if (mass_kg == 0) throw Refused("the first <Body> must have a mass");
    return -std::atan2(x / mass_kg, z / mass_kg - wheel().position_m[2]);
  }

 private:
  void add_part(const XMLElement& element) {
    const std::string tag = element.Name();
    const char* material = element.FirstChildElement("Material") != nullptr ? "Material" : nullptr;
    const bool is_rubber = material != nullptr && text_in(element, material) == "Rubber";
    Part part;
    part.is_wheel = tag == "Cylinder";
    part.mass_kg = number(element, "Mass", 0);
    part.position_m = vector(element, "Position");
    bodies_ += "{name: " + name_of(element) + ", mass_kg: " + text_of(part.mass_kg) +
               ", position_m: " + text_of(part.position_m) + ", color: \"" + (is_rubber ? "#181818" : "#b0b0b8") + "\"";
    if (tag == "Box") {
      const Vector size_m{number(element, "YSize", 0), number(element, "XSize", 0), number(element, "ZSize", 0)};
      bodies_ += ", shape: box, size_m: " + text_of(size_m) + "}";
    } else {
      part.radius_m = number(element, "Radius", 0);
      bodies_ += ", radius_m: " + text_of(part.radius_m);
      // A wheel: the paper turns it about z, which does nothing to a cylinder along z; it is meant to lie along its
      // axle.
      bodies_ +=
          part.is_wheel
              ? ", shape: cylinder, rpy_deg: [90, 0, 0], length_m: " + text_of(number(element, "Length", 0)) + "}"
              : std::string(", shape: sphere}");
    }
    parts_.push_back(part);
  }

  void start_device(const std::string& name) { devices_ += (devices_.empty() ? "{name: " : ", {name: ") + name; }

  void add_device(const XMLElement& element, const std::string& body) {
    start_device(name_of(element));
    devices_ += ", body: " + body + ", phase_s: 0";
    if (std::string_view(element.Name()) == "Inclinometer") {
      devices_ += ", type: inclinometer, ideal: true, rate_hz: 100}";
      return;
    }
    devices_ += ", type: camera, rate_hz: 20, width: " + std::to_string(width_) +
                ", height: " + std::to_string(width_ * 3 / 4) + ", fov_deg: " + text_of(number(element, "Fov", 0)) +
                ", position_m: " + text_of(vector(element, "Position")) + ", rpy_deg: " + text_of(rpy_deg(element)) +
                "}";
  }

  /// The name of a body, which the simulator checks, without what would end its quotes.
  static std::string body_named(const XMLElement& joint, const char* tag) {
    std::string name = text_in(joint, tag);
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '"' || c == '\\' || (c >= 0 && c < ' '); }, '_');
    return name;
  }

  int width_;
  std::string bodies_, joints_, devices_;
  std::vector<Part> parts_;
  std::size_t first_body_parts_ = 0;
};

std::string read_text(const std::string& path) {
  constexpr std::size_t max_bytes = 1'000'000;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Refused("cannot be read");
  std::string text(max_bytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > max_bytes || text.find("<!DOCTYPE") != std::string::npos)
    throw Refused("the XML must have at most 1 MB and no <!DOCTYPE>");
  return text;
}

}  // namespace

std::string Robot::entry() const {
  return "{name: \"" + name + "\", with_client: true, position_m: " + text_of(position_m) +
         ", rpy_deg: " + text_of(rpy_deg) + ", model: " + model + "}";
}

Robot read_robot(const std::string& path, int width) {
  tinyxml2::XMLDocument document;
  const std::string text = read_text(path);
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || document.RootElement() == nullptr)
    throw Refused("no XML: " + std::string(document.ErrorName()) + ", line " + std::to_string(document.ErrorLineNum()));
  const XMLElement& root = *document.RootElement();
  const XMLElement& settings = child(root, "CSettings");
  const XMLElement& entity = child(root, "Entity");

  Model model(width);
  for (const XMLElement* body : children(child(entity, "RigidBodyes"), {"Body"}))  // spelled as printed
    model.add_body(*body);
  for (const XMLElement* joint : children(child(entity, "Joints"), {"JointHinge2", "JointBallSocket"}))
    model.add_joint(*joint);

  Robot robot;
  robot.name = text_in(settings, "Name");
  for (char& c : robot.name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  robot.position_m = vector(settings, "Offset");
  robot.position_m[2] += model.height_m();
  robot.rpy_deg = rpy_deg(settings);
  robot.model = model.yaml(number(settings, "LatencyMS", 0) / 1000);
  robot.tilt_rad = model.balanced_tilt_rad();
  robot.radius_m = model.wheel().radius_m;
  return robot;
}

}  // namespace ubersim
