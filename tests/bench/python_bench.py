# SPDX-License-Identifier: BSD-3-Clause
"""Benchmark of the Python package: what it adds to a step, to a tick and to an image, and steps of many worlds.

    PYTHONPATH=build/release/lib/python /usr/bin/python3 tests/bench/python_bench.py build/release/bin

Each figure is the best of several rounds, because other programs on the machine only make it worse.  Work within the
process is in processor time, which depends less on them; `wall` is wall time.
"""
import os
import subprocess
import sys
import time

import numpy as np

import shoal
from shoal import messages, vector

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..'))

from own_ports import own_url  # noqa: E402

BINARIES = sys.argv[1] if len(sys.argv) > 1 else 'build/release/bin'
ROUNDS = int(os.environ.get('ROUNDS', '5'))
os.environ['LCM_DEFAULT_URL'] = own_url()
GROUND = {'name': 'ground', 'fixed': True, 'parts': [{'shape': 'plane'}]}
# The shipped rover has a lidar of 180 rays, odometry and a modem; the small one has only its drive and odometry.
PLAIN = {'shoal': 1, 'name': 'plain', 'objects': [GROUND], 'vehicles': [{'name': 'rover1', 'file': 'rover.yaml'}]}
SMALL = {**PLAIN, 'vehicles': [{'name': 'rover1', 'model': {
    'shoal': 1, 'vehicle': 'small', 'materials': [{'name': 'slick'}],
    'contacts': [{'between': ['slick', 'any'], 'friction': 0}],
    'bodies': [{'name': 'base', 'parts': [
        {'name': 'chassis', 'shape': 'box', 'size_m': [0.5, 0.4, 0.12], 'position_m': [-0.01, 0, 0.14], 'mass_kg': 17},
        {'name': 'caster', 'shape': 'sphere', 'radius_m': 0.04, 'position_m': [-0.2, 0, 0.0405], 'material': 'slick'}]},
        *({'name': side, 'position_m': [0, y, 0.1], 'parts': [{'shape': 'sphere', 'radius_m': 0.1, 'mass_kg': 1.5}]}
          for side, y in (('left_wheel', 0.2), ('right_wheel', -0.2)))],
    'joints': [{'name': side, 'type': 'hinge', 'bodies': ['base', f'{side}_wheel'], 'axis': [0, 1, 0]}
               for side in ('left', 'right')],
    'devices': [{'name': 'drive', 'type': 'differential_drive', 'left_joint': 'left', 'right_joint': 'right',
                 'wheel_radius_m': 0.1, 'track_m': 0.4, 'max_speed_mps': 1.2},
                {'name': 'odometry', 'type': 'odometry', 'left_joint': 'left', 'right_joint': 'right', 'rate_hz': 20,
                 'wheel_radius_m': 0.1, 'track_m': 0.4}]}}]}
EMPTY = {'shoal': 1, 'name': 'empty', 'objects': [GROUND]}


def best(work, rounds=ROUNDS, clock=time.process_time):
    """Returns the shortest time of a call in s: processor time of all threads, or that of another clock."""
    times = []
    for _ in range(rounds):
        start = clock()
        work()
        times.append(clock() - start)
    return min(times)


def show(what, value, unit):
    print(f'{what:58} {value:12.4g} {unit}', flush=True)


def steps():
    """What a call of step() adds to the step itself."""
    count = 20_000
    for name, content in ('empty world', EMPTY), ('world with a rover', PLAIN):
        world = shoal.World(content)
        together = best(lambda: world.step(count)) / count

        def one_by_one():
            for _ in range(count):
                world.step()
        single = best(one_by_one) / count
        show(f'{name}: step in World.step({count})', 1e6 * together, 'us')
        show(f'{name}: what a call for each step adds', 1e6 * (single - together), 'us')


def pool():
    """Steps of 64 worlds on two threads, and of what they consist."""
    count, per_step, rounds = 64, 10, 40
    for name, content in ('small rover', SMALL), ('shipped rover', PLAIN):
        world = shoal.World(content)
        world.step(100)
        show(f'{name}: step of one world', 1e6 * best(lambda world=world: world.step(20_000)) / 20_000, 'us')
        envs = vector.VectorEnv(content, count, steps=per_step, threads=2,
                                observations=['@rover1', 'rover1.odometry:x_m'],
                                actions=['rover1.drive.cmd:twist_command_t:forward_mps,turn_radps'])
        envs.reset(seed=1)
        actions = np.tile([0.5, 0.2], (count, 1))

        def many(envs=envs, actions=actions):
            for _ in range(rounds):
                envs.step(actions)
        steps = count * per_step * rounds
        show(f'{name}, 64 worlds: step of a world with actions and observations', 1e6 * best(many) / steps, 'us')
        show(f'{name}, 64 worlds, two threads: steps per second of two cores', 2 * steps / best(many), '1/s')
        show(f'{name}, 64 worlds, two threads: steps per second, wall', steps / best(many, clock=time.perf_counter), '1/s')
        show(f'{name}, 64 worlds: reset of a world', 1e3 * best(lambda envs=envs: envs.reset(seed=1)) / count, 'ms')


def run_with(client, seconds, period):
    """Returns the wall time of a run as the simulator measures it."""
    run = subprocess.Popen([os.path.join(BINARIES, 'shoal'), 'run', 'minimal', '--duration', str(seconds), '--speed', 'max',
                            '--await', 'pilot', '--quiet'], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    start = client(period)
    run.wait()
    return time.perf_counter() - start


def pilot_in_python(period):
    client = shoal.Client('pilot')
    client.join(period)
    start = time.perf_counter()
    command = messages.twist_command_t()
    for utime in client.ticks():
        command.utime = utime
        command.forward_mps = 0.1
        client.publish('rover1.drive.cmd', command)
    client.close()
    return start


def pilot_in_cpp(period):
    program = subprocess.Popen([os.path.join(BINARIES, 'lockstep_pilot'), '--name', 'pilot', '--vehicle', 'rover1',
                                '--period', str(period)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    program.stderr.readline()  # joined
    start = time.perf_counter()
    program.wait()
    return start


def ticks():
    """A tick of a client that answers each step with a command, in both languages, in turn."""
    seconds, period = 30, 0.01
    times = {'Python': [], 'C++': []}
    for _ in range(ROUNDS):
        times['Python'].append(run_with(pilot_in_python, seconds, period))
        times['C++'].append(run_with(pilot_in_cpp, seconds, period))
    for name, each in times.items():
        show(f'lockstep: tick of the client in {name}, wall', 1e6 * min(each) * period / seconds, 'us')
    show('lockstep: ratio of the two', min(times['Python']) / min(times['C++']), '')


def images():
    """Receiving an image of 640 x 480 pixels, of which no byte is copied."""
    payload = messages.image_t(width=640, height=480, row_stride=640, data=np.zeros(640 * 480, np.uint8)).encode()
    count = 2000

    def decode():
        for _ in range(count):
            messages.image_t.decode(payload)
    image = messages.image_t.decode(payload)
    show('image 640x480: decode', 1e6 * best(decode) / count, 'us')
    show('image 640x480: copy of its pixels, for comparison', 1e6 * best(
        lambda: [image.data.copy() for _ in range(count)]) / count, 'us')
    show('image 640x480: bytes that are copied', 0 if not image.data.flags.owndata else image.data.nbytes, '')


if __name__ == '__main__':
    for part in (steps, pool, ticks, images):
        part()
