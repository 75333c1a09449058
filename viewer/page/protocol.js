// SPDX-License-Identifier: BSD-3-Clause
// Messages of the protocol shoal.view.v1 (docs/develop/view_protocol.md): decoding and checks.

const HEAD_BYTES = 32;
const BODY_BYTES = 20;
const SHAPES = new Set(['box', 'sphere', 'capsule', 'cylinder', 'plane', 'mesh', 'terrain']);

/** Error of a message that breaks the protocol. */
export class ProtocolError extends Error {}

/** Decodes a binary state; poses has x, y, z, qx, qy, qz, qw for each movable body. */
export function decodeState(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < HEAD_BYTES) throw new ProtocolError(`state: ${buffer.byteLength} bytes, head has 32`);
  const kind = view.getUint8(0);
  if (kind !== 1) throw new ProtocolError(`binary message: unknown kind ${kind}`);
  const count = view.getUint32(24, true);
  if (buffer.byteLength !== HEAD_BYTES + count * BODY_BYTES)
    throw new ProtocolError(`state: ${count} bodies in ${buffer.byteLength} bytes`);
  const flags = view.getUint8(1);
  // Bodies: position as float, quaternion w, x, y, z as 16-bit integers.
  const poses = new Float32Array(7 * count);
  for (let i = 0, at = HEAD_BYTES, to = 0; i < count; ++i, at += BODY_BYTES, to += 7) {
    poses[to] = view.getFloat32(at, true);
    poses[to + 1] = view.getFloat32(at + 4, true);
    poses[to + 2] = view.getFloat32(at + 8, true);
    const w = view.getInt16(at + 12, true), x = view.getInt16(at + 14, true);
    const y = view.getInt16(at + 16, true), z = view.getInt16(at + 18, true);
    const scale = 1 / (Math.sqrt(w * w + x * x + y * y + z * z) || 1);
    poses[to + 3] = x * scale, poses[to + 4] = y * scale, poses[to + 5] = z * scale, poses[to + 6] = w * scale;
  }
  return {
    paused: (flags & 1) !== 0,
    jump: (flags & 2) !== 0,
    past: (flags & 4) !== 0,
    sequence: view.getUint32(4, true),
    time_us: Number(view.getBigInt64(8, true)),
    branch: view.getInt32(16, true),
    revision: view.getUint32(20, true),
    speed: view.getFloat32(28, true),
    poses,
  };
}

/** Parses a text message; the result has the key op. */
export function parseMessage(text) {
  let message;
  try {
    message = JSON.parse(text);
  } catch (error) {
    throw new ProtocolError(`text message: ${error.message}`);
  }
  if (typeof message !== 'object' || message === null || typeof message.op !== 'string')
    throw new ProtocolError('text message: \'op\' is missing');
  return message;
}

const isNumbers = (value, count) =>
    Array.isArray(value) && value.length === count && value.every((x) => Number.isFinite(x));

function require(holds, where, rule, value) {
  if (!holds) throw new ProtocolError(`scene: ${where}: ${rule}, got ${JSON.stringify(value)?.slice(0, 60)}`);
}

/** Returns the numbers of a pose [x, y, z, qw, qx, qy, qz]; the identity where it is absent. */
function readPose(value, where) {
  if (value === undefined || value === null) return [0, 0, 0, 1, 0, 0, 0];
  require(isNumbers(value, 7), where, '\'pose\' must be 7 numbers', value);
  return value;
}

function readPart(part, materials, where) {
  require(SHAPES.has(part.shape), where, `'shape' must be one of ${[...SHAPES].join(', ')}`, part.shape);
  if (part.shape === 'box') require(isNumbers(part.size_m, 3), where, '\'size_m\' must be 3 numbers', part.size_m);
  if (['sphere', 'capsule', 'cylinder'].includes(part.shape))
    require(part.radius_m > 0, where, '\'radius_m\' must be > 0', part.radius_m);
  if (['capsule', 'cylinder'].includes(part.shape))
    require(part.length_m >= 0, where, '\'length_m\' must be >= 0', part.length_m);
  if (['mesh', 'terrain'].includes(part.shape))
    require(/^[0-9a-f]{16}$/.test(part.asset), where, '\'asset\' must be 16 hexadecimal digits', part.asset);
  return {...part, pose: readPose(part.pose, where), material: materials[part.material] ?? {}};
}

function readBody(body, index, materials) {
  const name = String(body.name ?? index), where = `body '${name}'`;
  return {
    ...body,
    name,
    index,
    fixed: body.fixed === true,
    owner: String(body.owner ?? ''),
    pose: readPose(body.pose, where),
    parts: (body.parts ?? []).map((part, i) => readPart(part, materials, `${where}, part ${i}`)),
  };
}

function readVehicle(vehicle, bodies) {
  const where = `vehicle '${vehicle.name}'`;
  require(bodies[vehicle.body] !== undefined, where, '\'body\' must be the number of a body', vehicle.body);
  const devices = (vehicle.devices ?? []).map((device) => {
    const at = `${where}, device '${device.name}'`;
    require(bodies[device.body] !== undefined, at, '\'body\' must be the number of a body', device.body);
    return {...device, name: String(device.name), pose: readPose(device.pose, at)};
  });
  return {...vehicle, name: String(vehicle.name), pose: readPose(vehicle.pose, where), devices};
}

function readWater(water) {
  if (!water) return null;
  const waves = (water.waves ?? []).map((wave, i) => {
    const numbers = [wave.amplitude_m, wave.k_radpm, wave.omega_radps, wave.phase_rad, wave.direction_rad];
    require(isNumbers(numbers, 5), `wave ${i}`, 'must have 5 numbers', wave);
    return wave;
  });
  return {...water, level_m: Number(water.level_m ?? 0), waves};
}

function readZone(zone) {
  const polygon = (zone.polygon_m ?? []).filter((point) => isNumbers(point, 2));
  const flags = Array.isArray(zone.flags) ? zone.flags.map(String) : [];
  return {name: String(zone.name ?? ''), polygon_m: polygon, z_m: zone.z_m ?? [null, null], flags};
}

/** Checks a message `scene` and fills in what it may leave out; throws ProtocolError. */
export function readScene(message) {
  require(Number.isInteger(message.revision), 'revision', 'must be an integer', message.revision);
  require(Array.isArray(message.bodies), 'bodies', 'must be a list', message.bodies);
  const materials = message.materials ?? [];
  const bodies = message.bodies.map((body, i) => readBody(body, i, materials));
  return {
    revision: message.revision,
    world: String(message.world ?? ''),
    origin_m: isNumbers(message.origin_m, 3) ? message.origin_m : [0, 0, 0],
    light: {
      to_sun: [0.5, -0.4, 0.7],
      sun: 0.9,
      sky: 0.4,
      zenith: '#5b8fd6',
      horizon: '#d6e4f0',
      shadows: true,
      ...message.light,
    },
    bodies,
    vehicles: (message.vehicles ?? []).map((vehicle) => readVehicle(vehicle, bodies)),
    water: readWater(message.water),
    zones: (message.zones ?? []).map(readZone).filter((zone) => zone.polygon_m.length >= 3),
  };
}
