// SPDX-License-Identifier: BSD-3-Clause
// Connects to runs of the given worlds as Foxglove, Lichtblick and PlotJuggler do, subscribes to all topics and decodes
// every message; then tests access, services, parameters, playback of a log, a bus, and clients that do not read.
//
// usage: node foxglove_oracle.mjs SHOAL JOBS FOLDER-OF-LAYOUTS WORLD.yaml...
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import { parse } from "@foxglove/rosmsg";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { fileURLToPath } from "node:url";
import WebSocket from "ws";

import { check, older, sdk, Server, until, upgradeStatus, Viewer } from "./foxglove_client.mjs";

const [shoal, jobs, layouts, ...worlds] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "shoal-foxglove-"));
const alone = ["--bus", "none", "--view", "--view-port", "0"];

/** Runs a test with a server that ends with it. */
async function withServer(args, test) {
  const server = new Server(shoal, args);
  try {
    await server.open();
    return await test(server);
  } finally {
    await server.end();
  }
}

function near(a, b) {
  return Math.abs(a - b) <= 1e-9 * Math.max(1, Math.abs(a));
}

/** Poses on /tf are those of sim.state. */
function comparePoses(viewer) {
  const state = viewer.topics.get("/sim/state");
  let compared = 0;
  for (const { message } of state.kept) {
    const stamp = message.utime;
    for (const { message: tf } of viewer.topics.get("/tf").kept) {
      for (const { header, child_frame_id: child, transform } of tf.transforms) {
        if (BigInt(header.stamp.sec) * 1_000_000n + BigInt(header.stamp.nanosec) / 1000n !== stamp) continue;
        const i = message.vehicle.indexOf(child);
        if (i < 0) continue;
        const { x, y, z } = transform.translation;
        const p = message.position_m.slice(3 * i, 3 * i + 3);
        check(near(x, p[0]) && near(y, p[1]) && near(z, p[2]), `/tf of ${child}: ${x} ${y} ${z}, expected ${p}`);
        ++compared;
      }
    }
  }
  return compared;
}

/** The topics that a layout shows exist; those that programs of the world publish are checked by FoxgloveLayout. */
async function checkLayout(viewer, name) {
  const layout = readFileSync(join(layouts, `${name}.json`), "utf8");
  const shown = [...layout.matchAll(/"(\/[a-z_0-9/]+)[".]/g)].map((found) => found[1]);
  const ofLichtblick = ["/move_base_simple/goal", "/clicked_point", "/initialpose"];
  const topics = shown.filter((topic) => !ofLichtblick.includes(topic) && !/\/(estimate|dead_reckoning)\//.test(topic));
  check(topics.length > 5, `${name}.json shows topics`);
  for (const topic of topics) await until(() => viewer.topics.has(topic), `topic ${topic} of ${name}.json`);
}

async function checkWorld(world) {
  return withServer(["run", world, ...alone], async ({ port }) => {
    const viewer = await new Viewer(port).open();
    check(viewer.socket.protocol === sdk, `both names offered: ${viewer.socket.protocol}`);
    // What every world has, and then a second of it
    await viewer.topic("/clock", 10);
    const scene = await viewer.topic("/scene");
    const { markers } = scene.kept[0].message;
    check(markers.length > 1 && markers[0].action === 3, "a scene replaces the one before");
    await viewer.topic("/tf");
    await viewer.topic("/sim/state", 5);
    const hasVehicles = viewer.topics.get("/sim/state").last.vehicle.length > 0;
    if (hasVehicles) await until(() => comparePoses(viewer) > 0, "poses on /tf");
    const layout = { coop_land: "land", coop_underwater: "marine" }[basename(world, ".yaml")];
    if (layout !== undefined) await checkLayout(viewer, layout);
    check(viewer.info.sessionId.length > 0 && viewer.services.size === 0, "no services without permission");
    await until(() => viewer.times.length > 5, "time");
    viewer.times.forEach((time, i) => check(i === 0 || time >= viewer.times[i - 1], "time goes on"));
    viewer.checkErrors();
    const bad = viewer.statuses.filter((status) => !status.message.startsWith("Send buffer limit"));
    check(bad.length === 0, `status: ${bad[0]?.message}`);
    await viewer.close();
    return `${viewer.topics.size} topics, ${viewer.messages} messages decoded, ${markers.length - 1} markers`;
  });
}

