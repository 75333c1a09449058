#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of wrong use: whatever is passed to the package, it raises an exception and the interpreter lives."""
import copy
import gc
import inspect
import itertools
import os
import pickle
import random
import threading
import unittest

import numpy as np
from support import BALL, SCRATCH, run_python, scratch

import shoal
from shoal import _shoal, messages, plots, results, vector


os.chdir(SCRATCH)  # some wrong values are valid names of files


class Hostile:
    """Object whose every use fails."""

    def __getattr__(self, name):
        raise RuntimeError(name)

    def _fail(self, *_):
        raise RuntimeError('hostile')

    __len__ = __iter__ = __getitem__ = __int__ = __float__ = __index__ = __str__ = __repr__ = __bool__ = _fail
    __array__ = __fspath__ = __hash__ = __eq__ = __call__ = _fail


CYCLE: dict = {}
CYCLE['self'] = CYCLE
WRONG = [None, True, -1, 0, 2**70, -2**70, 1.5, float('nan'), float('inf'), '', 'x', '\0', '\ud800', 'x' * 100_000, b'',
         b'\xff' * 9, [], [None], {}, {'a': 1}, CYCLE, (), object(), Hostile(), int, print, np.zeros(3), np.array('x'),
         np.zeros((2, 0)), np.array([object()]), complex(1, 2), memoryview(b'abc'), range(3), BALL]
# What Python itself raises for wrong types and values.  A RecursionError is a RuntimeError, as is shoal.Error.
ALLOWED = (TypeError, ValueError, RuntimeError, OverflowError, AttributeError, KeyError, IndexError)


