#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times of `shoal study plan`, `collect` and the overhead of each run: docs/develop/performance.md.

    campaign_bench.py BIN [--runs 10000] [--overhead 100]
"""

import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import slurm_machine  # noqa: E402

WORLD = '''shoal: 1
run: {duration_s: 0.1}
objects: [{name: ground, fixed: true, parts: [{shape: plane}]}]
vehicles: [{name: rover1, file: rover.yaml}]
metrics: [{name: distance, type: distance, vehicle: rover1}]
'''


def timed(*command, environment=None):
    """Wall and processor seconds of a command and its children."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.monotonic()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, env=environment)
    if done.returncode not in (0, 1):
        sys.exit(f'{command} ended with {done.returncode}:\n{done.stdout}{done.stderr}')
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (time.monotonic() - began,
            after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def make_results(out):
    """Copies the result of the first run to all others, as if they had been executed."""
    lines = [json.loads(line) for line in (out / 'manifest.jsonl').read_text().splitlines()[1:]]
    first = out / f'runs/{lines[0]["case"]}/seed_{lines[0]["seed"]}'
    summary = json.loads((first / 'summary.json').read_text())
    stamp = (first / 'study_stamp.txt').read_text().split('\n')[1]
    for line in lines[1:]:
        folder = out / f'runs/{line["case"]}/seed_{line["seed"]}'
        folder.mkdir(parents=True)
        summary['seed'] = line['seed']
        (folder / 'summary.json').write_text(json.dumps(summary, indent=2))
        (folder / 'study_stamp.txt').write_text(f'inputs {line["inputs"]}\n{stamp}\n')


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('bin', type=pathlib.Path)
    parser.add_argument('--runs', type=int, default=10000)
    parser.add_argument('--overhead', type=int, default=100)
    options = parser.parse_args()
    shoal = options.bin / 'shoal'
    with tempfile.TemporaryDirectory(prefix='shoal-campaign-') as name:
        folder = pathlib.Path(name)
        (folder / 'world.yaml').write_text(WORLD)
        study = folder / 'study.yaml'
        study.write_text(f'shoal: 1\nstudy: many\nworld: world.yaml\nseeds: 1-{options.runs}\n')
        out = folder / 'many'
        print('plan {} runs: {:.2f} s wall, {:.2f} s CPU'.format(
            options.runs, *timed(shoal, 'study', 'plan', study, '--output', out)))
        timed(shoal, 'study', 'run', out, '--index', 1)
        make_results(out)
        print('collect {} runs: {:.2f} s wall, {:.2f} s CPU'.format(
            options.runs, *timed(shoal, 'study', 'collect', out)))

        count = options.overhead
        study.write_text(f'shoal: 1\nstudy: few\nworld: world.yaml\nseeds: 1-{count}\n')

        def report(engine, arguments, environment=None):
            out = folder / engine
            timed(shoal, 'study', 'plan', study, '--output', out)
            wall_s, cpu_s = timed(shoal, 'study', 'run', out, '--engine', engine, *arguments, environment=environment)
            of_runs = [json.loads(path.read_text())['wall_s'] for path in out.glob('runs/**/summary.json')]
            if len(of_runs) != count:
                sys.exit(f'{engine}: {len(of_runs)} of {count} runs')
            over_ms = 1000 * (wall_s - sum(of_runs)) / count
            print(f'{engine}: {over_ms:.1f} ms of overhead for each run (wall), {1000 * cpu_s / count:.1f} ms CPU for each '
                  f'run in all')

        report('local', ['--jobs', 1])
        report('parallel', ['--jobs', 1])
        try:
            with slurm_machine.SlurmMachine() as slurm:
                for chunk in (10, count // 2):
                    print(f'chunks of {chunk}: ', end='')
                    report('slurm', ['--jobs', 1, '--chunk', chunk], slurm.environment)
                    subprocess.run(['rm', '-r', str(folder / 'slurm')], check=True)
        except slurm_machine.NotAvailable as reason:
            print(f'slurm: {reason}')


if __name__ == '__main__':
    main()
