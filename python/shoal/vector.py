# SPDX-License-Identifier: BSD-3-Clause
"""Many worlds at once, with the interfaces of Gymnasium and PettingZoo, neither of which is needed.

    envs = shoal.vector.VectorEnv(
        'worlds/rover.yaml', 64, steps=10,
        actions=['rover1.drive.cmd:twist_command_t:linear_x_mps,angular_z_radps'],
        observations=['rover1.lidar:ranges', '@rover1'],
        reward=lambda before, actions, after: ...)
    observations, infos = envs.reset(seed=1)
    observations, rewards, terminated, truncated, infos = envs.step(actions)
"""
import numpy as np

from . import _shoal
from .world import _path_of
from .yaml_text import yaml_of

#: Names of the 13 values of the observation `@vehicle`.
MOTION = ('x_m', 'y_m', 'z_m', 'qw', 'qx', 'qy', 'qz', 'vx_mps', 'vy_mps', 'vz_mps', 'wx_radps', 'wy_radps', 'wz_radps')


class Box:
    """Space of arrays between two bounds; a Box of gymnasium.spaces where that package is installed."""

    def __init__(self, low, high, shape, dtype=np.float64):
        self.low, self.high = np.full(shape, low, dtype), np.full(shape, high, dtype)
        self.shape, self.dtype = tuple(shape), np.dtype(dtype)
        self._random = np.random.default_rng()

    def seed(self, seed=None):
        """Sets the seed of sample()."""
        self._random = np.random.default_rng(seed)
        return [seed]

    def sample(self):
        """Returns a random element; unbounded ones are normally distributed."""
        if np.isfinite(self.low).all() and np.isfinite(self.high).all():
            return self._random.uniform(self.low, self.high).astype(self.dtype)
        return self._random.standard_normal(self.shape).astype(self.dtype)

    def contains(self, value):
        """Returns whether an array is an element."""
        value = np.asarray(value)
        return value.shape == self.shape and bool(np.all(value >= self.low) and np.all(value <= self.high))

    __contains__ = contains

    def __eq__(self, other):
        return (isinstance(other, Box) and self.shape == other.shape and np.array_equal(self.low, other.low) and
                np.array_equal(self.high, other.high))

    def __repr__(self):
        return f'Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})'


def _box(low, high, shape):
    try:
        from gymnasium.spaces import Box as GymBox
    except ImportError:
        return Box(low, high, shape)
    return GymBox(low, high, shape, np.float64)