class WrongTypesTest(unittest.TestCase):

    def check_text(self, error):
        """Checks that an error is a sentence of the package, not one of its machinery."""
        text = str(error)
        self.assertNotIsInstance(error, (RecursionError, UnicodeError), text)
        self.assertNotIn('incompatible function arguments', text)

    def attack(self, function, count, seed=1, limit=400, check=lambda error: None):
        """Calls a function with combinations of wrong values; returns how many calls it refused."""
        choices = list(itertools.islice(itertools.product(WRONG, repeat=count), 200_000))
        random.Random(seed).shuffle(choices)
        refused = 0
        for values in choices[:limit]:
            try:
                function(*values)
            except ALLOWED as error:
                check(error)
                refused += 1
        return refused

    def test_of_a_world_raise(self):
        world = shoal.World(BALL)
        snapshot = world.snapshot()
        for name, method in inspect.getmembers(world, inspect.ismethod):
            if name.startswith('_') and name != '__init__' or name in ('step', 'run_until'):
                continue
            count = len([each for each in inspect.signature(method).parameters.values()
                         if each.kind == each.POSITIONAL_OR_KEYWORD])
            if count:
                self.assertGreater(self.attack(method, count, check=self.check_text), 10, name)
        for wrong in WRONG:
            with self.subTest(wrong=type(wrong)):
                if not isinstance(wrong, int) or abs(wrong) > 2**63 or wrong < 0:
                    for method in world.step, world.run_until:
                        with self.assertRaises(ALLOWED):
                            method(wrong if wrong != 1.5 else 'x')
        world.restore(snapshot)
        world.step(10)

    def test_of_its_subscriptions_raise(self):
        world = shoal.World(BALL)
        subscription = world.subscribe('ball.imu')
        with self.assertRaises(ALLOWED):
            shoal.Subscription(None).take()
        world.step(3)
        self.assertEqual(len(subscription.take()), 3)

    def test_of_new_objects_raise(self):
        for make in [shoal.World, lambda wrong: shoal.World(BALL, seed=wrong), lambda wrong: shoal.World(BALL, set=wrong),
                     shoal.run, shoal.Client, lambda wrong: shoal.Client('a', wrong), shoal.read, shoal.Run.load,
                     lambda wrong: shoal.RecordWriter(wrong), shoal.Study, results.tracks, results.errors, plots.tracks,
                     lambda wrong: shoal.table(wrong, wrong), lambda wrong: vector.VectorEnv(wrong, 2, actions=[],
                                                                                           observations=[])]:
            refused = 0
            for wrong in WRONG:
                if wrong is BALL:
                    continue
                try:
                    make(wrong)
                except (*ALLOWED, OSError) as error:
                    self.check_text(error)
                    refused += 1
            self.assertGreater(refused, 15, make)

    def test_of_vector_environments_raise(self):
        for name in ['num_envs', 'actions', 'observations', 'steps', 'seed', 'set', 'threads', 'missing', 'action_low',
                     'max_episode_s', 'reward', 'terminated']:
            refused = 0
            for wrong in WRONG:
                if isinstance(wrong, int) and 0 < wrong < 2**60:
                    continue
                try:
                    vector.VectorEnv(BALL, **{**{'num_envs': 1, 'actions': [], 'observations': []}, name: wrong})
                except ALLOWED as error:
                    self.check_text(error)
                    refused += 1
            self.assertGreater(refused, 10, name)

    def test_of_a_client_and_of_runs_raise(self):
        client = shoal.Client('pilot')
        client.set_wait_warning(0)
        for use in [client.subscribe, client.publish, client.follow, client.on_rewind, client.wait_until,
                    client.set_silence_limit, client.set_wait_warning,
                    lambda wrong: client.join(wrong, wait_s=0), lambda wrong: client.join(0.1, wrong, wait_s=0),
                    lambda wrong: client.join(0.1, timeout_s=wrong, wait_s=0), lambda wrong: client.join(0.1, wait_s=wrong),
                    shoal.set_log_level, lambda wrong: shoal.read('x', wrong),
                    *(lambda wrong, name=name: shoal.run(BALL, **{'duration_s': 0.01, name: wrong})
                      for name in ['seed', 'set', 'duration_s', 'results', 'record', 'bus', 'lcm_url', 'wait_for'])]:
            count, refused = 2 if use in (client.subscribe, client.publish) else 1, 0
            for wrong in WRONG:
                if type(wrong) in (int, float):
                    continue  # some are right, and would wait
                try:
                    use(*[wrong] * count)
                except ALLOWED as error:
                    self.check_text(error)
                    refused += 1
            self.assertGreater(refused, 10, use)

    def test_of_the_module_raise(self):
        # Its functions are private, but a mistake in the package must not crash either.
        for name in ['decode', 'encode', 'message_type', 'decode_any', 'world_file']:
            count = 1 if name in ('decode_any', 'message_type', 'world_file') else 2
            self.assertGreater(self.attack(getattr(_shoal, name), count), 20, name)
        for kind in [_shoal.World, _shoal.Client, _shoal.Pool, _shoal.RecordReader, _shoal.RecordWriter,
                     _shoal.Subscription]:
            empty = kind.__new__(kind)  # not initialized
            for name in dir(kind):
                if name.startswith('__'):
                    continue
                try:
                    found = getattr(empty, name)
                    if callable(found):
                        found()
                except ALLOWED:
                    pass
            with self.assertRaises(TypeError):
                kind(*WRONG[:3])
            with self.assertRaises(TypeError):
                pickle.dumps(empty)

    def test_of_messages_raise(self):
        types = [messages.planar_lidar_t, messages.image_t, messages.sim_tick_t, messages.imu_t]
        names = {each: [member[0] for member in each._members] for each in types}
        for each in types:
            refused = 0
            for name, wrong in itertools.product(names[each], WRONG):
                message = each()
                try:
                    setattr(message, name, wrong)
                    each.decode(message.encode())
                except ALLOWED:
                    refused += 1
            self.assertGreater(refused, 50)
        for wrong in WRONG:
            for function in [messages.decode, messages.imu_t.decode, messages.payload_of]:
                try:
                    function(wrong)
                except ALLOWED:
                    pass

    def test_of_messages_without_members_raise(self):
        message = messages.imu_t.__new__(messages.imu_t)
        with self.assertRaisesRegex(shoal.Error, 'needs the member'):
            message.encode()
        repr(message)


