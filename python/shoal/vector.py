# SPDX-License-Identifier: BSD-3-Clause
"""Many worlds at once, with the interfaces of Gymnasium and PettingZoo, neither of which is needed.

Where they are installed, environments are also objects of their classes, so that their wrappers take them.

    envs = shoal.vector.VectorEnv(
        'minimal', 64, steps=10,
        actions=['rover1.drive.cmd:twist_command_t:forward_mps,turn_radps'],
        observations=['rover1.lidar:ranges', '@rover1'],
        reward=lambda before, actions, after: ...)
    observations, infos = envs.reset(seed=1)
    observations, rewards, terminated, truncated, infos = envs.step(actions)

MOTION has the names of the 13 values of the observation `@vehicle`: true position, orientation and velocity in world
axes, angular velocity in vehicle axes.
"""
from __future__ import annotations

import importlib
import os
from typing import TYPE_CHECKING, Any, Callable, Mapping, Sequence

import numpy as np

from . import _shoal, checks
from .world import MAX_THREADS, _source

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, DTypeLike

MOTION = ('x_m', 'y_m', 'z_m', 'qw', 'qx', 'qy', 'qz', 'vx_mps', 'vy_mps', 'vz_mps', 'wx_radps', 'wy_radps', 'wz_radps')


class Box:
    """Space of arrays between two bounds, where gymnasium is not installed; else its own Box is used.

    low, high: arrays of the bounds
    shape, dtype: of its elements
    """

    def __init__(self, low: ArrayLike, high: ArrayLike, shape: Sequence[int],
                 dtype: DTypeLike = float) -> None:
        """Makes the space.

        low, high: numbers or arrays of the shape
        shape: of its elements
        dtype: of the numbers in them
        """
        self.low = np.array(np.broadcast_to(low, shape), dtype)
        self.high = np.array(np.broadcast_to(high, shape), dtype)
        self.shape, self.dtype = tuple(shape), np.dtype(dtype)
        self._random = np.random.default_rng()

    def seed(self, seed: int | None = None) -> int | None:
        """Sets the seed of sample(), and returns it."""
        self._random = np.random.default_rng(seed)
        return seed

    def sample(self) -> np.ndarray:
        """Returns a random element; unbounded values are normally distributed."""
        bounded = np.isfinite(self.low) & np.isfinite(self.high)
        low, high = np.where(bounded, self.low, 0), np.where(bounded, self.high, 1)
        return np.where(bounded, self._random.uniform(low, high),
                        np.clip(self._random.standard_normal(self.shape), self.low, self.high)).astype(self.dtype)

    def contains(self, value: ArrayLike) -> bool:
        """Returns whether an array is an element."""
        value = np.asarray(value)
        return value.shape == self.shape and bool(np.all(value >= self.low) and np.all(value <= self.high))

    __contains__ = contains

    def __eq__(self, other) -> bool:
        return (isinstance(other, Box) and self.shape == other.shape and np.array_equal(self.low, other.low) and
                np.array_equal(self.high, other.high))

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f'Box({self.low.min(initial=0)}, {self.high.max(initial=0)}, {self.shape}, {self.dtype})'


def _bound(name, value, shape):
    """Returns a number, or an array of one for each of the last dimension, as an array of this shape."""
    return np.broadcast_to(checks.array('VectorEnv', name, value, () if np.ndim(value) == 0 else shape[-1:]), shape)


def _box(low, high, shape):
    low, high = _bound('action_low', low, shape), _bound('action_high', high, shape)
    if not np.all(low <= high):
        raise _shoal.Error(f'VectorEnv: action_low must be at most action_high, got {low} and {high}')
    try:
        from gymnasium.spaces import Box as GymBox  # type: ignore[import]
    except ImportError:
        return Box(low, high, shape)
    return GymBox(low, high, shape, np.float64)


def _autoreset():
    try:
        from gymnasium.vector import AutoresetMode  # type: ignore[import]
    except ImportError:
        return 'NextStep'
    return AutoresetMode.NEXT_STEP


class _Joined:
    """Class whose objects are also of a class of another package, where that is installed: its wrappers ask for it."""

    _other = ('', '')  # module and name of that class
    _made: dict[type, type] = {}

    def __new__(cls, *_args, **_arguments):
        if cls not in cls._made:
            module, name = cls._other
            try:
                other = getattr(importlib.import_module(module), name)
            except ImportError:
                other = object
            cls._made[cls] = cls if issubclass(cls, other) else type(
                cls.__name__, (cls, other), {'__module__': cls.__module__, '__doc__': cls.__doc__})
        return object.__new__(cls._made[cls])

    def _reset_other(self, seed):
        """Seeds the random numbers of that class, which its tests look at."""
        reset = getattr(super(), 'reset', None)
        if reset is not None:
            reset(seed=seed)


