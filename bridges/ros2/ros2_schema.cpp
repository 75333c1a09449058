// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/ros2_schema.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "bridges/ros2/ros2_names.hpp"

namespace bridges::ros2 {
namespace {

std::string base_type(const shoal::Member& member) {
  using shoal::WireType;
  switch (member.type) {
    case WireType::boolean:
      return "bool";
    case WireType::byte:
      return "uint8";
    case WireType::int8:
      return "int8";
    case WireType::int16:
      return "int16";
    case WireType::int32:
      return "int32";
    case WireType::int64:
      return "int64";
    case WireType::float32:
      return "float32";
    case WireType::float64:
      return "float64";
    case WireType::string:
      return "string";
    case WireType::compound:
      return short_type_name(member.compound->name);
  }
  return "uint8";
}

std::string array_suffix(const shoal::Member& member) {
  if (member.dimensions.empty()) return "";
  if (member.is_variable()) return "[]";
  std::uint64_t count = 1;
  for (const shoal::Dimension& dimension : member.dimensions) count *= static_cast<std::uint64_t>(dimension.constant);
  return "[" + std::to_string(count) + "]";
}

/// A comment of one line.
std::string comment_of(const std::string& text) {
  if (text.empty()) return "";
  std::string line = text;
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return "  # " + line;
}

std::string definition(const shoal::MessageSchema& schema) {
  if (schema.members.empty()) return std::string("uint8 ") + only_member + "\n";
  const std::vector<std::string> names = field_names(schema);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const shoal::Member& member = schema.members[i];
    text += base_type(member) + array_suffix(member) + " " + names[i] + comment_of(member.comment) + "\n";
  }
  return text;
}

/// Adds the types that a type uses, before those that these use.
void add_used(const shoal::MessageSchema& schema, std::vector<const shoal::MessageSchema*>& used,
              std::set<const shoal::MessageSchema*>& known) {
  std::vector<const shoal::MessageSchema*> fresh;
  for (const shoal::Member& member : schema.members)
    if (member.compound != nullptr && known.insert(member.compound).second) fresh.push_back(member.compound);
  used.insert(used.end(), fresh.begin(), fresh.end());
  for (const shoal::MessageSchema* each : fresh) add_used(*each, used, known);
}

}  // namespace

std::string schema_text(const shoal::MessageSchema& schema) {
  std::vector<const shoal::MessageSchema*> used;
  std::set<const shoal::MessageSchema*> known{&schema};
  add_used(schema, used, known);
  std::string text = definition(schema);
  for (const shoal::MessageSchema* each : used)
    text += schema_separator + "MSG: " + short_type_name(each->name) + "\n" + definition(*each);
  return text;
}