async function checkAccess(world) {
  await withServer(["run", world, ...alone], async ({ port }) => {
    const status = async (...request) => (await upgradeStatus(port, ...request)).status;
    check((await status(undefined)) === 400, "no subprotocol: 400");
    check((await status("foxglove.sdk.v9")) === 400, "an unknown subprotocol: 400");
    check((await status(sdk, "https://example.org")) === 403, "foreign origin: 403");
    check((await status(older, "null")) === 403, "origin null: 403");
    for (const origin of ["https://app.foxglove.dev", "http://localhost:8080", "file://", undefined])
      for (const name of [sdk, older]) {
        const { status: code, protocol } = await upgradeStatus(port, name, origin);
        check(code === 101 && protocol === name, `${name} from ${origin}: ${code} ${protocol}`);
      }
    check((await upgradeStatus(port, `${older}, ${sdk}`)).protocol === sdk, "the newer name is preferred");

    // Each name alone, without permission to control
    for (const name of [sdk, older]) {
      const viewer = await new Viewer(port, [name]).open();
      await viewer.topic("/tf", 2);
      const answer = await viewer.call("/shoal/pause", "json", new TextEncoder().encode("{}"));
      check(/--foxglove-control/.test(answer.message), `a call is refused: ${answer.message}`);
      viewer.client.setParameters([{ name: "paused", value: true }], "a");
      await until(() => viewer.statuses.some((each) => /--foxglove-control/.test(each.message)), "refused parameters");
      check(viewer.playback.length === 0, "no playback state");
      await viewer.close();
    }
    // What is not understood is answered, and the connection stays open
    const viewer = await new Viewer(port).open();
    for (const bytes of ["", "{", "[]", '{"op":5}', '{"op":"subscribe","subscriptions":[{"id":1}]}', Buffer.from([7])])
      viewer.socket.send(bytes);
    await until(() => viewer.statuses.length >= 6, "an error for each");
    const { messages } = viewer.topics.get("/tf") ?? (await viewer.topic("/tf"));
    await viewer.topic("/tf", messages + 2);
    await viewer.close();
    // Clients that leave at any moment
    for (let i = 0; i < 100; ++i) {
      const leaver = new WebSocket(`ws://127.0.0.1:${port}`, [i % 2 ? sdk : older]);
      leaver.on("error", () => {});
      setTimeout(() => leaver.terminate(), i % 20);
      await new Promise((resolve) => setTimeout(resolve, 5)); // the server takes 32 clients at once
    }
    const last = await new Viewer(port).open();
    await last.topic("/tf", 2);
    await last.close();
  });
}

