// SPDX-License-Identifier: BSD-3-Clause
// Scenes made by hand, whose numbers a reader can check: script = {scene, posesAt(t_s), hello, assets}.

const LIGHT = {
  to_sun: [0.5, -0.4, 0.7],
  sun: 0.9,
  sky: 0.4,
  zenith: '#5b8fd6',
  horizon: '#d6e4f0'
};
const IDENTITY = [0, 0, 0, 1, 0, 0, 0];
const NO_TEXTURE = {
  name: 'default',
  gloss: 0
};

/** Pose at a position with a yaw. */
export const at = (x, y, z, yaw = 0) => [x, y, z, Math.cos(yaw / 2), 0, 0, Math.sin(yaw / 2)];

function part(shape, pose, color, sizes, material = 0) {
  return {name: shape, shape, pose, ...(color ? {color} : {}), material, ...sizes};
}

function rover(name, color) {
  const wheels = [[0.2, 0.22], [0.2, -0.22], [-0.2, 0.22], [-0.2, -0.22]].map(
      ([x, y]) => part(
          'cylinder', [x, y, -0.02, Math.SQRT1_2, Math.SQRT1_2, 0, 0], '#22262b', {radius_m: 0.12, length_m: 0.07}));
  return {
    name: `${name}/chassis`,
    owner: name,
    kind: 'vehicle',
    fixed: false,
    pose: at(0, 0, 0.14),
    parts: [
      part('box', [0, 0, 0.08, 1, 0, 0, 0], color, {size_m: [0.6, 0.36, 0.16]}),
      part('box', [0.05, 0, 0.19, 1, 0, 0, 0], '#e8ecef', {size_m: [0.3, 0.26, 0.08]}),
      part('cylinder', [0.12, 0, 0.28, 1, 0, 0, 0], '#2b3036', {radius_m: 0.06, length_m: 0.1}),
      ...wheels,
    ],
  };
}

function auv(name, color) {
  return {
    name: `${name}/hull`,
    owner: name,
    kind: 'vehicle',
    fixed: false,
    pose: IDENTITY,
    parts: [
      part('capsule', [0, 0, 0, Math.SQRT1_2, 0, Math.SQRT1_2, 0], color, {radius_m: 0.16, length_m: 1.4}),
      part('box', [-0.7, 0, 0, 1, 0, 0, 0], '#333b42', {size_m: [0.16, 0.6, 0.03]}),
      part('box', [-0.7, 0, 0, 1, 0, 0, 0], '#333b42', {size_m: [0.16, 0.03, 0.6]}),
      part('box', [0.1, 0, 0.2, 1, 0, 0, 0], '#f2f2f2', {size_m: [0.25, 0.05, 0.14]}),
    ],
  };
}

function boat(name, color) {
  const hull = (y) =>
      part('capsule', [0, y, 0.05, Math.SQRT1_2, 0, Math.SQRT1_2, 0], color, {radius_m: 0.2, length_m: 1.6});
  return {
    name: `${name}/hull`,
    owner: name,
    kind: 'vehicle',
    fixed: false,
    pose: IDENTITY,
    parts: [
      hull(0.45),
      hull(-0.45),
      part('box', [0, 0, 0.35, 1, 0, 0, 0], '#f4f4f2', {size_m: [1.0, 1.0, 0.12]}),
      part('box', [-0.2, 0, 0.65, 1, 0, 0, 0], '#34404a', {size_m: [0.35, 0.35, 0.5]}),
      part('cylinder', [-0.2, 0, 1.2, 1, 0, 0, 0], '#dddddd', {radius_m: 0.025, length_m: 0.8}),
    ],
  };
}

function vehicle(name, body, devices = []) { return {name, body, pose: IDENTITY, devices}; }

const LIDAR = {
  name: 'lidar',
  type: 'lidar',
  body: 0,
  pose: at(0.12, 0, 0.3),
  channels: ['rover1.lidar'],
  field_of_view: {kind: 'fan', from_rad: -1.57, to_rad: 1.57, range_m: 5},
};
const CAMERA = {
  name: 'front',
  type: 'camera',
  body: 0,
  pose: at(0.25, 0, 0.3),
  channels: ['rover1.front'],
  field_of_view: {kind: 'frustum', horizontal_rad: 1.2, vertical_rad: 0.9, range_m: 3},
};

function scene(world, rest) {
  return {
    op: 'scene',
    revision: 1,
    world,
    origin_m: [0, 0, 0],
    light: LIGHT,
    materials: [NO_TEXTURE],
    bodies: [],
    vehicles: [],
    water: null,
    zones: [],
    ...rest,
  };
}

const number = (bodies) => bodies.map((body, id) => ({...body, id}));