class VectorEnv(_Joined):
    """`num_envs` worlds of one file whose seeds differ, stepped together on all cores.

    A world that is terminated or truncated is built again in the next step, with a new seed (the mode "next step" of
    Gymnasium).  Equal seeds and actions give equal observations for any number of threads.

    An episode begins with real observations: a world that was built takes steps, without actions, until each observed
    channel has its first message, up to 10 s of simulated time.

    num_envs: number of worlds
    step_s: simulated time of a step of the environment in s
    single_action_space, action_space: Box of the actions of one world (m,) and of all (num_envs, m)
    single_observation_space, observation_space: Box of the observations of one world (n,) and of all (num_envs, n)
    slices: slices of a row of observations, in the order of `observations`
    metadata: dict with `render_modes` and `autoreset_mode`
    """

    _other = ('gymnasium.vector', 'VectorEnv')
    render_mode = None
    spec = None

    def __init__(self, world: str | os.PathLike | dict, num_envs: int, *, actions: str | Sequence[str],
                 observations: str | Sequence[str], steps: int = 1, reward: Callable | None = None,
                 terminated: Callable | None = None, max_episode_s: float | None = None,
                 action_low: ArrayLike = -1.0, action_high: ArrayLike = 1.0, missing: float = 0.0, seed: int = 1,
                 set: dict | None = None, threads: int = 0) -> None:
        """Loads a world; reset() builds all.

        world: as of shoal.World
        actions: texts 'channel:type:member,member', or one; the values of all are one row of the array of actions
        observations: texts 'channel:member' (a number or an array of numbers of the last message) or '@vehicle' (the
            true motion, MOTION), or one; the values of all are one row of the array of observations
        steps: steps of the world for each step of the environment
        reward: reward(before, actions, after) -> (num_envs,), of arrays of all worlds; None: zeros
        terminated: terminated(after) -> (num_envs,) of bool; worlds whose events end the run are terminated anyway
        max_episode_s: after this simulated time since its first observations an episode is truncated
        action_low, action_high: bounds of the actions, numbers or arrays (m,), which are not enforced
        missing: value of an observation in place of NaN, and where there is no message yet
        seed: of the first world, for reset() without a seed
        set: as of shoal.World
        threads: up to 256; 0: one for each core

        Raises Error for a world, an action or an observation that is refused.
        """
        self.metadata = {'render_modes': [], 'autoreset_mode': _autoreset()}
        who = 'VectorEnv'
        num_envs = checks.integer(who, 'num_envs', num_envs, 1, 100_000)
        steps, seed = checks.integer(who, 'steps', steps, 1), checks.integer(who, 'seed', seed, 0)
        threads = checks.integer(who, 'threads', threads, 0, MAX_THREADS)
        if max_episode_s is not None:
            max_episode_s = checks.number(who, 'max_episode_s', max_episode_s, 0, above=True)
        for name, function in (('reward', reward), ('terminated', terminated)):
            if function is not None:
                checks.function(who, name, function)
        file, text, sets = _source(who, world, set)
        self._pool = _shoal.Pool(file, text, sets, num_envs, seed,
                                 [_action(each) for each in checks.names(who, 'actions', actions)],
                                 [_observation(each) for each in checks.names(who, 'observations', observations)],
                                 steps, threads)
        self.num_envs = num_envs
        self._reward, self._terminated = reward, terminated
        self._missing = checks.number(who, 'missing', missing, -np.inf, np.inf)
        self.step_s = steps * self._pool.step_s
        self._longest = None if max_episode_s is None else max(1, round(max_episode_s / self.step_s))
        width, height = self._pool.action_values, self._pool.offsets[-1]
        self.single_action_space = _box(action_low, action_high, (width,))
        self.single_observation_space = _box(-np.inf, np.inf, (height,))
        self.action_space = _box(action_low, action_high, (num_envs, width))
        self.observation_space = _box(-np.inf, np.inf, (num_envs, height))
        self.slices = [slice(*pair) for pair in zip(self._pool.offsets, self._pool.offsets[1:])]
        self._seeds = np.random.SeedSequence(seed)
        self._before: np.ndarray | None = None  # until the first reset
        self._ages = np.zeros(num_envs, np.int64)
        self._done = np.zeros(num_envs, bool)

    @property
    def unwrapped(self) -> VectorEnv:
        """The environment itself."""
        return self

    @property
    def closed(self) -> bool:
        """Whether close() was called."""
        return self._pool is None

    def reset(self, *, seed: int | Sequence[int | None] | None = None,
              options: dict | None = None) -> tuple[np.ndarray, dict]:
        """Builds all worlds again; returns their first observations (num_envs, n) and a dict.

        The dict has `missing` (num_envs, n) of bool: the values that no message has, or that are NaN.

        seed: of world 0, those of the others follow; or a list of seeds; None: seeds that continue the sequence
        options: not used
        """
        pool = self._open()
        if seed is None:
            seeds = self._new_seeds(self.num_envs)
        elif isinstance(seed, Sequence) or (isinstance(seed, np.ndarray) and seed.ndim > 0):
            if len(seed) != self.num_envs:
                raise _shoal.Error(f'seed must be a number or {self.num_envs} numbers, got {len(seed)}')
            seeds = [self._new_seeds(1)[0] if each is None else _seed(each) for each in seed]
        else:
            seeds = [_seed(seed) + i for i in range(self.num_envs)]
            self._seeds = np.random.SeedSequence(seeds[0])
        self._before = None
        observations = pool.step(np.zeros(self.action_space.shape), seeds)[0]
        missing = self._complete(observations)
        self._ages[:] = 0
        self._done[:] = False
        self._before = observations
        return observations.copy(), self._infos(missing=missing)

    def step(self, actions: ArrayLike) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict]:
        """Takes a step of all worlds.

        actions: (num_envs, m)

        Returns observations (num_envs, n), rewards (num_envs,), terminated and truncated (num_envs,) of bool, and a
        dict with `failed` (num_envs,) of bool: the physics of the world failed, which also terminates it, and with
        `missing` as of reset().  Raises Error for actions of another shape, and for NaN and infinity; and when `reward`
        or `terminated` gives another shape than (num_envs,).
        """
        pool = self._open()
        if self._before is None:
            raise _shoal.Error('reset() comes before step()')
        actions = checks.array('VectorEnv.step', 'actions', actions, self.action_space.shape)
        if not np.isfinite(actions).all():
            world, column = np.argwhere(~np.isfinite(actions))[0]
            raise _shoal.Error(f'VectorEnv.step: actions must be finite, got {actions[world, column]} of world {world}')
        begins = self._done.copy()
        seeds = np.full(self.num_envs, -1, np.int64)
        seeds[begins] = self._new_seeds(int(begins.sum()))
        before, self._before = self._before, None  # an exception leaves the worlds at different times
        after, status = pool.step(actions, seeds)
        missing = self._complete(after)
        rewards = np.zeros(self.num_envs) if self._reward is None else checks.array(
            'VectorEnv', 'what reward() returns', self._reward(before, actions, after), (self.num_envs,)).copy()
        terminated = status != 0
        if self._terminated is not None:
            terminated = terminated | checks.array('VectorEnv', 'what terminated() returns', self._terminated(after),
                                                   (self.num_envs,), bool)
        self._ages = np.where(begins, 0, self._ages + 1)
        truncated = np.zeros(self.num_envs, bool) if self._longest is None else self._ages >= self._longest
        rewards[begins], terminated[begins], truncated[begins] = 0, False, False
        self._done = terminated | truncated
        self._before = after
        return after.copy(), rewards, terminated, truncated, self._infos(failed=status == 2, missing=missing)

    def run_hash(self, index: int) -> int:
        """Returns the hash of the run of a world, as World.run_hash()."""
        return self._open().run_hash(checks.integer('VectorEnv.run_hash', 'index', index, 0))

    def render(self) -> None:
        """Returns None; `shoal run --view` shows a run."""

    def close(self, **_) -> None:
        """Frees the worlds."""
        self._pool = None

    def _open(self):
        if self._pool is None:
            raise _shoal.Error('the environment is closed')
        return self._pool

    def _complete(self, observations):
        """Replaces the NaN of observations; returns where they were."""
        missing = np.isnan(observations)
        np.copyto(observations, self._missing, where=missing)
        return missing

    def _infos(self, **values):
        """Returns values as Gymnasium has them: `_NAME` is true for each world that has NAME, here all."""
        return {**values, **{f'_{name}': np.ones(self.num_envs, bool) for name in values}}

    def _new_seeds(self, count):
        return [int(each.generate_state(1)[0] & 0x7fffffff) for each in self._seeds.spawn(count)]


