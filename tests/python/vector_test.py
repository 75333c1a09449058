#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of many worlds at once: what programs for Gymnasium and PettingZoo may expect of their interfaces."""
import inspect
import os
import signal
import threading
import unittest

import numpy as np
from support import BALL, ROOT, run_python

import shoal
from shoal import vector

ROVER = {'world': os.path.join(ROOT, 'worlds', 'minimal.yaml'), 'steps': 10,
         'actions': ['rover1.drive.cmd:twist_command_t:forward_mps,turn_radps'],
         'observations': ['rover1.lidar:ranges', '@rover1']}
# Ends itself when the ball is on the ground.
FALLING = {**BALL, 'objects': [{'name': 'ground', 'fixed': True, 'parts': [{'shape': 'plane'}]}],
           'vehicles': [{**BALL['vehicles'][0], 'position_m': [0, 0, 1]}]}


def rover(count, **more):
    return vector.VectorEnv(num_envs=count, **{**ROVER, **more})


def trajectory(envs, seed, steps=15):
    """Returns all observations of actions that depend on the seed only."""
    random = np.random.default_rng(seed)
    rows = [envs.reset(seed=seed)[0]]
    for _ in range(steps):
        rows.append(envs.step(random.uniform(-1, 1, envs.action_space.shape))[0])
    return np.array(rows)


