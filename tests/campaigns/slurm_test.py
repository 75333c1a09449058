#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""`shoal study run --engine slurm` on a real Slurm of one machine.

    slurm_test.py BIN [STUDY] [--seeds SEEDS] [--duration S] [--chunk N] [--jobs N]

Without STUDY: eight short runs.  The node is killed in the middle and started again.  Nothing is lost, and the table
equals that of the local engine but for wall times.  Exit code 77: Slurm is not installed or cannot start.
"""

import argparse
import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import slurm_machine  # noqa: E402

WORLD = '''shoal: 1
run: {duration_s: 400}
objects: [{name: ground, fixed: true, parts: [{shape: plane}]}]
vehicles: [{name: rover1, file: rover.yaml, position_m: [0, 0, 0.2]}]
metrics: [{name: distance, type: distance, vehicle: rover1}]
'''
STUDY = '''shoal: 1
study: short
world: world.yaml
seeds: 1-4
factors: [{name: g, paths: [physics.gravity_mps2], values: [9.8, 1.6]}]
'''


def table(folder):
    with open(folder / 'study.csv', newline='', encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        del row['wall_s']
    return rows


class Test:
    def __init__(self, shoal, folder, study, changes):
        self.shoal, self.folder, self.study, self.changes = shoal, folder, study, changes

    def call(self, *arguments, environment=None, codes=(0,)):
        done = subprocess.run([self.shoal, 'study', *map(str, arguments)], env=environment, capture_output=True,
                              text=True, check=False)
        if done.returncode not in codes:
            sys.exit(f'shoal study {arguments} ended with {done.returncode}:\n{done.stdout}{done.stderr}')
        return done

    def plan(self, name):
        self.call('plan', self.study, '--output', self.folder / name, *self.changes)
        return self.folder / name

    def stamps(self, out):
        return len(list(out.glob('runs/**/study_stamp.txt')))

    def run(self, slurm, out, chunk):
        began = time.monotonic()
        options = ['--engine', 'slurm', '--jobs', '1', '--chunk', str(chunk)]
        print(self.call('run', out, *options, '--no-wait', environment=slurm.environment).stderr.strip())
        # As after a kill of the first command: this one waits for the jobs in the queue.
        runner = subprocess.Popen([self.shoal, 'study', 'run', str(out), *options], env=slurm.environment,
                                  stderr=subprocess.PIPE, text=True)
        try:
            runs = sum(1 for _ in open(out / 'manifest.jsonl', encoding='utf-8')) - 1
            while self.stamps(out) < max(1, runs // 3):
                if runner.poll() is not None:
                    sys.exit('ended before the node was killed:\n' + runner.stderr.read())
                time.sleep(0.05)
            slurm.kill_node()
            left = self.stamps(out)
            print(f'node killed after {left} of {runs} runs')
            if left == runs:
                sys.exit('all runs were done before the node was killed')
            slurm.start_node()
            errors = runner.communicate(timeout=7200)[1]
        finally:
            if runner.poll() is None:
                runner.kill()
                runner.wait()
        if runner.returncode != 0:
            sys.exit(f'the engine ended with {runner.returncode}:\n{errors}')
        if 'jobs of an earlier call are still in the queue' not in errors or 'submitted' in errors:
            sys.exit('the jobs in the queue were submitted again:\n' + errors)
        return time.monotonic() - began


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('bin', type=pathlib.Path)
    parser.add_argument('study', nargs='?')
    parser.add_argument('--seeds')
    parser.add_argument('--duration')
    parser.add_argument('--chunk', type=int, default=1)
    parser.add_argument('--jobs', default='2')
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix='shoal-slurm-') as name:
        folder = pathlib.Path(name)
        study = options.study
        if not study:
            (folder / 'world.yaml').write_text(WORLD)
            (folder / 'study.yaml').write_text(STUDY)
            study = folder / 'study.yaml'
        changes = []
        for name, value in (('--seeds', options.seeds), ('--duration', options.duration)):
            changes += [name, value] if value else []
        test = Test(str(options.bin / 'shoal'), folder, study, changes)
        try:
            machine = slurm_machine.SlurmMachine(cpus=os.cpu_count(), max_array_size=101 if options.study else 4)
            with machine as slurm:
                out = test.plan('slurm%a')  # % starts a replacement in names of logs
                wall_s = test.run(slurm, out, options.chunk)
                runs = test.stamps(out)
                if not list((out / 'slurm').glob('[0-9]*_[0-9]*.log')):
                    sys.exit('no logs in the folder of the study')
                print(f'{runs} runs by Slurm in {wall_s:.1f} s')
                # All is done: nothing is submitted.
                again = test.call('run', out, '--engine', 'slurm', environment=slurm.environment)
                if f'{runs} of {runs} runs were already done' not in again.stderr:
                    sys.exit('finished runs were submitted again:\n' + again.stderr)
        except slurm_machine.NotAvailable as reason:
            print(f'skipped: {reason}')
            sys.exit(77)
        local = test.plan('local')
        began = time.monotonic()
        test.call('run', local, '--jobs', options.jobs)
        print(f'{runs} runs by the local engine in {time.monotonic() - began:.1f} s')
        for each in (out, local):
            began = time.monotonic()
            test.call('collect', each, codes=(0, 1))
            print(f'collected in {time.monotonic() - began:.2f} s')
        if table(out) != table(local):
            sys.exit('the tables differ')
        print(f'the tables of {runs} runs are equal')


if __name__ == '__main__':
    main()