class Env(_Joined):
    """One world with the interface of gymnasium.Env.

    `reward` and `terminated` get the arrays of one world, (1, n) and (1, m), and return (1,).

    step_s: simulated time of a step of the environment in s
    action_space, observation_space: Box of the actions (m,) and of the observations (n,)
    slices: slices of an observation, in the order of `observations`
    """

    _other = ('gymnasium', 'Env')
    metadata: dict[str, Any] = {'render_modes': []}
    render_mode = None
    spec = None

    def __init__(self, world: str | os.PathLike | dict, **arguments: Any) -> None:
        """Loads a world; reset() builds it.

        world: as of shoal.World
        arguments: the others of VectorEnv, without `num_envs`
        """
        self._envs = VectorEnv(world, 1, **arguments)
        self.action_space = self._envs.single_action_space
        self.observation_space = self._envs.single_observation_space
        self.slices, self.step_s = self._envs.slices, self._envs.step_s
        self._over = False

    @property
    def unwrapped(self) -> Env:
        """The environment itself."""
        return self

    def reset(self, *, seed: int | None = None, options: dict | None = None) -> tuple[np.ndarray, dict]:
        """Builds the world again; returns the first observation (n,) and a dict with `missing` (n,) as of VectorEnv.

        seed: None: one that continues the sequence
        options: not used
        """
        observations, info = self._envs.reset(seed=seed)
        self._reset_other(seed)
        self._over = False
        return observations[0], {'missing': info['missing'][0]}

    def step(self, action: ArrayLike) -> tuple[np.ndarray, float, bool, bool, dict]:
        """Takes a step with an action (m,).

        Returns the observation (n,), the reward, whether the episode is terminated, whether it is truncated, and a dict
        with `failed` and `missing` (n,).  After the end of an episode reset() must follow.
        """
        if self._over:
            raise _shoal.Error('the episode is over: reset() comes before step()')
        action = checks.array('Env.step', 'action', action, self.action_space.shape)
        observations, rewards, terminated, truncated, info = self._envs.step(action[None])
        self._over = bool(terminated[0] or truncated[0])
        return observations[0], float(rewards[0]), bool(terminated[0]), bool(truncated[0]), {
            'failed': bool(info['failed'][0]), 'missing': info['missing'][0]}

    def render(self) -> None:
        """Returns None; `shoal run --view` shows a run."""

    def close(self) -> None:
        """Frees the world."""
        self._envs.close()