/** Calls services and sets parameters; `replay` proves elsewhere that requests of sim.control are part of a run. */
async function checkControl(world) {
  await withServer(["run", world, ...alone, "--foxglove-control"], async ({ port }) => {
    const viewer = await new Viewer(port).open();
    await viewer.topic("/clock", 5);
    for (const each of ["services", "parameters", "parametersSubscribe"])
      check(viewer.info.capabilities.includes(each), `capability ${each}`);
    check(viewer.services.size === 7, `${viewer.services.size} services`);
    const json = (value) => new TextEncoder().encode(JSON.stringify(value));
    const cdr = (name, value) =>
      new MessageWriter(parse(viewer.services.get(name).request.schema, { ros2: true })).writeMessage(value);
    const called = async (name, value) => {
      const answer = await viewer.call(name, "cdr", cdr(name, value));
      check(answer.op !== "serviceCallFailure" && answer.data[4] === 1, `${name} succeeds`);
    };
    viewer.client.subscribeParameterUpdates(["paused", "speed"]);
    await called("/shoal/pause", {});
    await until(() => viewer.parameters.some((each) => each.parameters.some((p) => p.name === "paused" && p.value)), "update");
    // Steps and a rewind, seen by the clock
    const clock = () => viewer.topics.get("/sim/state").last.utime;
    const before = clock();
    await called("/shoal/step", { steps: 1000n });
    await until(() => clock() > before, "steps");
    const times = viewer.times.length;
    await called("/shoal/rewind", { seconds: 1 });
    await until(() => viewer.times.slice(times).some((time, i, all) => i > 0 && time < all[i - 1]) ||
      viewer.times.at(-1) < viewer.times[times - 1], "an earlier time after the rewind");
    // In JSON, and refusals
    const speed = await viewer.call("/shoal/speed", "json", json({ speed: 2 }));
    check(JSON.parse(Buffer.from(speed.data)).success, "speed");
    const refused = await viewer.call("/shoal/do", "json", json({ action: "nothing: {" }));
    check(!JSON.parse(Buffer.from(refused.data)).success, "do");
    check((await viewer.call("/shoal/step", "json", json({ steps: "x" }))).op === "serviceCallFailure", "steps: x");
    viewer.client.setParameters([{ name: "paused", value: false }, { name: "speed", value: 3 }], "both");
    const both = await until(() => viewer.parameters.find((each) => each.id === "both"), "parameters with an id");
    check(both.parameters.find((p) => p.name === "speed").value === 3, "speed is set");
    check(both.parameters.find((p) => p.name === "paused").value === false, "the run goes on");
    viewer.client.setParameters([{ name: "depth", value: 3 }]);
    await until(() => viewer.statuses.some((each) => /unknown parameter 'depth'/.test(each.message)), "unknown parameter");
    viewer.checkErrors();
    await viewer.close();
  });
}

const summaryOf = (path) => JSON.parse(readFileSync(join(path, "summary.json"), "utf8"));

/** Clients change nothing, also one that does not read, which gets a report of what it lost. */
async function checkHash(world) {
  const run = ["run", world, "--bus", "none", "--duration", "20", "--overwrite"];
  const plain = join(folder, "plain");
  const watched = join(folder, "watched");
  check((await new Server(shoal, [...run, "--speed", "max", "--results", plain]).exit) <= 1, "the plain run");
  const server = await new Server(shoal, [...run, "--view", "--view-port", "0", "--speed", "8", "--results", watched]).open();
  const viewers = await Promise.all([1, 2, 3].map(() => new Viewer(server.port).open()));
  const frozen = await new Viewer(server.port).open();
  await frozen.topic("/tf");
  frozen.socket.pause();
  check((await server.exit) <= 1, `the watched run: ${server.output}`);
  frozen.socket.resume();
  for (const viewer of viewers) check(viewer.messages > 100, "a client got messages");
  for (const key of ["run_hash", "state_hash"])
    check(summaryOf(plain)[key] === summaryOf(watched)[key], `${key} with clients`);
}