/** Three rovers drive circles of radii 2, 3 and 4 m, one turn in 20, 30 and 40 s, among walls on a plane. */
export function land() {
  const bodies = number([
    rover('rover1', '#d1495b'),
    rover('rover2', '#2f7ed8'),
    rover('rover3', '#3a9d5d'),
    {
      name: 'ground',
      owner: '',
      kind: 'object',
      fixed: true,
      pose: IDENTITY,
      parts: [part('plane', IDENTITY, null, {})]
    },
    {
      name: 'walls',
      owner: '',
      kind: 'object',
      fixed: true,
      pose: IDENTITY,
      parts: [
        part('box', at(0, 6, 0.5), null, {size_m: [12, 0.2, 1]}),
        part('box', at(-6, 0, 0.5), null, {size_m: [0.2, 12, 1]}),
        part('box', at(0, 0, 0.35), null, {size_m: [0.7, 0.7, 0.7]}, 1),
        part('cylinder', at(5, 4, 0.6), '#c98b2b', {radius_m: 0.3, length_m: 1.2}),
        part('sphere', at(4, -4.5, 0.4), null, {radius_m: 0.4}, 2),
      ]
    },
  ]);
  const circle = (t_s, radius, turn_s) => {
    const angle = 2 * Math.PI * t_s / turn_s;
    return at(radius * Math.cos(angle), radius * Math.sin(angle), 0.14, angle + Math.PI / 2);
  };
  const materials = [
    NO_TEXTURE, {name: 'crate', gloss: 0, texture: {pattern: 'checker', colors: ['#e9d8a6', '#7f5539'], size_m: 0.175}},
    {name: 'ball', gloss: 0.4, texture: {pattern: 'stripes', colors: ['#ffffff', '#d1495b'], size_m: 0.1}}
  ];
  return {
    scene: scene('test_land', {
      bodies,
      materials,
      zones: [{name: 'dock', polygon_m: [[4, -2], [6, -2], [6, 1], [4, 1]], z_m: [null, null]}],
      vehicles: [vehicle('rover1', 0, [LIDAR, CAMERA]), vehicle('rover2', 1), vehicle('rover3', 2)],
    }),
    posesAt: (t_s) => [circle(t_s, 2, 20), circle(t_s, 3, 30), circle(t_s, 4, 40)],
  };
}

/** A height grid of 61 x 61 samples, 4 m apart, about -30 m. */
function seaFloor() {
  const columns = 61, rows = 61, buffer = Buffer.alloc(28 + 4 * columns * rows);
  [2, columns, rows].forEach((value, i) => buffer.writeUInt32LE(value, 4 * i));
  [-120, -120, 4, 4].forEach((value, i) => buffer.writeFloatLE(value, 12 + 4 * i));
  for (let j = 0; j < rows; ++j)
    for (let i = 0; i < columns; ++i) {
      const x = -120 + 4 * i, y = -120 + 4 * j;
      const height = -30 + 4 * Math.sin(x / 24) * Math.cos(y / 31) + 2.5 * Math.sin((x + 2 * y) / 17);
      buffer.writeFloatLE(height, 28 + 4 * (j * columns + i));
    }
  return buffer;
}

export const WAVES = [
  {amplitude_m: 0.25, k_radpm: 0.35, omega_radps: 1.853, phase_rad: 1, direction_rad: 0.3},
  {amplitude_m: 0.10, k_radpm: 1.1, omega_radps: 3.285, phase_rad: 2.4, direction_rad: -0.4},
  {amplitude_m: 0.04, k_radpm: 2.7, omega_radps: 5.146, phase_rad: 0.2, direction_rad: 1.0},
];

/** Height of the sea of a scene at a position and time, by the formula of the protocol. */
export function elevation(waves, x, y, t_s) {
  return waves.reduce(
      (sum, w) => sum +
          w.amplitude_m *
              Math.cos(
                  w.k_radpm * (x * Math.cos(w.direction_rad) + y * Math.sin(w.direction_rad)) - w.omega_radps * t_s +
                  w.phase_rad),
      0);
}

/** Three AUVs under water over a sea floor; auv1 stays at (0, 0, -10), the others move. */
export function underwater() {
  const bodies = number([
    auv('auv1', '#f2b01e'),
    auv('auv2', '#e4572e'),
    auv('auv3', '#35a7c9'),
    {
      name: 'floor',
      owner: '',
      kind: 'object',
      fixed: true,
      pose: IDENTITY,
      parts: [part('terrain', IDENTITY, '#b3a27c', {asset: '00000000000000aa'})]
    },
  ]);
  const dvl = {
    name: 'dvl',
    type: 'dvl',
    body: 0,
    pose: at(0, 0, -0.16),
    channels: [],
    field_of_view: {
      kind: 'beams',
      range_m: 15,
      directions: [[0.5, 0, -0.866], [-0.5, 0, -0.866], [0, 0.5, -0.866], [0, -0.5, -0.866]]
    },
  };
  return {
    scene: scene('test_underwater', {
      bodies,
      vehicles: [vehicle('auv1', 0, [dvl]), vehicle('auv2', 1), vehicle('auv3', 2)],
      water: {level_m: 0, waves: WAVES, sound_speed: [[0, 1500], [-40, 1495]]},
    }),
    posesAt: (t_s) => [at(0, 0, -10), at(20 + 1.5 * t_s, 12, -14, 0), at(-18, 10 + t_s, -8 - 0.02 * t_s, Math.PI / 2)],
    assets: new Map([['00000000000000aa', seaFloor()]]),
  };
}