class ParallelEnv(_Joined):
    """One world whose vehicles are agents, with the interface of pettingzoo.ParallelEnv.

    possible_agents: names of all agents
    agents: names of those that are still there; before reset() none
    action_spaces, observation_spaces: dict of the Box of each agent
    """

    _other = ('pettingzoo', 'ParallelEnv')
    metadata: dict[str, Any] = {'name': 'shoal', 'render_modes': [], 'is_parallelizable': True}
    render_mode = None

    def __init__(self, world: str | os.PathLike | dict, agents: Mapping[str, Mapping[str, str | Sequence[str]]], *,
                 steps: int = 1, reward: Callable | None = None, max_episode_s: float | None = None,
                 action_low: float = -1.0, action_high: float = 1.0, missing: float = 0.0, seed: int = 1,
                 set: dict | None = None) -> None:
        """Loads a world; reset() builds it.

        agents: dict of names and {'actions': [...], 'observations': [...]}, as in VectorEnv
        reward: reward(before, actions, after) -> dict by agent, of dicts of arrays by agent; None: zeros
        steps, max_episode_s, action_low, action_high, missing, seed, set: as in VectorEnv
        """
        agents = _agents(agents)
        if reward is not None:
            checks.function('ParallelEnv', 'reward', reward)
        self.possible_agents = list(agents)
        self.agents: list[str] = []
        self._reward = reward
        self._envs = VectorEnv(
            world, 1, steps=steps, max_episode_s=max_episode_s, seed=seed, set=set, missing=missing,
            actions=[each for agent in agents.values() for each in agent['actions']],
            observations=[each for agent in agents.values() for each in agent['observations']])
        self._actions: dict[str, slice] = {}
        self._observations: dict[str, slice] = {}
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
        self._before: dict[str, np.ndarray] = {}

    @property
    def unwrapped(self) -> ParallelEnv:
        """The environment itself."""
        return self

    @property
    def num_agents(self) -> int:
        """Number of agents that are still there."""
        return len(self.agents)

    @property
    def max_num_agents(self) -> int:
        """Number of all agents."""
        return len(self.possible_agents)

    def action_space(self, agent: str) -> Any:
        """Returns the space of the actions of an agent."""
        return self.action_spaces[agent]

    def observation_space(self, agent: str) -> Any:
        """Returns the space of the observations of an agent."""
        return self.observation_spaces[agent]

    def reset(self, seed: int | None = None,
              options: dict | None = None) -> tuple[dict[str, np.ndarray], dict[str, dict]]:
        """Builds the world again; returns dicts of first observations and infos by agent.

        The info of an agent has `missing` as of VectorEnv.

        seed: None: one that continues the sequence
        options: not used
        """
        observations, info = self._envs.reset(seed=seed)
        self.agents = list(self.possible_agents)
        self._before = self._split(observations[0])
        return dict(self._before), self._infos(missing=info['missing'])

    def step(self, actions: Mapping[str, np.ndarray]) -> tuple[dict, dict, dict, dict, dict]:
        """Takes a step with the actions of agents; those of others are zero.

        Returns dicts by agent of observations, rewards, terminated, truncated and infos with `failed` and `missing`.
        All agents leave at the end of an episode, after which reset() must follow.
        """
        if not self.agents:
            raise _shoal.Error('no agents are left: reset() comes before step()')
        row = np.zeros(self._envs.single_action_space.shape)
        for name, values in actions.items():
            if name not in self._actions:
                raise _shoal.Error(f"there is no agent '{name}'; agents: {', '.join(self.possible_agents)}")
            row[self._actions[name]] = checks.array('ParallelEnv.step', f"the action of '{name}'", values,
                                                    self.action_spaces[name].shape)
        observations, _, terminated, truncated, info = self._envs.step(row[None])
        after = self._split(observations[0])
        rewards = dict.fromkeys(self.agents, 0.0) if self._reward is None else self._rewards(
            self._reward(self._before, actions, after))
        self._before = after
        ended, cut = dict.fromkeys(self.agents, bool(terminated[0])), dict.fromkeys(self.agents, bool(truncated[0]))
        infos = self._infos(missing=info['missing'], failed=info['failed'])
        if terminated[0] or truncated[0]:
            self.agents = []
        return dict(after), rewards, ended, cut, infos

    def state(self) -> np.ndarray:
        """Returns the observations of all agents as one array."""
        if not self._before:
            raise _shoal.Error('reset() comes before state()')
        return np.concatenate(list(self._before.values()))

    def render(self) -> None:
        """Returns None; `shoal run --view` shows a run."""

    def close(self) -> None:
        """Frees the world."""
        self._envs.close()

    def _rewards(self, rewards):
        """Returns what reward() gave, if it has a number for each agent."""
        if not isinstance(rewards, Mapping) or rewards.keys() != {*self.agents}:
            raise _shoal.Error(f"ParallelEnv: what reward() returns must be a dict of {', '.join(self.agents)}, got "
                               f'{checks.shown(rewards)}')
        return {name: float(checks.array('ParallelEnv', f"the reward of '{name}'", value, ()))
                for name, value in rewards.items()}

    def _infos(self, missing, failed=None):
        return {name: {'missing': missing[0, each].copy(), **({} if failed is None else {'failed': bool(failed[0])})}
                for name, each in self._observations.items()}

    def _split(self, row):
        return {name: row[each].copy() for name, each in self._observations.items()}


def _seed(value):
    return checks.integer('reset', 'seed', value, 0)


def _agents(agents):
    """Returns the channels of each agent as lists."""
    if not isinstance(agents, Mapping) or not agents:
        raise _shoal.Error(f'ParallelEnv: agents must be a dict of at least one agent, got {checks.shown(agents)}')
    made = {}
    for name, agent in agents.items():
        if not isinstance(agent, Mapping) or agent.keys() != {'actions', 'observations'}:
            raise _shoal.Error(f"ParallelEnv: agent {checks.shown(name)} must be a dict with 'actions' and "
                               f"'observations', got {checks.shown(agent)}")
        made[checks.text('ParallelEnv', 'the name of an agent', name)] = {
            key: checks.names('ParallelEnv', f"{key} of '{name}'", agent[key]) for key in agent}
    return made


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