async function checkLog(world) {
  const log = join(folder, "run.lcm");
  check((await new Server(shoal, ["run", world, "--bus", "none", "--speed", "max", "--duration", "5", "--overwrite", "--record", log]).exit) <= 1, "record");
  await withServer(["view", log, "--view-port", "0"], async ({ port }) => {
    const viewer = await new Viewer(port).open();
    check(!viewer.info.capabilities.includes("playbackControl"), "no playback without permission");
    await viewer.topic("/tf", 5);
    await viewer.close();
  });
  await withServer(["view", log, "--view-port", "0", "--foxglove-control"], async ({ port }) => {
    const viewer = await new Viewer(port).open();
    check(viewer.info.capabilities.includes("playbackControl"), "capability playbackControl");
    const ns = ({ sec, nsec }) => BigInt(sec) * 1_000_000_000n + BigInt(nsec);
    const start = ns(viewer.info.dataStartTime);
    const end = ns(viewer.info.dataEndTime);
    check(end - start >= 4_900_000_000n && end - start <= 5_000_000_000n, `length of the log: ${end - start} ns`);
    await viewer.topic("/tf", 5);
    check(viewer.playback.length === 0, "no playback state before a request");
    const paused = await viewer.play({ plays: false, seek: start + 2_000_000_000n, id: "seek" });
    check(paused.status === 1 && paused.didSeek && paused.now === start + 2_000_000_000n, "paused at 2 s");
    await until(() => viewer.times.at(-1) === start + 2_000_000_000n, "the time of the seek");
    const tf = viewer.topics.get("/tf");
    await until(() => tf.lastTime > start + 1_800_000_000n && tf.lastTime <= start + 2_000_000_000n, "poses at 2 s");
    const playing = await viewer.play({ plays: true, speed: 4, id: "go" });
    check(playing.status === 0 && playing.speed === 4 && !playing.didSeek, "plays at 4");
    await until(() => viewer.times.at(-1) === end, "the end");
    await until(() => viewer.playback.at(-1).readUInt8(1) === 3, "the state 'ended'");
    viewer.errors = viewer.errors.filter((text) => !/Unrecognized server opcode/.test(text));
    viewer.checkErrors();
    await viewer.close();
  });
}

async function checkBus(world) {
  // tools/test_foxglove puts it beside this file.  The ports are ours until its input ends.
  const ports = spawn("python3", [fileURLToPath(new URL("own_ports.py", import.meta.url))]);
  ports.stderr.pipe(process.stderr);
  const [line] = await Promise.race([once(ports.stdout, "data"), once(ports.stdout, "end")]);
  check(line !== undefined, "own_ports.py gives a URL");
  const url = String(line).trim();
  const run = new Server(shoal, ["run", world, "--lcm-url", url, "--speed", "1", "--quiet"]);
  try {
    await withServer(["view", "--lcm-url", url, "--view-port", "0"], async ({ port }) => {
      const viewer = await new Viewer(port).open();
      await viewer.topic("/scene");
      await viewer.topic("/tf", 5);
      const { lastTime, last } = await viewer.topic("/clock", 5);
      const clock = BigInt(last.clock.sec) * 1_000_000_000n + BigInt(last.clock.nanosec);
      check(lastTime === clock, "log times are simulated");
      viewer.checkErrors();
      await viewer.close();
    });
  } finally {
    await run.end();
    ports.stdin.end();
  }
}

let failed = 0;
async function step(name, test) {
  const started = Date.now();
  try {
    const result = await test();
    console.log(`${name.padEnd(20)} ${result ?? "ok"}, ${((Date.now() - started) / 1000).toFixed(1)} s`);
  } catch (error) {
    console.error(`${name}: ${error.message}`);
    ++failed;
  }
}

try {
  const steps = worlds.map((world) => [basename(world, ".yaml"), () => checkWorld(world)]);
  const usual = worlds.find((each) => each.endsWith("coop_land.yaml")) ?? worlds[0];
  steps.push(
    ["access", () => checkAccess(usual)],
    ["control", () => checkControl(usual)],
    ["hash", () => checkHash(usual)],
    ["log", () => checkLog(usual)],
    ["bus", () => checkBus(usual)],
  );
  await Promise.all(
    Array.from({ length: Number(jobs) }, async () => {
      for (let next = steps.shift(); next !== undefined; next = steps.shift()) await step(...next);
    }),
  );
} finally {
  rmSync(folder, { recursive: true });
}
process.exitCode = failed === 0 && worlds.length > 0 ? 0 : 1;