/** A hundred AUVs with a propeller and fins each, in rows under waves and over a sea floor. */
export function fleet() {
  const count = 100, script = underwater(), floor = script.scene.bodies.at(-1);
  const device = (body, name, type, x) => ({name, type, body, pose: at(x, 0, 0), channels: []});
  const names = [...Array(count).keys()].map((i) => `auv${i}`);
  script.scene.bodies = number([...names.map((name) => auv(name, '#f2b01e')), floor]);
  script.scene.vehicles = names.map(
      (name, i) => vehicle(name, i, [device(i, 'propeller', 'thruster', -0.9), device(i, 'rudder', 'fin', -0.8)]));
  script.posesAt = (t_s) => names.map(
      (_, i) => at(18 * (i % 10) - 90 + Math.sin(0.2 * t_s + i), 18 * Math.floor(i / 10) - 90, -6 - i % 7, 0.1 * t_s));
  return script;
}

/** Two boats in waves. */
export function surface() {
  const bodies = number([
    boat('boat1', '#e4572e'),
    boat('boat2', '#2f7ed8'),
    auv('auv1', '#f2b01e'),
    {
      name: 'buoy',
      owner: '',
      kind: 'object',
      fixed: true,
      pose: IDENTITY,
      parts: [
        part('sphere', at(8, 6, 0.1), '#d1495b', {radius_m: 0.5}),
        part('cylinder', at(8, 6, 1.2), '#f6f6f6', {radius_m: 0.05, length_m: 1.8})
      ]
    },
  ]);
  const float = (x, y, t_s, yaw) => at(x, y, elevation(WAVES, x, y, t_s), yaw);
  return {
    scene: scene('test_surface', {
      bodies,
      vehicles: [vehicle('boat1', 0), vehicle('boat2', 1), vehicle('auv1', 2)],
      water: {level_m: 0, waves: WAVES, sound_speed: [[0, 1500]]},
    }),
    posesAt: (t_s) => [float(t_s, 0, t_s, 0), float(4, 5 - 0.6 * t_s, t_s, -Math.PI / 2), at(2 + t_s, -3, -2.5)],
  };
}

/** A thousand vehicles that move in a square of 200 m. */
export function thousand() {
  const count = 1000, colors = ['#d1495b', '#2f7ed8', '#3a9d5d', '#f2b01e'];
  const bodies =
      [...Array(count).keys()].map((i) => ({
                                     id: i,
                                     name: `v${i}/body`,
                                     owner: `v${i}`,
                                     kind: 'vehicle',
                                     fixed: false,
                                     pose: IDENTITY,
                                     parts: [part('box', at(0, 0, 0.25), colors[i % 4], {size_m: [1, 0.6, 0.5]})],
                                   }));
  bodies.push({
    id: count,
    name: 'ground',
    owner: '',
    kind: 'object',
    fixed: true,
    pose: IDENTITY,
    parts: [part('plane', IDENTITY, null, {})]
  });
  const vehicles = [...Array(count).keys()].map((i) => vehicle(`v${i}`, i));
  return {
    scene: scene('test_thousand', {bodies, vehicles}),
    posesAt: (t_s) => vehicles.map(
        (_, i) => at(6.5 * (i % 32) - 100 + Math.sin(t_s + i), 6.5 * Math.floor(i / 32) - 100, 0, t_s + i)),
  };
}

/** The bodies of thousand(), all of one vehicle. */
export function thousandBodies() {
  const script = thousand();
  for (const body of script.scene.bodies.slice(0, -1)) body.owner = 'v0';
  script.scene.vehicles = script.scene.vehicles.slice(0, 1);
  return script;
}

/** Names that are markup must stay text. */
export function hostile() {
  const name = '<img src=x onerror="document.title=\'owned\'">';
  const script = land();
  script.scene.world = name;
  script.scene.bodies[0].owner = name;
  script.scene.vehicles[0].name = name;
  script.scene.vehicles[0].devices[0].name = name;
  script.scene.zones[0].name = name;
  return {...script, name};
}
