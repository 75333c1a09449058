#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of worlds with meshes in several threads: ODE has one collider of meshes for all worlds of a process."""
import threading
import unittest

import numpy as np
from support import scratch

import shoal
from shoal import vector

CUBE = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
FACES = [(1, 2, 4), (1, 4, 3), (5, 7, 8), (5, 8, 6), (1, 5, 6), (1, 6, 2), (3, 4, 8), (3, 8, 7), (1, 3, 7), (1, 7, 5),
         (2, 6, 8), (2, 8, 4)]


def world_of_meshes(rays='ode'):
    """Returns a heap of cubes made of triangles that fall on each other and on a mesh, and a rover that looks at it."""
    path = scratch('cube.obj')
    with open(path, 'w', encoding='ascii') as file:
        file.writelines(f'v {x} {y} {z}\n' for x, y, z in CUBE)
        file.writelines('f %d %d %d\n' % face for face in FACES)
    cube = {'shape': 'mesh', 'mesh': path}
    return {
        'shoal': 1, 'name': 'heap', 'physics': {'rays': rays},
        'objects': [
            {'name': 'ground', 'fixed': True, 'parts': [{'shape': 'plane'}]},
            {'name': 'block', 'fixed': True, 'position_m': [5, 0, 0.5], 'parts': [cube]},
            *({'name': f'cube{i}', 'position_m': [5 + 0.2 * (i % 3), 0.15 * (i % 4), 1.7 + 1.8 * i],
               'rpy_deg': [10 * i, 5 * i, 0], 'parts': [{**cube, 'mass_kg': 20}]} for i in range(5)),
            {'name': 'ball', 'position_m': [5, 0.2, 11], 'parts': [{'shape': 'sphere', 'radius_m': 0.3, 'mass_kg': 5}]},
        ],
        'vehicles': [{'name': 'rover1', 'file': 'rover_small.yaml'}],
    }


class MeshTest(unittest.TestCase):

    def test_worlds_in_threads_of_python_have_the_runs_of_one_thread(self):
        for rays in 'ode', 'embree':
            with self.subTest(rays):
                worlds = [shoal.World(world_of_meshes(rays), seed=1 + i // 2) for i in range(6)]
                threads = [threading.Thread(target=world.step, args=(400,)) for world in worlds]
                for thread in threads:
                    thread.start()
                for thread in threads:
                    thread.join()
                alone = [shoal.World(world_of_meshes(rays), seed=seed) for seed in (1, 2, 3)]
                for world in alone:
                    world.step(400)
                self.assertEqual([world.run_hash() for world in worlds],
                                 [world.run_hash() for world in alone for _ in range(2)])
                # They have fallen on each other, and on the block of triangles.
                self.assertLess(worlds[0].time_s, 60)

    def test_a_pool_has_the_runs_of_one_thread(self):
        hashes = []
        for threads in 1, 4:
            envs = vector.VectorEnv(world_of_meshes(), 8, threads=threads, steps=40,
                                    actions=['rover1.drive.cmd:twist_command_t:forward_mps'],
                                    observations=['rover1.lidar:ranges'])
            envs.reset(seed=1)
            for _ in range(10):
                ranges, *_ = envs.step(np.full((8, 1), 0.3))
            hashes.append([envs.run_hash(i) for i in range(8)])
            self.assertLess(ranges.min(), 5)
        self.assertEqual(hashes[0], hashes[1])
        self.assertEqual(len(set(hashes[0])), 8)

    def test_worlds_are_built_and_freed_while_others_are_stepped(self):
        world = shoal.World(world_of_meshes())
        thread = threading.Thread(target=world.step, args=(1500,))
        thread.start()
        made = 0
        while thread.is_alive():
            other = shoal.World(world_of_meshes(), seed=2)
            other.step(5)
            other.branch().step(2)
            del other
            made += 1
        thread.join()
        self.assertGreater(made, 1)
        again = shoal.World(world_of_meshes())
        again.step(1500)
        self.assertEqual(again.run_hash(), world.run_hash())


if __name__ == '__main__':
    unittest.main()
