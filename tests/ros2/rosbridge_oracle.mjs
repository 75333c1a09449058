// SPDX-License-Identifier: BSD-3-Clause
// Connects to a run as web pages do, by roslib: subscribes to every topic, asks rosapi, drives the rover by a Twist and
// by its own command, and measures latency and CPU.
//
// usage: node rosbridge_oracle.mjs SHOAL WORLD.yaml
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import roslib from "roslib";

import { check, Server, until, upgradeStatus } from "./foxglove_client.mjs";

const [shoal, world, many] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "shoal-rosbridge-"));
const alone = ["--bus", "none", "--view-port", "0"];

/** Connection by roslib, as its documentation shows it. */
async function connect(port, path = "") {
  const ros = new roslib.Ros({ url: `ws://127.0.0.1:${port}${path}` });
  ros.statuses = [];
  ros.on("error", (error) => (ros.failed = error));
  // An answer to a message with an id is an event of its own.
  ros.onAny((event, status) => String(event).startsWith("status") && ros.statuses.push(status));
  await until(() => ros.isConnected || ros.failed, "connection");
  check(ros.isConnected, `connected: ${ros.failed?.message}`);
  return ros;
}

const promised = (call) => new Promise((resolve, reject) => call(resolve, reject));
const topic = (ros, name, messageType, more = {}) => new roslib.Topic({ ros, name, messageType, ...more });

/** The messages of a topic; `last` and `all`. */
function subscribe(ros, name, type, more) {
  const seen = { all: [], topic: topic(ros, name, type, more) };
  seen.topic.subscribe((message) => {
    seen.last = message;
    seen.all.push(message);
  });
  return seen;
}

/** A message has the members of its type, by message_details, and an array where the type has one. */
function checkMessage(message, type, details, where) {
  const definition = details.find((each) => each.type === type.replace("/msg/", "/"));
  check(definition !== undefined, `${where}: type ${type}`);
  check(Object.keys(message).join() === definition.fieldnames.join(), `${where}: members ${Object.keys(message)}`);
  definition.fieldnames.forEach((name, i) => {
    const value = message[name];
    const fieldType = definition.fieldtypes[i];
    const isArray = definition.fieldarraylen[i] >= 0;
    if (fieldType === "uint8" && isArray) return check(typeof value === "string", `${where}.${name}: base64`);
    check(Array.isArray(value) === isArray, `${where}.${name}: array`);
    for (const item of isArray ? value : [value]) {
      if (fieldType.includes("/")) checkMessage(item, fieldType, details, `${where}.${name}`);
      else if (fieldType === "string") check(typeof item === "string", `${where}.${name}: text`);
      else if (fieldType === "bool") check(typeof item === "boolean", `${where}.${name}: truth value`);
      else check(typeof item === "number" || (fieldType.startsWith("float") && item === null), `${where}.${name}: number`);
    }
  });
}

async function checkTopics() {
  const server = await new Server(shoal, ["run", world, "--rosbridge", ...alone]).open();
  try {
    check((await upgradeStatus(server.port, undefined)).status === 101, "no subprotocol");
    check((await upgradeStatus(server.port, undefined, "https://example.org")).status === 403, "origin of others");
    const ros = await connect(server.port, "/rosbridge");
    const scans = subscribe(ros, "/rover1/lidar/scan", "sensor_msgs/LaserScan");
    await until(() => scans.all.length >= 3, "scans");
    const { topics, types } = await promised((ok, failed) => ros.getTopics(ok, failed));
    check(topics.includes("/rover1/lidar/scan") && topics.includes("/rover1/cmd_vel"), "topics");
    check(await promised((ok) => ros.getTopicType("/rover1/lidar/scan", ok)) === "sensor_msgs/msg/LaserScan", "type");
    check((await promised((ok) => ros.getNodes(ok))).join() === "/shoal", "nodes");
    check((await promised((ok) => ros.getServices(ok))).includes("/rosapi/topics"), "services");
    check((await promised((ok) => ros.getTopicsForType("nav_msgs/msg/Odometry", ok))).length > 0, "topics of a type");
    // Every topic with a message is of its type
    const all = topics.map((name, i) => ({ name, type: types[i], seen: subscribe(ros, name, types[i]) }));
    await until(() => all.filter(({ seen }) => seen.last).length > 8, "messages");
    let checked = 0;
    for (const { name, type, seen } of all) {
      if (!seen.last) continue;
      const details = await promised((ok, failed) => ros.getMessageDetails(type, ok, failed));
      seen.all.forEach((message) => checkMessage(message, type.replace("/msg/", "/"), details, name));
      ++checked;
    }
    // Control is off: each attempt says so
    topic(ros, "/rover1/cmd_vel", "geometry_msgs/Twist").publish({ linear: { x: 1 } });
    await until(() => ros.statuses.some(({ msg }) => /control is off/.test(msg)), "refusal");
    check(ros.statuses.every(({ msg }) => /control is off/.test(msg)), `statuses: ${JSON.stringify(ros.statuses[0])}`);
    const pause = new roslib.Service({ ros, name: "/shoal/pause", serviceType: "shoal_interfaces/Pause" });
    const refused = await promised((ok) => pause.callService(new roslib.ServiceRequest({}), () => ok(""), ok));
    check(/control is off/.test(refused), `pause: ${refused}`);
    ros.close();
    return `${checked} topics`;
  } finally {
    await server.end();
  }
}