class VectorEnv:
    """`num_envs` worlds of one file whose seeds differ, stepped together on all cores.

    world: path of a world file or a dict
    actions: texts 'channel:type:member,member'; the values of all are one row of the array of actions
    observations: texts 'channel:member' (a number or an array of numbers of the last message) or '@vehicle' (the true
        motion, MOTION); the values of all are one row of the array of observations, NaN before the first message
    steps: steps of the world for each step of the environment
    reward: reward(before, actions, after) -> (num_envs,), of arrays of all worlds; None: zeros
    terminated: terminated(after) -> (num_envs,) of bool; worlds whose events end the run are terminated anyway
    max_episode_s: after this simulated time an episode is truncated
    action_low, action_high: bounds of the actions, numbers or arrays

    A world that is terminated or truncated is built again in the next step, with a new seed (autoreset mode "next
    step" of Gymnasium).  Equal seeds and actions give equal observations for any number of threads.
    """

    metadata = {'render_modes': [], 'autoreset_mode': 'next_step'}
    render_mode = None
    spec = None

    def __init__(self, world, num_envs, *, actions, observations, steps=1, reward=None, terminated=None,
                 max_episode_s=None, action_low=-1.0, action_high=1.0, seed=1, set=None, threads=0):
        self.num_envs = int(num_envs)
        sets = [f'{path}={yaml_of(value)}' for path, value in (set or {}).items()]
        text = yaml_of(world) if isinstance(world, dict) else None
        self._pool = _shoal.Pool('world' if text else _path_of(world), text, sets, self.num_envs, seed,
                                 [_action(each) for each in actions], [_observation(each) for each in observations],
                                 steps, threads)
        self._reward, self._terminated = reward, terminated
        self.step_s = steps * self._pool.step_s
        self._longest = None if max_episode_s is None else max(1, round(max_episode_s / self.step_s))
        width, height = self._pool.action_values, self._pool.offsets[-1]
        self.single_action_space = _box(action_low, action_high, (width,))
        self.single_observation_space = _box(-np.inf, np.inf, (height,))
        self.action_space = _box(action_low, action_high, (self.num_envs, width))
        self.observation_space = _box(-np.inf, np.inf, (self.num_envs, height))
        #: Slices of a row of observations, in the order of `observations`.
        self.slices = [slice(*pair) for pair in zip(self._pool.offsets, self._pool.offsets[1:])]
        self._seeds = np.random.SeedSequence(seed)
        self._before = np.full((self.num_envs, height), np.nan)
        self._ages = np.zeros(self.num_envs, np.int64)
        self._done = np.zeros(self.num_envs, bool)

    @property
    def unwrapped(self):
        """The environment itself."""
        return self

    def reset(self, *, seed=None, options=None):
        """Builds all worlds again; returns observations (num_envs, n) and an empty dict.

        seed: of world 0, those of the others follow; or a list of seeds; None: seeds that continue the sequence
        """
        if seed is None:
            seeds = self._new_seeds(self.num_envs)
        elif np.ndim(seed) == 0:
            self._seeds = np.random.SeedSequence(int(seed))
            seeds = [int(seed) + i for i in range(self.num_envs)]
        else:
            seeds = [int(each) for each in seed]
            if len(seeds) != self.num_envs:
                raise ValueError(f'seed must be a number or {self.num_envs} numbers, got {len(seeds)}')
        self._before, _ = self._pool.step(np.zeros(self.action_space.shape), seeds)
        self._ages[:] = 0
        self._done[:] = False
        return self._before.copy(), {}

    def step(self, actions):
        """Takes a step of all worlds.

        actions: (num_envs, m)

        Returns observations (num_envs, n), rewards (num_envs,), terminated and truncated (num_envs,) of bool, and a
        dict with `failed` (num_envs,) of bool: the physics of the world failed, which also terminates it.
        """
        actions = np.asarray(actions, float).reshape(self.num_envs, -1)
        begins = self._done.copy()
        seeds = np.full(self.num_envs, -1, np.int64)
        seeds[begins] = self._new_seeds(int(begins.sum()))
        after, status = self._pool.step(actions, seeds)
        rewards = np.zeros(self.num_envs) if self._reward is None else np.asarray(
            self._reward(self._before, actions, after), float).copy()
        terminated = status != 0
        if self._terminated is not None:
            terminated = terminated | np.asarray(self._terminated(after), bool)
        self._ages = np.where(begins, 0, self._ages + 1)
        truncated = np.zeros(self.num_envs, bool) if self._longest is None else self._ages >= self._longest
        rewards[begins], terminated[begins], truncated[begins] = 0, False, False
        self._done = terminated | truncated
        self._before = after
        return after.copy(), rewards, terminated, truncated, {'failed': status == 2}

    def run_hash(self, index):
        """Returns the hash of the run of a world."""
        return self._pool.run_hash(index)

    def close(self):
        """Frees the worlds."""
        self._pool = None

    def _new_seeds(self, count):
        return [int(each.generate_state(1)[0] & 0x7fffffff) for each in self._seeds.spawn(count)]


class Env:
    """One world with the interface of gymnasium.Env; the arguments are those of VectorEnv without `num_envs`."""

    metadata = {'render_modes': []}
    render_mode = None
    spec = None

    def __init__(self, world, **arguments):
        self._envs = VectorEnv(world, 1, **arguments)
        self.action_space = self._envs.single_action_space
        self.observation_space = self._envs.single_observation_space
        self.slices = self._envs.slices

    @property
    def unwrapped(self):
        """The environment itself."""
        return self

    def reset(self, *, seed=None, options=None):
        """Builds the world again; returns the observation (n,) and an empty dict."""
        observations, _ = self._envs.reset(seed=seed)
        return observations[0], {}

    def step(self, action):
        """Takes a step; returns observation (n,), reward, terminated, truncated and a dict."""
        observations, rewards, terminated, truncated, info = self._envs.step([action])
        return observations[0], float(rewards[0]), bool(terminated[0]), bool(truncated[0]), {
            'failed': bool(info['failed'][0])}

    def render(self):
        """Returns None; `shoal run --view` shows a run."""

    def close(self):
        """Frees the world."""
        self._envs.close()


