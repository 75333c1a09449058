// SPDX-License-Identifier: BSD-3-Clause
// The conventions of ROS in the standard messages of a record, as its tools take them: one tree of frames (REP 105),
// right-handed axes and unit quaternions (REP 103), limits and misses of ranges (REP 117), what is unknown (REP 145).

function check(condition, text) {
  if (!condition) throw new Error(text);
}

const norm = ({ x, y, z, w }) => Math.hypot(x, y, z, w);
const header = (message) => message.header?.frame_id;

/** Parents of all frames, of `/tf` and `/tf_static`: Map(child, parent). */
function treeOf(topics) {
  const parents = new Map();
  for (const name of ["/tf_static", "/tf"])
    for (const { message } of topics.get(name)?.messages ?? [])
      for (const { header, child_frame_id: child, transform } of message.transforms) {
        const parent = header.frame_id;
        check(Math.abs(norm(transform.rotation) - 1) < 1e-6, `${child}: the quaternion has no unit length`);
        check((parents.get(child) ?? parent) === parent, `${child} has two parents: ${parents.get(child)}, ${parent}`);
        parents.set(child, parent);
      }
  return parents;
}

function isInTree(frame, parents) {
  for (let steps = 0; steps < 100 && frame !== undefined; ++steps) {
    if (frame === "world") return true;
    frame = parents.get(frame);
  }
  return false;
}

const checks = {
  "sensor_msgs/msg/LaserScan": (scan) => {
    check(scan.range_max > scan.range_min && scan.range_max < Infinity, `range_max ${scan.range_max}`);
    for (const range of scan.ranges)
      check(Math.abs(range) === Infinity || (range > scan.range_min - 1e-6 && range < scan.range_max), `range ${range}`);
    const step = (scan.angle_max - scan.angle_min) / Math.max(1, scan.ranges.length - 1);
    check(Math.abs(step - scan.angle_increment) < 1e-5, "the last beam is not at angle_max");
  },
  "sensor_msgs/msg/Range": (range) => {
    check(range.field_of_view > 0 && range.max_range > range.min_range && range.max_range < Infinity, "limits");
    check(range.range === Infinity || (range.range >= range.min_range && range.range <= range.max_range), "range");
  },
  "sensor_msgs/msg/CameraInfo": (info) => {
    check(info.header.frame_id.endsWith("_optical"), "no optical frame");
    check(info.k[0] > 0 && info.k[4] > 0 && info.k[8] === 1 && info.p[0] === info.k[0], "no calibration");
  },
  "sensor_msgs/msg/Imu": (imu) => {
    check(imu.orientation_covariance[0] === -1 || Math.abs(norm(imu.orientation) - 1) < 1e-6, "orientation");
  },
  "sensor_msgs/msg/NavSatFix": (fix) => {
    check(fix.status.status >= 0 || fix.position_covariance_type === 0, "covariance without a fix");
    check(fix.position_covariance.every(Number.isFinite), "covariance");
  },
  "sensor_msgs/msg/BatteryState": (battery) => {
    check(!(battery.percentage < 0 || battery.percentage > 1), "percentage");
  },
  "nav_msgs/msg/Odometry": ({ child_frame_id: child, pose }, parents, name) => {
    // A pose that is of no vehicle is of a frame with the name of its channel.
    check(isInTree(child, parents) || name === `/${child}/odometry`, `the frame ${child} is in no tree`);
    check(Math.abs(norm(pose.pose.orientation) - 1) < 1e-6, "orientation");
  },
  "sensor_msgs/msg/PointCloud2": ({ width, height, point_step: step, data }) => {
    check(data.length === width * height * step, "size");
  },
};

/** Images and their calibrations come in pairs, with equal stamps. */
function checkCameras(topics) {
  for (const [name, { messages }] of topics) {
    if (!name.endsWith("/camera_info")) continue;
    const base = name.slice(0, -"camera_info".length);
    const images = (topics.get(`${base}image`) ?? topics.get(`${base}compressed`))?.messages ?? [];
    check(images.length === messages.length, `${name}: ${messages.length} for ${images.length} images`);
    messages.forEach(({ message }, i) => {
      const { stamp, frame_id: frame } = images[i].message.header;
      check(stamp.sec === message.header.stamp.sec && stamp.nanosec === message.header.stamp.nanosec, `${name}: stamp`);
      check(frame === message.header.frame_id, `${name}: frame`);
    });
  }
}

/** Throws an Error with the first message that breaks a convention; returns how many were examined. */
export function checkConventions(topics) {
  const parents = treeOf(topics);
  let examined = 0;
  for (const [name, { schema, messages }] of topics) {
    if (schema === undefined || schema.name.startsWith("shoal_interfaces/") || name === "/rosout") continue;
    for (const { message } of messages) {
      const frame = header(message);
      try {
        check(frame === undefined || isInTree(frame, parents), `the frame ${frame} is in no tree`);
        checks[schema.name]?.(message, parents, name);
      } catch (error) {
        throw new Error(`${name}: message at ${JSON.stringify(message.header?.stamp)}: ${error.message}`);
      }
      ++examined;
    }
  }
  checkCameras(topics);
  return examined;
}
