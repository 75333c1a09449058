# SPDX-License-Identifier: BSD-3-Clause
"""Runs of worlds to their end, and studies of many runs."""
from __future__ import annotations

import json
import os
import signal
import subprocess
from typing import TYPE_CHECKING, Sequence

from . import _shoal, checks
from .client import unanswered
from .results import _columns, _table
from .world import _source

if TYPE_CHECKING:
    from .results import Table


class Run:
    """Result of a run: run() makes it, Run.load() reads that of an earlier run.

    summary: dict, the content of summary.json
    results: the results folder; None: there is none
    """

    def __init__(self, summary: dict, results: str | os.PathLike | None = None) -> None:
        """Takes the content of a summary.json, and the results folder that it is of."""
        self.summary = summary
        self.results = results

    @classmethod
    def load(cls, results: str | os.PathLike) -> Run:
        """Returns the run whose results are in a folder.  Raises Error when there are none."""
        return cls(_json_of(os.path.join(os.fspath(results), 'summary.json')), results)

    @property
    def metrics(self) -> dict[str, float | None]:
        """The scores; None: there is no value."""
        return self.summary.get('metrics', {})

    @property
    def run_hash(self) -> str:
        """Hash of the whole run, as 16 digits."""
        return self.summary['run_hash']

    @property
    def state_hash(self) -> str:
        """Hash of the last state, as 16 digits."""
        return self.summary['state_hash']

    def __repr__(self) -> str:
        return f"<shoal.Run {self.summary.get('world')}, {self.summary.get('sim_time_s', 0):g} s>"

    def _repr_html_(self) -> str:
        from .html import run_table
        return run_table(self)


def run(world: str | os.PathLike | dict, *, seed: int | None = None, set: dict | None = None,
        duration_s: float | None = None, results: str | os.PathLike | None = None,
        record: str | os.PathLike | None = None, bus: str = 'none', lcm_url: str = '', launch: bool = False,
        wait_for: str | Sequence[str] = (), overwrite: bool = False) -> Run:
    """Runs a world as fast as possible to its end, as `shoal run` does, and returns a Run.

    world: as of World
    seed: instead of that of the file
    set: dict of dotted paths and values, as with --set
    duration_s: simulated time, instead of that of the file; 0: unlimited
    results: folder for tracks, errors and plots; None: none
    record: file for the record; None: none
    bus: 'none', or 'lcm' so that programs can take part
    lcm_url: of the bus; '' for LCM_DEFAULT_URL or LCM's default
    launch: starts the programs of the world, which needs the bus 'lcm'
    wait_for: names of lockstep clients that the run waits for (or one name), such as a Client in another thread, which
        needs the bus 'lcm'
    overwrite: replaces an existing record

    Raises Error for a world that is refused, and for a run that ends by a fault.
    """
    if checks.text('run', 'bus', bus) not in ('none', 'lcm'):
        raise _shoal.Error(f"run: bus must be 'none' or 'lcm', got {checks.shown(bus)}")
    clients = checks.names('run', 'wait_for', wait_for)
    if bus == 'none' and (clients or launch):
        needs = "wait_for needs the bus 'lcm': clients" if clients else "launch needs the bus 'lcm': programs"
        raise _shoal.Error(f"run: {needs} cannot take part with the bus 'none'")
    if seed is not None:
        seed = checks.integer('run', 'seed', seed, 0)
    if duration_s is not None:
        duration_s = checks.number('run', 'duration_s', duration_s, 0)
    path, text, sets = _source('run', world, set)
    paths = [checks.path('run', name, '' if value is None else value)
             for name, value in (('results', results), ('record', record))]
    try:
        summary = _shoal.run(path, text, seed, sets, duration_s, *paths, bus, checks.text('run', 'lcm_url', lcm_url),
                             clients, bool(launch), bool(overwrite))
    except _shoal.Error as error:
        hint = unanswered(str(error)) if clients else ''
        if not hint:
            raise
        raise _shoal.Error(f'{error}{hint}') from None
    return Run(json.loads(summary), results)


class Study:
    """Results of a study.

    summary: dict, the content of study.json
    folder: the folder of the study
    """

    def __init__(self, folder: str | os.PathLike) -> None:
        """Reads the results in a folder.  Raises Error when there are none."""
        self.folder = os.fspath(folder)
        self.summary: dict = _json_of(os.path.join(self.folder, 'study.json'))

    def table(self) -> Table:
        """Returns the figures of all runs, with columns case, seed and one for each figure."""
        return _table(_columns(os.path.join(self.folder, 'study.csv')))

    def __repr__(self) -> str:
        return f"<shoal.Study {self.summary.get('study')}>"

    def _repr_html_(self) -> str:
        from .html import study_table
        return study_table(self)


def study(file: str | os.PathLike, *, output: str | os.PathLike, seeds: str = '', duration_s: float | None = None,
          jobs: int = 0, fresh: bool = False) -> Study:
    """Executes the missing runs of a study, as `shoal study` does, and returns its results.

    file: path or name of the study
    output: its folder; finished runs in it are kept
    seeds: instead of those of the file: '7', '1-10' or '1-3,8'
    duration_s: simulated time of each run; None: as the study says
    jobs: runs at the same time; 0: one for every two processors
    fresh: repeats finished runs

    Raises Error with the text of the program when the study is refused, or a run has no result.
    """
    checks.text('study', 'seeds', seeds)
    checks.integer('study', 'jobs', jobs, 0)
    if duration_s is not None:
        checks.number('study', 'duration_s', duration_s, 0)
    for name, value in (('file', file), ('output', output)):
        checks.path('study', name, value)
    program = os.path.join(_shoal.program_folder(), 'shoal')
    arguments = [program, 'study', os.fspath(file), '--output', os.fspath(output), '--jobs', str(jobs), '--quiet',
                 *(['--seeds', seeds] if seeds else []),
                 *([] if duration_s is None else ['--duration', str(duration_s)]), *(['--fresh'] if fresh else [])]
    try:
        child = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    except OSError as error:
        raise _shoal.Error(f'{program}: {error.strerror}') from None
    try:
        _, printed = child.communicate()
    except KeyboardInterrupt:
        child.send_signal(signal.SIGINT)  # it ends its runs, which a kill would leave behind
        child.communicate()
        raise
    if child.returncode not in (0, 1):
        raise _shoal.Error(printed.strip() or f'{program} ended with exit code {child.returncode}')
    return Study(output)


def _json_of(path):
    try:
        with open(path, encoding='utf-8') as file:
            content = json.load(file)
    except (OSError, ValueError) as error:
        raise _shoal.Error(f'{path}: {getattr(error, "strerror", None) or error}') from None
    if not isinstance(content, dict):
        raise _shoal.Error(f'{path}: not the results of Shoal')
    return content