class ParallelEnv:
    """One world whose vehicles are agents, with the interface of pettingzoo.ParallelEnv.

    agents: dict of names and {'actions': [...], 'observations': [...]}, as in VectorEnv
    reward: reward(before, actions, after) -> dict by agent, of dicts of arrays by agent; None: zeros
    """

    metadata = {'name': 'shoal', 'render_modes': []}
    render_mode = None

    def __init__(self, world, agents, *, steps=1, reward=None, max_episode_s=None, action_low=-1.0, action_high=1.0,
                 seed=1, set=None):
        self.possible_agents = list(agents)
        self.agents = []
        self._reward = reward
        self._envs = VectorEnv(
            world, 1, steps=steps, max_episode_s=max_episode_s, seed=seed, set=set,
            actions=[each for agent in agents.values() for each in agent['actions']],
            observations=[each for agent in agents.values() for each in agent['observations']])
        self._actions, self._observations = {}, {}
        width, values = 0, iter(self._envs.slices)
        for name, agent in agents.items():
            size = sum(len(_action(each)[2]) for each in agent['actions'])
            self._actions[name] = slice(width, width + size)
            width += size
            own = [next(values) for _ in agent['observations']]
            self._observations[name] = slice(own[0].start, own[-1].stop) if own else slice(0, 0)
        self.action_spaces = {name: _box(action_low, action_high, (each.stop - each.start,))
                              for name, each in self._actions.items()}
        self.observation_spaces = {name: _box(-np.inf, np.inf, (each.stop - each.start,))
                                   for name, each in self._observations.items()}
        self._before = {}

    @property
    def unwrapped(self):
        """The environment itself."""
        return self

    @property
    def num_agents(self):
        """Number of agents that are still there."""
        return len(self.agents)

    @property
    def max_num_agents(self):
        """Number of all agents."""
        return len(self.possible_agents)

    def action_space(self, agent):
        """Returns the space of the actions of an agent."""
        return self.action_spaces[agent]

    def observation_space(self, agent):
        """Returns the space of the observations of an agent."""
        return self.observation_spaces[agent]

    def reset(self, seed=None, options=None):
        """Builds the world again; returns dicts of observations and infos by agent."""
        observations, _ = self._envs.reset(seed=seed)
        self.agents = list(self.possible_agents)
        self._before = self._split(observations[0])
        return self._before, {name: {} for name in self.agents}

    def step(self, actions):
        """Takes a step; returns dicts by agent of observations, rewards, terminated, truncated and infos."""
        row = np.zeros(self._envs.single_action_space.shape)
        for name, values in actions.items():
            row[self._actions[name]] = values
        observations, _, terminated, truncated, _ = self._envs.step([row])
        after = self._split(observations[0])
        rewards = dict.fromkeys(self.agents, 0.0) if self._reward is None else self._reward(self._before, actions, after)
        self._before = after
        ended, cut = dict.fromkeys(self.agents, bool(terminated[0])), dict.fromkeys(self.agents, bool(truncated[0]))
        infos = {name: {} for name in self.agents}
        if terminated[0] or truncated[0]:
            self.agents = []
        return after, rewards, ended, cut, infos

    def render(self):
        """Returns None; `shoal run --view` shows a run."""

    def close(self):
        """Frees the world."""
        self._envs.close()

    def _split(self, row):
        return {name: row[each].copy() for name, each in self._observations.items()}


def _action(text):
    parts = text.split(':')
    if len(parts) != 3 or not all(parts):
        raise _shoal.Error(f"an action is 'channel:type:member,member', got {text!r}")
    return parts[0], parts[1], parts[2].split(',')


def _observation(text):
    if text.startswith('@'):
        return '', '', text[1:]
    channel, mark, member = text.rpartition(':')
    if not mark or not channel or not member:
        raise _shoal.Error(f"an observation is 'channel:member' or '@vehicle', got {text!r}")
    return channel, member, ''
