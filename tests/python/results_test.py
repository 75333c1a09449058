#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of runs with programs, their results as tables and plots, and studies."""
import glob
import os
import pathlib
import signal
import subprocess
import sys
import threading
import unittest

import numpy as np
from support import BALL, PACKAGE, SHOAL, run_python, scratch

import shoal
from shoal import plots, results


def is_png(path):
    with open(path, 'rb') as file:
        return file.read(8) == b'\x89PNG\r\n\x1a\n'


class RunTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.run_ = shoal.run('coop_land', duration_s=60, bus='lcm', launch=True, results=scratch('coop'))

    def test_with_programs_has_scores(self):
        metrics = self.run_.metrics
        self.assertGreater(metrics['odometry_only.rms_m'], 0)
        self.assertLess(metrics['cooperative.rms_m'], 5)
        self.assertEqual(shoal.Run.load(scratch('coop')).run_hash, self.run_.run_hash)
        printed = subprocess.run([SHOAL, 'run', 'worlds/coop_land.yaml', '--launch', '--duration', '60', '--speed', 'max'],
                                 capture_output=True, text=True, check=False)
        self.assertIn(f'run hash {self.run_.run_hash}', printed.stdout + printed.stderr)

    def test_has_tracks_and_errors_as_tables(self):
        tracks, errors = results.tracks(self.run_), results.errors(scratch('coop'))
        self.assertEqual(sorted(set(tracks['vehicle'])), ['rover1', 'rover2', 'rover3'])
        self.assertEqual(tracks['time_s'].max(), 60)
        self.assertEqual(sorted(set(errors['metric'])), ['cooperative', 'helper1', 'helper2', 'odometry_only'])
        try:
            import pandas
        except ImportError:
            self.assertIsInstance(tracks, dict)
        else:
            self.assertIsInstance(tracks, pandas.DataFrame)
            self.assertEqual(tracks['x_m'].dtype, float)

    def test_is_drawn_with_matplotlib(self):
        import matplotlib.pyplot as plt
        figure, axes = plt.subplots(1, 3, figsize=(15, 5), layout='constrained')
        self.assertIs(plots.tracks(self.run_, axes=axes[0]), axes[0])
        self.assertIs(plots.errors(self.run_, axes=axes[1]), axes[1])
        at_sea = shoal.run('coop_underwater', duration_s=200, bus='lcm', launch=True, results=scratch('sea'))
        plots.nees(at_sea, axes=axes[2])
        self.assertGreater(len(axes[2].get_legend().get_texts()), 0)
        self.assertEqual(axes[0].get_xlabel(), 'x east in m')
        self.assertEqual(len(axes[0].get_legend().get_texts()), 3)
        self.assertEqual(sorted(text.get_text() for text in axes[1].get_legend().get_texts()),
                         ['cooperative', 'helper1', 'helper2', 'odometry_only'])
        path = os.environ.get('PLOTS', scratch('plots.png'))
        figure.savefig(path)
        self.assertTrue(is_png(path))
        for one in (['cooperative'], 'cooperative'):
            self.assertEqual(len(plots.errors(self.run_, one).get_legend().get_texts()), 1)
        with self.assertRaisesRegex(shoal.Error, "of a metric 'x'; metrics with errors: .*cooperative"):
            plots.errors(self.run_, 'x')
        with self.assertRaisesRegex(shoal.Error, 'plots.nees: dimensions must be >= 1, got 0'):
            plots.nees(self.run_, dimensions=0)
        with self.assertRaisesRegex(shoal.Error, 'no metric of the run'):
            plots.nees(self.run_)
        with self.assertRaisesRegex(shoal.Error, "no errors of a metric 'none'"):
            plots.errors(self.run_, ['none'])

    def test_bounds_of_nees_are_quantiles_of_chi_square(self):
        # Abramowitz, Stegun, Handbook of Mathematical Functions, 1964, table 26.8
        for probability, degrees, expected in [(0.975, 2, 7.37776), (0.025, 2, 0.0506356), (0.95, 3, 7.81473),
                                               (0.025, 6, 1.237347)]:
            self.assertAlmostEqual(plots._chi_square(probability, degrees), expected, delta=1e-5)

    def test_shows_itself_in_notebooks(self):
        html = self.run_._repr_html_()
        self.assertIn('cooperative.rms_m', html)
        self.assertIn(self.run_.run_hash, html)
        world = shoal.World('coop_land')
        self.assertIn('rover3', world._repr_html_())
        world = shoal.World('minimal')
        world.step(100)
        self.assertIn('<td>0.00, 0.00, 0.00</td><td>0.00</td>', world._repr_html_())
        named = shoal.World({**BALL, 'name': '<b>&', 'description': '<script>'})
        self.assertNotIn('<script>', named._repr_html_())
        self.assertIn('&lt;script&gt;', named._repr_html_())

    def test_of_a_dict_has_the_hash_of_its_world(self):
        run = shoal.run(BALL, duration_s=1, seed=3)
        world = shoal.World(BALL, seed=3)
        world.run_until(1)
        self.assertEqual(run.run_hash, f'{world.run_hash():016x}')

    def test_of_a_dict_may_have_paths(self):
        worlds = [shoal.World({'shoal': 1, 'vehicles': [{'name': 'r', 'file': file}]})
                  for file in ('rover.yaml', pathlib.PurePath('rover.yaml'))]
        self.assertEqual(*[world.state_hash() for world in worlds])

    def test_may_be_done_in_several_threads(self):
        hashes = {}

        def work(seed):
            hashes[seed] = shoal.run('coop_land', duration_s=20, seed=seed % 2, results=scratch(f'thread{seed}'),
                                     record=scratch(f'thread{seed}.lcm')).run_hash

        threads = [threading.Thread(target=work, args=(seed,)) for seed in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual((hashes[0], hashes[1]), (hashes[2], hashes[3]))
        self.assertNotEqual(hashes[0], hashes[1])

    def test_says_what_is_wrong(self):
        with self.assertRaisesRegex(shoal.Error, 'no_such_world'):
            shoal.run('no_such_world')
        with self.assertRaises(shoal.Error):
            shoal.run('minimal', duration_s=-1)
        with self.assertRaises(shoal.Error):
            shoal.run('minimal', bus='carrier_pigeon')
        with self.assertRaises(shoal.Error):
            shoal.run('minimal', duration_s=1, results='/proc/nowhere')
        with self.assertRaisesRegex(shoal.Error, 'no results'):
            results.tracks(shoal.run(BALL, duration_s=0.1))
        with self.assertRaises(shoal.Error):
            results.tracks(scratch('nothing'))
        with self.assertRaises(shoal.Error):
            shoal.Run.load(scratch('nothing'))
        with open(scratch('broken.csv'), 'wb') as file:
            file.write(b'a,b\n1\n')
        with self.assertRaisesRegex(shoal.Error, "no column 'b'"):
            results._columns(scratch('broken.csv'))

    def test_checks_its_arguments_before_it_runs(self):
        for arguments, rule in [({'wait_for': ['pilot']}, "wait_for needs the bus 'lcm'"),
                                ({'wait_for': 'pilot', 'bus': 'none'}, "wait_for needs the bus 'lcm'"),
                                ({'launch': True}, "launch needs the bus 'lcm'"),
                                ({'seed': -1}, 'run: seed must be >= 0, got -1'),
                                ({'duration_s': -1}, 'run: duration_s must be >= 0 and <= 1e')]:
            with self.subTest(rule), self.assertRaisesRegex(shoal.Error, rule):
                shoal.run('no_such_world', **arguments)
        for arguments, rule in [({'wait_for': 5, 'bus': 'lcm'}, 'run: wait_for must be a list of names, got 5'),
                                ({'seed': 1.5}, 'run: seed must be an integer, got 1.5'),
                                ({'results': 5}, 'run: results must be a path, got 5'),
                                ({'bus': None}, 'run: bus must be a str, got None')]:
            with self.subTest(rule), self.assertRaisesRegex(TypeError, rule):
                shoal.run('minimal', duration_s=0.1, **arguments)
        with self.assertRaisesRegex(shoal.Error, 'study: jobs must be >= 0, got -1'):
            shoal.study('coop_land', output=scratch('none'), jobs=-1)

    def test_ends_at_ctrl_c(self):
        timer = threading.Timer(0.5, signal.raise_signal, (signal.SIGINT,))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            shoal.run('coop_land', duration_s=1e6)
        timer.join()


class StudyTest(unittest.TestCase):

    def test_has_a_table_of_its_runs(self):
        study = shoal.study('coop_land', output=scratch('study'), seeds='1-2', duration_s=20, jobs=2)
        self.assertEqual(study.summary['seeds'], [1, 2])
        table = study.table()
        self.assertEqual(list(table['seed'][:2]), [1, 2])
        html = study._repr_html_()
        self.assertIn(study.summary['cases'][0]['name'], html)
        self.assertIn('<th>case</th>', html)

    def test_says_what_is_wrong(self):
        with self.assertRaisesRegex(shoal.Error, 'no_such_study'):
            shoal.study('no_such_study', output=scratch('none'))
        with self.assertRaises(shoal.Error):
            shoal.Study(scratch('none'))


class MissingPackagesTest(unittest.TestCase):

    def test_are_named_with_their_debian_package(self):
        for missing, code in [('numpy', 'import shoal'), ('matplotlib', "import shoal; shoal.plots._axes(None)")]:
            with self.subTest(missing):
                _, _, errors = run_python(f"import sys\nsys.modules[{missing!r}] = None\n{code}\n")
                self.assertRegex(errors.splitlines()[-1], f'^ImportError: .*needs .*the Debian package python3-{missing} ')


class VenvTest(unittest.TestCase):

    def test_with_system_packages_has_the_package(self):
        folder = scratch('venv')
        subprocess.run([sys.executable, '-m', 'venv', '--system-site-packages', '--without-pip', folder], check=True)
        with open(glob.glob(folder + '/lib/python3*/site-packages')[0] + '/shoal.pth', 'w', encoding='ascii') as file:
            file.write(PACKAGE + '\n')
        environment = {key: value for key, value in os.environ.items() if key != 'PYTHONPATH'}
        done = subprocess.run([folder + '/bin/python', '-c',
                               "import shoal; world = shoal.World('minimal'); world.step(5); print(world.step_number)"],
                              env=environment, cwd='/', capture_output=True, text=True, check=False)
        self.assertEqual(done.stdout, '5\n', done.stderr)

    def test_works_without_matplotlib_and_pandas(self):
        code, _, errors = run_python(
            "import sys\n"
            "sys.modules.update(matplotlib=None, pandas=None)\n"
            "import shoal\n"
            f"assert isinstance(shoal.results.tracks('{scratch('coop')}'), dict)\n"
            if os.path.exists(scratch('coop')) else "import shoal\n")
        self.assertEqual(code, 0, errors)


if __name__ == '__main__':
    unittest.main()