class DeadObjectsTest(unittest.TestCase):

    def test_views_outlive_their_messages(self):
        images = []
        for number in range(50):
            payload = messages.image_t(width=10, height=10, data=np.full(100, number)).encode()
            images.append(messages.image_t.decode(payload).data)
            del payload
        gc.collect()
        self.assertEqual([int(image.sum()) for image in images], [100 * number for number in range(50)])

    def test_subscriptions_and_states_outlive_their_world(self):
        world = shoal.World(BALL)
        subscription, states = world.subscribe('ball.imu'), world.states()
        world.step(5)
        del world
        gc.collect()
        self.assertEqual(len(subscription.take()), 5)
        self.assertEqual(states['position_m'][0, 2], 100)

    def test_handlers_may_drop_their_client(self):
        code, _, errors = run_python(
            "import shoal, threading\n"
            "clients = [shoal.Client('a')]\n"
            "clients[0].on_rewind(lambda utime: clients.clear())\n"
            "clients[0].subscribe('b', lambda message: clients.clear())\n"
            "clients[0].follow(1)\n"
            "client = clients[0]\n"
            "threading.Timer(0.2, client.stop).start()\n"
            "del client\n"
            "clients[0].next_tick()\n"
            "clients.clear()\n")
        self.assertEqual(code, 0, errors)

    def test_worlds_may_be_in_cycles(self):
        for _ in range(20):
            world = shoal.World(BALL)
            world.itself = [world, world.subscribe('ball.imu')]
            del world
        gc.collect()


class PickleTest(unittest.TestCase):

    def test_of_messages_is_a_copy(self):
        for name in messages.types():
            message = getattr(messages, name)()
            self.assertEqual(pickle.loads(pickle.dumps(message)), message)
            self.assertEqual(copy.deepcopy(message), message)

    def test_of_garbage_raises(self):
        good = pickle.dumps(messages.planar_lidar_t(ranges=np.ones(10)))
        self.assertIn(b'_restore', good)
        generator, refused = random.Random(2), 0
        for function, arguments in [(messages._restore, (wrong, b'x')) for wrong in WRONG] + [
                (messages._restore, ('imu_t', wrong)) for wrong in WRONG]:
            with self.assertRaises(ALLOWED):
                function(*arguments)
        # Only the payload within is changed: any other change could name any function.
        payload = messages.planar_lidar_t(ranges=np.ones(10)).encode()
        start = good.index(payload)
        for _ in range(2000):
            changed = bytearray(good)
            changed[start + generator.randrange(len(payload))] = generator.randrange(256)
            try:
                pickle.loads(bytes(changed))
            except shoal.Error:
                refused += 1
        self.assertGreater(refused, 300)
        with self.assertRaises(TypeError):
            pickle.dumps(shoal.World(BALL)._own)


class ForkTest(unittest.TestCase):

    def test_child_may_use_nothing_and_make_everything(self):
        code, printed, errors = run_python(
            "import os, shoal, sys\n"
            "from shoal import vector\n"
            f"ball = {BALL!r}\n"
            f"record = shoal.RecordWriter({scratch('fork.mcap')!r}, overwrite=True)\n"
            "record.write('a', 1, shoal.messages.utime_t())\n"
            "world, client = shoal.World(ball), shoal.Client('a')\n"
            "envs = vector.VectorEnv(ball, 4, actions=[], observations=['@ball'], threads=2)\n"
            "envs.reset(seed=1)\n"
            "child = os.fork()\n"
            "if child == 0:\n"
            "    refused = 0\n"
            "    for use in [world.step, envs.reset, record.close, lambda: client.publish('a', b'x')]:\n"
            "        try:\n"
            "            use()\n"
            "        except shoal.Error as error:\n"
            "            refused += 'fork' in str(error)\n"
            "    world = shoal.World(ball)\n"
            "    world.step(10)\n"
            "    del record, client, envs\n"
            "    print(refused, world.step_number, flush=True)\n"
            "    sys.exit(0)\n"
            "assert os.waitpid(child, 0)[1] == 0\n"
            "world.step(10)\n"
            "record.close()\n"
            f"print(len(list(shoal.read({scratch('fork.mcap')!r}))))\n")
        self.assertEqual((code, printed), (0, '4 10\n1\n'), errors)


class ThreadsTest(unittest.TestCase):

    def test_that_share_a_world_get_errors_and_no_crash(self):
        world = shoal.World(BALL)
        uses = [lambda: world.step(20), world.states, world.snapshot, lambda: world.last('ball.imu'), world.channels,
                lambda: world.publish('b', messages.utime_t()), world.branch, world.run_hash, world.vehicles.copy,
                lambda: world.do({'gravity_mps2': 9.8})]
        refused = []

        def work(seed):
            generator = random.Random(seed)
            for _ in range(500):
                try:
                    generator.choice(uses)()
                except shoal.Error as error:
                    refused.append(str(error))

        threads = [threading.Thread(target=work, args=(seed,)) for seed in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(set(refused) - {'the world is in use by another thread'}, set())
        world.step(10)


if __name__ == '__main__':
    unittest.main()
