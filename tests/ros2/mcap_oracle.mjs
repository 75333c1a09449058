// SPDX-License-Identifier: BSD-3-Clause
// Records a part of each given world as an LCM event log, converts it, and reads the MCAP file with the reference
// libraries: schemas, encoding, counts, times and values.
//
// usage: node mcap_oracle.mjs SHOAL SECONDS WORLD.yaml...
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";

import { checkConventions } from "./conventions.mjs";
import { countStream, readIndexed } from "./read_mcap.mjs";

const [shoal, seconds, ...worlds] = process.argv.slice(2);
const comparedFields = 20;
const comparedRows = 50;

function run(...command) {
  const result = spawnSync(shoal, command, { encoding: "utf8", maxBuffer: 1 << 30 });
  if (result.status !== 0) throw new Error(`shoal ${command.join(" ")}: exit ${result.status}\n${result.stderr}`);
  return result.stdout;
}

function check(condition, text) {
  if (!condition) throw new Error(text);
}

/** Events of each channel by `shoal log info`: Map(channel, {events, type}). */
function channelsOf(log) {
  const channels = new Map();
  for (const line of run("log", "info", log).split("\n")) {
    const found = /^ *(\d+) +[\d.]+ +(\d+)  (\S+) +(\S.*)$/.exec(line);
    if (found) channels.set(found[3], { events: Number(found[1]), type: found[4] });
  }
  return channels;
}

/** Name of a member of a message in ROS 2: lower case. */
const ros = (name) => name.toLowerCase();

/** The value at a path such as pos[1] or metadata[0].key; arrays of several dimensions are flat in ROS 2. */
function valueAt(message, path) {
  let value = message;
  for (const part of path.split(".")) {
    const [name, ...indices] = part.split(/[[\]]+/).filter((piece) => piece !== "");
    value = value[ros(name)];
    if (indices.length === 1) value = value[Number(indices[0])];
    if (indices.length > 1) return undefined; // the row length is not known here
  }
  return value;
}

/** Values of one row of CSV; strings may contain commas, quotes and line ends. */
function* rowsOf(csv) {
  let row = [];
  for (const [, quoted, plain, end] of csv.matchAll(/(?:"((?:[^"]|"")*)"|([^",\n]*))(,|\n)/g)) {
    row.push(quoted !== undefined ? quoted.replaceAll('""', '"') : plain);
    if (end === "\n") {
      yield row;
      row = [];
    }
  }
}

function equal(text, value) {
  if (typeof value === "string") return text === value;
  if (typeof value === "boolean") return text === (value ? "1" : "0");
  if (typeof value === "bigint") return BigInt(text) === value;
  if (value instanceof Uint8Array) return Buffer.from(value).toString("hex") === text;
  if (text.toLowerCase().includes("nan")) return Number.isNaN(value);
  return Math.fround(Number(text)) === Math.fround(value) || Number(text) === value;
}

/** Compares up to 20 fields of the first messages of a channel with what `shoal log csv` prints. */
function compareValues(log, name, topic) {
  const rows = rowsOf(run("log", "csv", log, name));
  const header = rows.next().value;
  let compared = 0;
  let row = 0;
  for (const fields of rows) {
    if (row === comparedRows || fields.length !== header.length) break; // arrays of another length
    const { time, message } = topic.messages[row++];
    check(BigInt(fields[0]) * 1000n === time, `${name}: log time ${time}, expected ${fields[0]} us`);
    for (let i = 1; i < header.length && i <= comparedFields; ++i) {
      const value = valueAt(message, header[i]);
      if (value === undefined) continue;
      check(equal(fields[i], value), `${name}: message ${row - 1}: ${header[i]} is ${value}, expected ${fields[i]}`);
      ++compared;
    }
  }
  return compared;
}

/** A record that is cut off still has its first messages. */
async function checkCuts(path, messages) {
  const bytes = readFileSync(path);
  check((await countStream(bytes)) === messages, "as many messages by stream as by index");
  let before = 0;
  for (let part = 1; part <= 10; ++part) {
    const count = await countStream(bytes.subarray(0, Math.floor((bytes.length * part) / 11)));
    check(count >= before && count <= messages, "a longer part has no fewer messages");
    before = count;
  }
}

async function checkWorld(world, folder) {
  const log = join(folder, "run.lcm");
  const direct = join(folder, "direct.mcap");
  const path = join(folder, "run.mcap");
  const options = ["--bus", "none", "--speed", "max", "--duration", seconds, "--quiet", "--overwrite"];
  const first = run("run", world, ...options, "--record", log);
  run("run", world, ...options, "--record", direct);
  run("log", "mcap", log, "--out", path, "--overwrite");
  check(readFileSync(direct).equals(readFileSync(path)), "a run records the bytes of the converted log");

  const channels = channelsOf(log);
  const file = await readIndexed(path);
  check(file.header.profile === "ros2", "profile");
  const byChannel = new Map();
  let total = 0n;
  for (const topic of file.topics.values()) {
    total += BigInt(topic.messages.length);
    if (topic.channel.metadata.has("lcm_type")) byChannel.set(topic.channel.metadata.get("lcm_channel"), topic);
    topic.messages.forEach((each, i) => check(each.sequence === i, `${topic.channel.topic}: sequence ${i}`));
  }
  check(file.statistics.messageCount === total, "the count of the statistics");
  check(byChannel.size === channels.size, `${byChannel.size} channels, expected ${channels.size}`);
  let compared = 0;
  for (const [name, { events, type }] of channels) {
    const topic = byChannel.get(name);
    check(topic !== undefined, `${name} has no topic`);
    check(topic.messages.length === events, `${name}: ${topic.messages.length} messages, expected ${events}`);
    check(topic.channel.metadata.get("lcm_type") === type, `${name}: type`);
    compared += compareValues(log, name, topic);
  }
  check(file.attachments.length === 1 && file.attachments[0].name === "world.yaml", "the world is attached");
  check(file.metadata.length >= 1 && file.metadata[0].metadata.get("seed") !== undefined, "metadata");
  check(file.topics.has("/tf") && file.topics.has("/clock"), "/tf and /clock");
  const conventions = checkConventions(file.topics);
  await checkCuts(path, Number(total));
  const standard = file.topics.size - byChannel.size;
  console.log(
    `${basename(world, ".yaml").padEnd(20)} ${channels.size} channels, ${standard} standard topics, ` +
      `${total} messages decoded, ${compared} values compared, ${conventions} by convention`,
  );
}

let failed = 0;
for (const world of worlds) {
  const folder = mkdtempSync(join(tmpdir(), "shoal-mcap-"));
  try {
    await checkWorld(world, folder);
  } catch (error) {
    console.error(`${world}: ${error.message}`);
    ++failed;
  } finally {
    rmSync(folder, { recursive: true });
  }
}
process.exitCode = failed === 0 && worlds.length > 0 ? 0 : 1;