class VectorEnvTest(unittest.TestCase):

    def test_has_the_interface_of_gymnasium(self):
        envs = rover(3)
        self.assertEqual(list(inspect.signature(envs.reset).parameters), ['seed', 'options'])
        self.assertTrue(all(each.kind == each.KEYWORD_ONLY and each.default is None
                            for each in inspect.signature(envs.reset).parameters.values()))
        self.assertEqual(list(inspect.signature(envs.step).parameters), ['actions'])
        self.assertEqual(envs.num_envs, 3)
        self.assertIs(envs.unwrapped, envs)
        self.assertIn(str(getattr(envs.metadata['autoreset_mode'], 'value', envs.metadata['autoreset_mode'])), 'NextStep')
        self.assertEqual(envs.single_action_space.shape, (2,))
        self.assertEqual(envs.action_space.shape, (3, 2))
        self.assertEqual(envs.observation_space.shape, (3, *envs.single_observation_space.shape))
        observations, infos = envs.reset(seed=5)
        self.assertIsInstance(infos, dict)
        for _ in range(4):
            self.assertIn(observations, envs.observation_space)
            self.assertEqual(observations.dtype, envs.observation_space.dtype)
            self.assertTrue(all(row in envs.single_observation_space for row in observations))
            observations, rewards, terminated, truncated, infos = envs.step(envs.action_space.sample())
            for each, dtype in (rewards, np.float64), (terminated, np.bool_), (truncated, np.bool_):
                self.assertEqual((each.shape, each.dtype), ((3,), dtype))
            self.assertIsInstance(infos, dict)
        self.assertIsNone(envs.render())
        envs.close()
        self.assertTrue(envs.closed)
        envs.close()

    def test_gives_equal_runs_for_equal_seeds_and_any_number_of_threads(self):
        envs, others = rover(4, threads=1), rover(4, threads=3)
        first = trajectory(envs, 7)
        np.testing.assert_array_equal(trajectory(envs, 7), first)
        np.testing.assert_array_equal(trajectory(others, 7), first)
        self.assertFalse(np.array_equal(trajectory(envs, 8), first))
        self.assertFalse(np.array_equal(first[:, 0], first[:, 1]))
        # World i has the seed 7 + i.
        trajectory(envs, 7)
        alone = vector.Env(**ROVER)
        alone.reset(seed=9)
        random = np.random.default_rng(7)
        for _ in range(15):
            alone.step(random.uniform(-1, 1, (4, 2))[2])
        self.assertEqual(alone._envs.run_hash(0), envs.run_hash(2))

    def test_has_the_run_hash_of_a_world(self):
        envs = rover(2)
        envs.reset(seed=3)
        for _ in range(5):
            envs.step([[0.5, 0], [0.5, 0.1]])
        world = shoal.World('minimal', seed=4)
        while world.last('rover1.lidar') is None:
            world.step()
        for _ in range(5):
            world.publish('rover1.drive.cmd', shoal.messages.twist_command_t(
                utime=world.utime, forward_mps=0.5, turn_radps=0.1))
            world.step(10)
        self.assertEqual(envs.run_hash(1), world.run_hash())

    def test_observes_the_last_messages_and_the_truth(self):
        envs = rover(1)
        observations, infos = envs.reset(seed=1)
        ranges, motion = (observations[0, each] for each in envs.slices)
        self.assertEqual(len(motion), len(vector.MOTION))
        self.assertAlmostEqual(ranges[len(ranges) // 2], 4.9 - motion[0], delta=0.3)  # the wall is at 4.9 m
        self.assertFalse(infos['missing'].any())
        for _ in range(10):
            observations, *_ = envs.step([[1.0, 0.0]])
        ranges, motion = (observations[0, each] for each in envs.slices)
        self.assertAlmostEqual(motion[vector.MOTION.index('vx_mps')], 1, delta=0.1)
        self.assertAlmostEqual(ranges[len(ranges) // 2], 4.9 - motion[0], delta=0.3)

    def test_begins_every_episode_with_observations(self):
        envs = rover(3, max_episode_s=0.3)
        first, _ = envs.reset(seed=1)
        self.assertTrue((first[:, envs.slices[0]] > 0.1).all())
        for _ in range(3):
            *_, truncated, _ = envs.step(np.zeros((3, 2)))
        self.assertTrue(truncated.all())
        again, *_, infos = envs.step(np.zeros((3, 2)))
        self.assertTrue((again[:, envs.slices[0]] > 0.1).all())
        self.assertFalse(infos['missing'].any())

    def test_says_which_observations_are_missing(self):
        # The ball's imu is silent in half of the worlds: no report within 10 s.
        silent = {'name': 'silence', 'at': 0, 'probability': 0.5,
                  'do': [{'fault': {'device': 'ball/imu', 'kind': 'silent'}}]}
        world = {**BALL, 'physics': {**BALL['physics'], 'gravity_mps2': 0}, 'events': [silent]}
        envs = vector.VectorEnv(world, 8, actions=[], observations=['@ball', 'ball.imu:utime'], missing=-1)
        observations, infos = envs.reset(seed=1)
        missing = infos['missing']
        self.assertEqual(missing.shape, observations.shape)
        self.assertTrue(0 < missing[:, -1].sum() < 8)
        np.testing.assert_array_equal(observations[:, -1] == -1, missing[:, -1])
        self.assertFalse(missing[:, :-1].any())

    def test_builds_an_episode_again_in_the_step_after_its_end(self):
        envs = rover(2, max_episode_s=0.3, reward=lambda before, actions, after: actions[:, 0])
        envs.reset(seed=1)
        self.assertAlmostEqual(envs.step_s, 0.1)
        ends = []
        for _ in range(8):
            observations, rewards, terminated, truncated, _ = envs.step(np.ones((2, 2)))
            self.assertFalse(terminated.any())
            ends.append((bool(truncated[0]), float(rewards[0])))
        # Three steps, then one that only builds the world, without a reward.
        one = [(False, 1.0), (False, 1.0), (True, 1.0), (False, 0.0)]
        self.assertEqual(ends, one * 2)

    def test_is_terminated_by_a_function_of_the_observations(self):
        envs = vector.VectorEnv(FALLING, 2, actions=[], observations=['@ball'], steps=10,
                                terminated=lambda after: after[:, 2] < 0.5)
        envs.reset(seed=1)
        steps = 0
        while not (ended := envs.step(np.zeros((2, 0)))[2]).any():
            steps += 1
        self.assertTrue(ended.all())
        self.assertAlmostEqual(steps * 0.1, np.sqrt(2 * 0.5 / 9.81), delta=0.1)
        after, *_ = envs.step(np.zeros((2, 0)))
        self.assertEqual(after[0, 2], 1)

    def test_is_terminated_by_an_event_of_the_world(self):
        world = {**FALLING, 'events': [{'name': 'over', 'at': 0.25, 'do': [{'end': {'reason': 'enough'}}]}]}
        envs = vector.VectorEnv(world, 2, actions=[], observations=['@ball'], steps=10)
        envs.reset(seed=1)
        self.assertEqual([bool(envs.step(np.zeros((2, 0)))[2][0]) for _ in range(4)], [False, False, True, False])

    def test_refuses_wrong_use(self):
        for count in [0, -1, 10**9]:
            with self.assertRaises((shoal.Error, TypeError)):
                rover(count)
        for name, wrong in [('actions', ['rover1.drive.cmd']), ('actions', ['a:no_such_t:b']),
                            ('actions', ['rover1.drive.cmd:twist_command_t:no_such']), ('observations', ['rover1.lidar']),
                            ('observations', ['@nobody']), ('observations', ['nothing:value']),
                            ('observations', ['rover1.lidar:no_such']), ('steps', 0), ('action_low', 2)]:
            with self.subTest(name=name, wrong=wrong), self.assertRaises(shoal.Error):
                rover(1, **{name: wrong})
        envs = rover(2)
        with self.assertRaisesRegex(shoal.Error, 'reset'):
            envs.step(np.zeros((2, 2)))
        with self.assertRaisesRegex(shoal.Error, 'reset'):
            envs.run_hash(1)
        for seed in [-1, 1.5, [1], [1, -2]]:
            with self.subTest(seed), self.assertRaises((shoal.Error, TypeError)):
                envs.reset(seed=seed)
        envs.reset()
        for actions in [np.zeros(2), np.zeros((2, 3)), np.zeros((3, 2)), 'ab']:
            with self.assertRaises((shoal.Error, TypeError)):
                envs.step(actions)
        with self.assertRaisesRegex(shoal.Error, 'no world 2'):
            envs.run_hash(2)
        envs.close()
        for use in [envs.reset, lambda: envs.step(np.zeros((2, 2))), lambda: envs.run_hash(0)]:
            with self.assertRaisesRegex(shoal.Error, 'closed'):
                use()

    def test_names_what_is_wrong_with_channels(self):
        for name, wrong, rule in [
                ('actions', 'rover1.drive.cnd:twist_command_t:forward_mps', "channel; did you mean 'rover1.drive.cmd'"),
                ('actions', 'own:twist_command_t:forward_mps', "action 'own': no device, metric or event reads"),
                ('actions', 'rover1.drive.cmd:imu_t:utime', "takes shoal.twist_command_t.*, got shoal.imu_t"),
                ('observations', 'rover1.lider:ranges', "publishes on this channel; did you mean 'rover1.lidar'"),
                ('observations', '@rover2', "there is no vehicle 'rover2'; did you mean 'rover1'")]:
            with self.subTest(rule), self.assertRaisesRegex(shoal.Error, rule):
                rover(1, **{name: wrong})

    def test_takes_one_text_for_a_list_of_one(self):
        envs = rover(2, actions=ROVER['actions'][0], observations='@rover1')
        self.assertEqual((envs.action_space.shape, envs.observation_space.shape), ((2, 2), (2, 13)))

    def test_does_not_broadcast(self):
        for name, wrong in [('reward', lambda before, actions, after: 1.0), ('reward', lambda *_: np.zeros((2, 1))),
                            ('reward', lambda *_: [1.0]), ('terminated', lambda after: False),
                            ('terminated', lambda after: np.zeros((2, 2), bool))]:
            envs = rover(2, **{name: wrong})
            envs.reset(seed=1)
            with self.assertRaisesRegex(shoal.Error, rf'what {name}\(\) returns must have the shape \(2,\), got'):
                envs.step(np.zeros((2, 2)))
        for name, wrong, kind in [('reward', lambda *_: None, 'numbers'), ('terminated', lambda _: [0.0, 1.0], 'bool')]:
            envs = rover(2, **{name: wrong})
            envs.reset(seed=1)
            with self.assertRaisesRegex(TypeError, rf'what {name}\(\) returns must be an array of {kind}'):
                envs.step(np.zeros((2, 2)))
        with self.assertRaisesRegex(shoal.Error, r'action_low must have the shape \(2,\), got \(1,\)'):
            rover(1, action_low=[0.0])

    def test_has_bounds_for_each_action(self):
        envs = rover(3, action_low=[0, -1.5], action_high=2)
        np.testing.assert_array_equal(envs.action_space.low, [[0, -1.5]] * 3)
        np.testing.assert_array_equal(envs.single_action_space.high, [2, 2])

    def test_checks_its_numbers(self):
        for name, wrong, rule in [('max_episode_s', -1, '> 0'), ('max_episode_s', 0, '> 0'), ('steps', 0, '>= 1'),
                                  ('max_episode_s', float('nan'), '> 0'), ('num_envs', 0, '>= 1'),
                                  ('threads', -1, '>= 0'), ('seed', -1, '>= 0'), ('missing', float('nan'), '')]:
            with self.subTest(name=name, wrong=wrong), self.assertRaisesRegex(shoal.Error, f'{name} must be {rule}'):
                rover(**{'count': 1, **({'count': wrong} if name == 'num_envs' else {name: wrong})})
        for name, wrong in [('steps', 1.5), ('missing', '0'), ('max_episode_s', '5'), ('reward', 1), ('terminated', 'x')]:
            with self.subTest(name=name, wrong=wrong), self.assertRaisesRegex(TypeError, f'VectorEnv: {name} must be a'):
                rover(1, **{name: wrong})
        envs = rover(2)
        envs.reset(seed=1)
        for wrong in [np.nan, np.inf]:
            with self.assertRaisesRegex(shoal.Error, 'actions must be finite, got .* of world 1'):
                envs.step([[0, 0], [0, wrong]])
        envs.step(np.zeros((2, 2), np.float32))

    def test_ends_a_long_step_at_ctrl_c_and_can_be_reset(self):
        envs = rover(3, steps=100_000_000, threads=2)
        envs.reset(seed=1)
        timer = threading.Timer(0.5, signal.raise_signal, (signal.SIGINT,))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            envs.step(np.zeros((3, 2)))
        timer.join()
        with self.assertRaisesRegex(shoal.Error, 'reset'):
            envs.step(np.zeros((3, 2)))
        envs.reset(seed=1)

    def test_is_used_by_one_thread_at_a_time_and_not_by_a_fork(self):
        envs = rover(2, steps=2000)
        envs.reset(seed=1)
        thread = threading.Thread(target=envs._pool.step, args=(np.zeros((2, 2)), [-1, -1]))
        thread.start()
        refused = []
        while thread.is_alive():
            try:
                envs.run_hash(0)
            except shoal.Error as error:
                refused.append(str(error))
        thread.join()
        self.assertEqual(set(refused), {'the pool is in use by another thread'})
        child = os.fork()
        if child == 0:
            try:
                envs.run_hash(0)
                code = 1
            except shoal.Error:
                code = 0
            del envs
            os._exit(code)
        self.assertEqual(os.waitpid(child, 0)[1], 0)


class EnvTest(unittest.TestCase):

    def test_has_the_interface_of_gymnasium(self):
        env = vector.Env(**ROVER, max_episode_s=0.3)
        self.assertEqual(list(inspect.signature(env.reset).parameters), ['seed', 'options'])
        self.assertEqual(list(inspect.signature(env.step).parameters), ['action'])
        observation, info = env.reset(seed=1)
        self.assertIn(observation, env.observation_space)
        self.assertEqual(list(info), ['missing'])
        self.assertFalse(info['missing'].any())
        again, _ = env.reset(seed=1)
        np.testing.assert_array_equal(again, observation)
        kinds = []
        for _ in range(3):
            observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
            self.assertIn(observation, env.observation_space)
            kinds.append((type(reward), type(terminated), truncated, type(info)))
        self.assertEqual(kinds, [(float, bool, end, dict) for end in (False, False, True)])
        with self.assertRaisesRegex(shoal.Error, 'over'):
            env.step(env.action_space.sample())
        env.reset()
        env.step(env.action_space.sample())
        with self.assertRaisesRegex(shoal.Error, r'Env.step: action must have the shape \(2,\), got \(\)'):
            env.step(1.0)
        env.close()


class ParallelEnvTest(unittest.TestCase):

    AGENTS = {name: {'actions': [f'{name}.drive.cmd:twist_command_t:forward_mps,turn_radps'],
                     'observations': [f'@{name}', f'{name}.odometry:x_m']} for name in ('rover1', 'rover2')}

    def env(self, **more):
        return vector.ParallelEnv(os.path.join(ROOT, 'worlds', 'coop_land.yaml'), self.AGENTS, steps=10,
                                  max_episode_s=0.4, **more)

    def test_has_the_interface_of_pettingzoo(self):
        env = self.env()
        self.assertEqual(env.possible_agents, ['rover1', 'rover2'])
        self.assertEqual((env.max_num_agents, env.num_agents, env.agents), (2, 0, []))
        self.assertEqual(list(inspect.signature(env.reset).parameters), ['seed', 'options'])
        self.assertEqual(list(inspect.signature(env.step).parameters), ['actions'])
        for agent in env.possible_agents:
            self.assertIs(env.observation_space(agent), env.observation_space(agent))
            self.assertIs(env.action_space(agent), env.action_space(agent))
        observations, infos = env.reset(seed=1)
        self.assertEqual(env.agents, env.possible_agents)
        self.assertEqual(set(observations), set(infos), set(env.agents))
        for step in range(1, 5):
            acting = list(env.agents)
            answers = env.step({agent: env.action_space(agent).sample() for agent in acting})
            for each in answers:
                self.assertEqual(set(each), set(acting))
            observations, rewards, terminated, truncated, infos = answers
            self.assertTrue(all(observations[agent] in env.observation_space(agent) for agent in acting))
            self.assertEqual(set(truncated.values()), {step == 4})
            self.assertFalse(any(terminated.values()))
        self.assertEqual(env.agents, [])
        with self.assertRaisesRegex(shoal.Error, 'reset'):
            env.step({})
        again, _ = env.reset(seed=1)
        self.assertEqual(env.num_agents, 2)
        self.assertEqual(env.state().shape, (2 * (13 + 1),))
        env.close()

    def test_gives_each_agent_its_own_values(self):
        def reward(before, actions, after):
            return {agent: float(after[agent][0] - before[agent][0] + after[agent][1] - before[agent][1])
                    for agent in after}

        env = self.env(reward=reward)
        env.reset(seed=1)
        for _ in range(4):
            observations, rewards, *_ = env.step({'rover1': [1.0, 0.0]})
        self.assertGreater(rewards['rover1'], 0.05)   # it drives north
        self.assertAlmostEqual(rewards['rover2'], 0, delta=0.01)
        self.assertAlmostEqual(observations['rover1'][1], -28, delta=0.5)
        self.assertAlmostEqual(observations['rover2'][1], 28, delta=0.1)
        env.reset(seed=1)
        with self.assertRaisesRegex(shoal.Error, "no agent 'nobody'"):
            env.step({'nobody': [0, 0]})
        with self.assertRaisesRegex(shoal.Error, 'shape'):
            env.step({'rover1': [0]})

    def test_refuses_wrong_agents_and_rewards(self):
        for agents, rule in [({}, 'at least one agent'), ({'a': {}}, "agent 'a' must be a dict with 'actions'"),
                             ('rover1', 'agents must be a dict'),
                             ({'a': {'actions': [], 'observation': []}}, "agent 'a'")]:
            with self.subTest(rule), self.assertRaisesRegex(shoal.Error, rule):
                vector.ParallelEnv(BALL, agents)
        with self.assertRaisesRegex(TypeError, "actions of 'a' must be a list of names, got 5"):
            vector.ParallelEnv(BALL, {'a': {'actions': 5, 'observations': []}})
        for reward, rule in [(1.0, 'must be a dict of rover1, rover2, got 1.0'), ({'rover1': 0}, 'must be a dict of'),
                             ({'rover1': 0, 'rover2': [1]}, r"the reward of 'rover2' must have the shape \(\)")]:
            env = self.env(reward=lambda *_, value=reward: value)
            env.reset(seed=1)
            with self.subTest(rule), self.assertRaisesRegex(shoal.Error, rule):
                env.step({})

    def test_takes_one_text_for_a_list_of_one(self):
        env = vector.ParallelEnv(BALL, {'ball': {'actions': [], 'observations': '@ball'}})
        self.assertEqual(env.observation_space('ball').shape, (13,))


class JoinedTest(unittest.TestCase):

    def test_environments_are_of_the_classes_of_gymnasium_where_it_is_installed(self):
        # Stands in for the packages, which Debian does not have.
        code, _, errors = run_python(
            "import sys, types\n"
            "class Env:\n"
            "    def reset(self, *, seed=None, options=None):\n"
            "        self.seeded = seed\n"
            "class VectorEnv: pass\n"
            "class ParallelEnv: pass\n"
            "class Box:\n"
            "    def __init__(self, low, high, shape, dtype):\n"
            "        self.low, self.shape = low, shape\n"
            "for name, parts in [('gymnasium', {'Env': Env}), ('gymnasium.spaces', {'Box': Box}),\n"
            "                    ('gymnasium.vector', {'VectorEnv': VectorEnv, 'AutoresetMode': types.SimpleNamespace(\n"
            "                        NEXT_STEP='mode')}), ('pettingzoo', {'ParallelEnv': ParallelEnv})]:\n"
            "    sys.modules[name] = types.ModuleType(name)\n"
            "    vars(sys.modules[name]).update(parts)\n"
            "import shoal\n"
            "from shoal import vector\n"
            "class Own(vector.Env): pass\n"
            f"ball = {BALL!r}\n"
            "envs = vector.VectorEnv(ball, 2, actions=[], observations='@ball')\n"
            "assert isinstance(envs, VectorEnv) and isinstance(envs, vector.VectorEnv)\n"
            "assert isinstance(envs.action_space, Box) and envs.metadata['autoreset_mode'] == 'mode'\n"
            "own = Own(ball, actions=[], observations='@ball')\n"
            "assert isinstance(own, Env) and isinstance(own, Own) and type(own).__name__ == 'Own'\n"
            "assert own.reset(seed=7)[0].shape == (13,) and own.seeded == 7\n"
            "pair = vector.ParallelEnv(ball, {'ball': {'actions': [], 'observations': '@ball'}})\n"
            "assert isinstance(pair, ParallelEnv)\n")
        self.assertEqual(code, 0, errors)

    def test_environments_are_plain_objects_elsewhere(self):
        self.assertIs(type(rover(1)), vector.VectorEnv)


class BoxTest(unittest.TestCase):

    def test_samples_within_its_bounds(self):
        box = vector.Box([-1, 0, -np.inf], [1, 2, np.inf], (3,))
        box.seed(3)
        first = [box.sample() for _ in range(100)]
        box.seed(3)
        np.testing.assert_array_equal([box.sample() for _ in range(100)], first)
        self.assertTrue(all(each in box for each in first))
        self.assertNotIn([2, 0, 0], box)
        self.assertNotIn([0, 0], box)
        self.assertEqual(box, vector.Box([-1, 0, -np.inf], [1, 2, np.inf], (3,)))


if __name__ == '__main__':
    unittest.main()