namespace {

struct StandardType {
  std::string_view name, definition;
};

/// The interfaces of ROS 2 Jazzy that converters use: members, and the constants that a viewer shows.
constexpr std::array standard_types{
    StandardType{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    StandardType{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    StandardType{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    StandardType{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    StandardType{"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    StandardType{"geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    StandardType{"geometry_msgs/TransformStamped",
                 "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    StandardType{"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    StandardType{"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    StandardType{"geometry_msgs/PoseWithCovarianceStamped",
                 "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
    StandardType{"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    StandardType{"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    StandardType{"geometry_msgs/TwistWithCovarianceStamped",
                 "std_msgs/Header header\ngeometry_msgs/TwistWithCovariance twist\n"},
    StandardType{"geometry_msgs/TwistStamped", "std_msgs/Header header\ngeometry_msgs/Twist twist\n"},
    StandardType{"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    StandardType{"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    StandardType{"nav_msgs/Odometry",
                 "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
                 "geometry_msgs/TwistWithCovariance twist\n"},
    StandardType{"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    StandardType{"sensor_msgs/NavSatStatus",
                 "int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\n"
                 "int8 status\nuint16 SERVICE_GPS=1\nuint16 service\n"},
    StandardType{"sensor_msgs/NavSatFix",
                 "std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\nfloat64 longitude\n"
                 "float64 altitude\nfloat64[9] position_covariance\nuint8 COVARIANCE_TYPE_UNKNOWN=0\n"
                 "uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\nuint8 position_covariance_type\n"},
    StandardType{"sensor_msgs/Imu",
                 "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
                 "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
                 "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n"},
    StandardType{"sensor_msgs/LaserScan",
                 "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
                 "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
                 "float32[] ranges\nfloat32[] intensities\n"},
    StandardType{"sensor_msgs/PointField",
                 "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
                 "uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    StandardType{"sensor_msgs/PointCloud2",
                 "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
                 "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    StandardType{"sensor_msgs/Image",
                 "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
                 "uint32 step\nuint8[] data\n"},
    StandardType{"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    StandardType{"sensor_msgs/RegionOfInterest",
                 "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"},
    StandardType{"sensor_msgs/CameraInfo",
                 "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\n"
                 "float64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\n"
                 "sensor_msgs/RegionOfInterest roi\n"},
    StandardType{"sensor_msgs/JointState",
                 "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"},
    StandardType{"sensor_msgs/Range",
                 "std_msgs/Header header\nuint8 ULTRASOUND=0\nuint8 INFRARED=1\nuint8 radiation_type\n"
                 "float32 field_of_view\nfloat32 min_range\nfloat32 max_range\nfloat32 range\nfloat32 variance\n"},
    StandardType{"sensor_msgs/FluidPressure", "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n"},
    StandardType{"sensor_msgs/Temperature", "std_msgs/Header header\nfloat64 temperature\nfloat64 variance\n"},
    StandardType{"sensor_msgs/MagneticField",
                 "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\n"
                 "float64[9] magnetic_field_covariance\n"},
    StandardType{"sensor_msgs/BatteryState",
                 "std_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\nfloat32 charge\n"
                 "float32 capacity\nfloat32 design_capacity\nfloat32 percentage\n"
                 "uint8 POWER_SUPPLY_STATUS_DISCHARGING=2\nuint8 power_supply_status\n"
                 "uint8 power_supply_health\nuint8 power_supply_technology\nbool present\n"
                 "float32[] cell_voltage\nfloat32[] cell_temperature\nstring location\nstring serial_number\n"},
    StandardType{"std_msgs/Float64", "float64 data\n"},
    StandardType{"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
    StandardType{"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    StandardType{"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
    StandardType{"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
    StandardType{"visualization_msgs/Marker",
                 "int32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 TRIANGLE_LIST=11\n"
                 "int32 ADD=0\nint32 DELETE=2\nint32 DELETEALL=3\n"
                 "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n"
                 "geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\n"
                 "bool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\n"
                 "string texture_resource\nsensor_msgs/CompressedImage texture\n"
                 "visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\n"
                 "visualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n"},
    StandardType{"visualization_msgs/MarkerArray", "visualization_msgs/Marker[] markers\n"},
    StandardType{"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
    StandardType{"rcl_interfaces/Log",
                 "byte DEBUG=10\nbyte INFO=20\nbyte WARN=30\nbyte ERROR=40\nbyte FATAL=50\n"
                 "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\n"
                 "string function\nuint32 line\n"},
};

std::string_view definition_of(std::string_view name) {
  for (const StandardType& type : standard_types)
    if (type.name == name) return type.definition;
  throw std::out_of_range("no standard type " + std::string(name));
}

/// Adds the types that a definition uses, in the order of their first use, each before those that it uses.
void add_used(std::string_view definition, std::vector<std::string>& used, std::set<std::string>& known) {
  std::istringstream lines{std::string(definition)};
  std::vector<std::string> fresh;
  for (std::string line; std::getline(lines, line);) {
    const std::string type = line.substr(0, line.find_first_of(" ["));
    if (type.find('/') != std::string::npos && known.insert(type).second) fresh.push_back(type);
  }
  used.insert(used.end(), fresh.begin(), fresh.end());
  for (const std::string& each : fresh) add_used(definition_of(each), used, known);
}

}  // namespace

std::string standard_schema_text(std::string_view type) {
  std::string name(type);
  if (const std::size_t at = name.find("/msg/"); at != std::string::npos) name.erase(at, 4);
  std::vector<std::string> used;
  std::set<std::string> known;
  std::string text(definition_of(name));
  add_used(text, used, known);
  for (const std::string& each : used)
    text.append(schema_separator).append("MSG: ").append(each).append("\n").append(definition_of(each));
  return text;
}

}  // namespace bridges::ros2
