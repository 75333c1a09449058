# SPDX-License-Identifier: BSD-3-Clause
"""Runs of worlds to their end."""
import json
import os

from . import _shoal
from .world import _path_of
from .yaml_text import yaml_of


class Run:
    """Result of a run: `summary` is the content of summary.json."""

    def __init__(self, summary, results=None):
        self.summary = summary
        self.results = results

    @property
    def metrics(self):
        """Dict of the scores."""
        return self.summary.get('metrics', {})

    @property
    def run_hash(self):
        """Hash of the whole run, as text."""
        return self.summary['run_hash']

    @property
    def state_hash(self):
        """Hash of the last state, as text."""
        return self.summary['state_hash']

    def __repr__(self):
        return f"<shoal.Run {self.summary['world']}, {self.summary['sim_time_s']:g} s>"

    def _repr_html_(self):
        from .html import run_table
        return run_table(self)


def run(world, *, seed=None, set=None, duration_s=None, results=None, record=None, bus='none', launch=False,
        overwrite=False):
    """Runs a world as fast as possible to its end, as `shoal run` does, and returns a Run.

    world: path of a world file
    set: dict of dotted paths and values, as with --set
    results: folder for tracks, errors and plots; None: none
    record: file for the record; None: none
    bus: 'none', or 'lcm' so that programs can take part
    launch: starts the programs of the world, which needs the bus 'lcm'

    Raises Error for a world that is refused, and for a run that ends by a fault.
    """
    sets = [f'{path}={yaml_of(value)}' for path, value in (set or {}).items()]
    text = _shoal.run(_path_of(world), seed, sets, duration_s, os.fspath(results or ''), os.fspath(record or ''), bus,
                      launch, overwrite)
    return Run(json.loads(text), results)