async function checkControl() {
  const record = join(folder, "run.lcm");
  const server = await new Server(shoal, ["run", world, "--rosbridge-control", "--duration", "600", "--speed", "1", "--record", record, ...alone]).open();
  const ros = await connect(server.port);
  const odometry = subscribe(ros, "/rover1/odometry/odometry", "nav_msgs/Odometry");
  await until(() => odometry.last, "odometry");
  const drive = topic(ros, "/rover1/cmd_vel", "geometry_msgs/Twist");
  drive.advertise();
  const twist = new roslib.Message({ linear: { x: 0.5, y: 0, z: 0 }, angular: { x: 0, y: 0, z: 0.4 } });
  const drives = setInterval(() => drive.publish(twist), 100);
  await until(() => odometry.last.twist.twist.angular.z > 0.2, "a turn to the left");
  await until(() => odometry.last.pose.pose.position.x > 0.1, "a way ahead");
  clearInterval(drives);
  // The own type of the device
  const command = topic(ros, "/rover1/drive/cmd", "shoal_interfaces/msg/TwistCommand");
  const backs = setInterval(() => command.publish(new roslib.Message({ forward_mps: -0.5 })), 100);
  const farthest = odometry.last.pose.pose.position.x;
  await until(() => odometry.last.pose.pose.position.x < farthest - 0.1, "a way back");
  clearInterval(backs);
  // A service of the run
  const call = (name, request) =>
    promised((ok, failed) =>
      new roslib.Service({ ros, name, serviceType: "" }).callService(new roslib.ServiceRequest(request), ok, failed),
    );
  check((await call("/shoal/pause", {})).success, "pause");
  const refused = await call("/shoal/do", { action: "nothing: {" });
  check(!refused.success && refused.message.length > 0, "do");
  // Throttled: in 2 s of simulated time at most 1 + 2 messages of each 1000 ms
  const slow = subscribe(ros, "/sim/state", "shoal_interfaces/SimState", { throttle_rate: 3_600_000 });
  check((await call("/shoal/resume", {})).success, "resume");
  const before = odometry.all.length;
  await until(() => odometry.all.length > before + 20, "odometry goes on");
  check(slow.all.length <= 1, `throttled: ${slow.all.length}`);
  check(ros.statuses.length === 0, `statuses: ${JSON.stringify(ros.statuses[0])}`);
  ros.close();
  check((await server.end()) === 130, server.output);
  const replay = new Server(shoal, ["replay", record]);
  check((await replay.exit) === 0, replay.output);
  return /equal for \d+ steps/.exec(replay.output)?.[0];
}

/** CPU time of a process, s. */
function cpu_s(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

/** Time from a call to its answer, both ways through the server and roslib, ms: the median, and of 99 %. */
async function measureLatency() {
  const server = await new Server(shoal, ["run", world, "--rosbridge", "--speed", "1", ...alone]).open();
  const ros = await connect(server.port);
  const time = new roslib.Service({ ros, name: "/rosapi/get_time", serviceType: "rosapi_msgs/GetTime" });
  const times = [];
  for (let i = 0; i < 3000; ++i) {
    const begin = performance.now();
    await promised((ok, failed) => time.callService(new roslib.ServiceRequest({}), ok, failed));
    times.push(performance.now() - begin);
  }
  ros.close();
  await server.end();
  times.sort((a, b) => a - b);
  return `round trip ${times[1500].toFixed(3)} ms, of 99 % ${times[2970].toFixed(3)} ms`;
}

/** Cost of a client that reads all but images and clouds; in parentheses the same run without a client. */
async function measure() {
  const seconds = 10;
  const used = [];
  let messages = 0;
  for (const watches of [false, true]) {
    const server = await new Server(shoal, ["run", many, "--rosbridge", "--speed", "1", ...alone]).open();
    let ros;
    if (watches) {
      ros = await connect(server.port);
      await until(() => ros.isConnected, "connected");
      const clock = subscribe(ros, "/clock", "rosgraph_msgs/Clock");
      await until(() => clock.all.length > 10, "clock");
      const { topics, types } = await promised((ok, failed) => ros.getTopics(ok, failed));
      topics.forEach((name, i) => {
        if (!/Image|PointCloud|MarkerArray|SimAsset|SimScene/.test(types[i])) topic(ros, name, types[i]).subscribe(() => ++messages);
      });
    }
    await new Promise((resolve) => setTimeout(resolve, 2000));
    const begin = cpu_s(server.child.pid);
    messages = 0;
    await new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
    used.push(cpu_s(server.child.pid) - begin);
    ros?.close();
    await server.end();
  }
  const more = used[1] - used[0];
  return `${(messages / seconds).toFixed(0)} messages/s; ${((100 * more) / seconds).toFixed(1)} % of a core more than ` +
    `${((100 * used[0]) / seconds).toFixed(1)} %; ${((1e6 * more) / messages).toFixed(1)} us of CPU a message`;
}

let failed = 0;
const steps = [["topics", checkTopics], ["control", checkControl]];
if (many !== undefined) steps.push(["latency", measureLatency], ["cost", measure]);
try {
  for (const [name, test] of steps) {
    const started = Date.now();
    try {
      console.log(`${name.padEnd(20)} ${await test()}, ${((Date.now() - started) / 1000).toFixed(1)} s`);
    } catch (error) {
      console.error(`${name}: ${error.message ?? error}`);
      ++failed;
    }
  }
} finally {
  rmSync(folder, { recursive: true });
}
process.exit(failed === 0 ? 0 : 1);
