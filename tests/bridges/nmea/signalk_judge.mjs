// SPDX-License-Identifier: BSD-3-Clause
// Signal K server beside a run of examples/nmea/traffic.yaml: what it has of the own ship and of the others, by sentences
// of shoal-nmea.  In a network namespace of its own, as the server listens at all addresses.
//
// usage: node signalk_judge.mjs SIGNALK_SERVER FOLDER BIN WORLD     FOLDER: for the settings of the server
import { spawn } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";

const [server, folder, bin, world] = process.argv.slice(2);
const nmeaPort = 10110, httpPort = 3000;
const vessels = `http://127.0.0.1:${httpPort}/signalk/v1/api/vessels`;
const children = [];

function start(program, args, env = {}) {
  const child = spawn(program, args, { stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, ...env } });
  child.text = "";
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (text) => (child.text += text));
  child.ended = new Promise((resolve) => child.on("close", (code) => resolve((child.over = code ?? -1))));
  children.push(child);
  return child;
}

/** Waits for a condition, no longer than two minutes. */
async function until(condition, what) {
  for (const end = Date.now() + 120_000; Date.now() < end; ) {
    const found = await condition();
    if (found) return found;
    const dead = children.find((each) => each.over !== undefined);
    if (dead) throw new Error(`${dead.spawnfile} ended with ${dead.over}: ${dead.text}`);
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  throw new Error(`${what}: not within 120 s\n${children.map((each) => each.text).join("\n")}`);
}

/** All vessels; none while the server does not answer. */
const read = () => fetch(vessels).then((answer) => (answer.ok ? answer.json() : {}), () => undefined);
const value = (vessel, path) => path.split(".").reduce((at, name) => at?.[name], vessel)?.value;

// The values of the world: its origin, within the 100 m that the boats sail; wind of 6 m/s; the bottom at 12 m.
const near = (expected, tolerance) => (got) => Math.abs(got - expected) <= tolerance;
const own = {
  "navigation.position": (got) => near(42.3584, 0.01)(got.latitude) && near(-71.0876, 0.01)(got.longitude),
  "navigation.headingTrue": (got) => got >= 0 && got < 2 * Math.PI,
  "environment.wind.speedApparent": near(6, 4),
  "environment.wind.angleApparent": near(0, Math.PI),
  "environment.depth.belowTransducer": near(11.9, 0.5),
};

async function judge() {
  mkdirSync(folder, { recursive: true });
  const source = { type: "tcp", host: "127.0.0.1", port: String(nmeaPort), validateChecksum: true };
  const options = { type: "NMEA0183", logging: false, subOptions: source };
  const pipe = { id: "shoal", enabled: true, pipeElements: [{ type: "providers/simple", options }] };
  writeFileSync(`${folder}/settings.json`, JSON.stringify({ interfaces: {}, mdns: false, pipedProviders: [pipe] }));
  // In lockstep from the start, as AIS names are sent soon after it, and then every six minutes.
  const door = start(`${bin}/shoal-nmea`, ["--vehicle", "boat", "--lockstep", "--listen", `127.0.0.1:${nmeaPort}`]);
  start(process.execPath, [server, "-c", folder], {
    PORT: String(httpPort),
    SIGNALK_DISABLE_SERVER_UPDATES: "1", // it asks npm otherwise
    NODE_ENV: "production",
  });
  await until(() => door.text.includes("connected"), "a connection of the server with shoal-nmea");
  await until(read, "an answer of the server");
  start(`${bin}/shoal`, ["run", world, "--await", "nmea", "--duration", "forever", "--speed", "10", "--quiet", "--no-keys"]);
  let seen = {};
  const all = await until(async () => {
    seen = (await read()) ?? {};
    const named = Object.values(seen).some((each) => each.name === "FERRY");
    return named && Object.values(seen).find((each) => value(each, "environment.depth.belowTransducer") !== undefined && value(each, "navigation.position"));
  }, "own ship and the AIS vessel FERRY");
  for (const [path, holds] of Object.entries(own)) {
    const got = value(all, path);
    if (got === undefined || !holds(got)) throw new Error(`${path}: ${JSON.stringify(got)}`);
  }
  const ferry = Object.values(seen).find((each) => each.name === "FERRY");
  if (ferry.mmsi !== "211000002" || !own["navigation.position"](value(ferry, "navigation.position")))
    throw new Error(`FERRY: ${JSON.stringify(ferry)}`);
  return `own ship with ${Object.keys(own).length} values, FERRY by name and place`;
}

try {
  console.log(await judge());
} catch (error) {
  console.error(error.message ?? error);
  process.exitCode = 1;
} finally {
  for (const child of children.reverse()) child.kill("SIGTERM");
  const patience = setTimeout(() => children.forEach((each) => each.over ?? each.kill("SIGKILL")), 10_000);
  await Promise.all(children.map((each) => each.ended));
  clearTimeout(patience);
}
