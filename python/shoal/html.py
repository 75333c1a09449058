# SPDX-License-Identifier: BSD-3-Clause
"""Tables of worlds and runs for notebooks."""
from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Iterable, Sequence

if TYPE_CHECKING:
    from .run import Run, Study
    from .world import World


def table(rows: Iterable[Sequence], head: Sequence[str] = ()) -> str:
    """Returns an HTML table of rows of values."""
    def row(values, cell):
        return '<tr>' + ''.join(f'<{cell}>{escape(_shown(value))}</{cell}>' for value in values) + '</tr>'
    return ('<table>' + (row(head, 'th') if head else '') + ''.join(row(values, 'td') for values in rows) +
            '</table>')


def world_table(world: World) -> str:
    """Returns the vehicles of a world, with position, speed and devices."""
    states = world.states()
    rows = [(name, ', '.join(map(_hundredths, state['position_m'])),
             _hundredths((state['velocity_mps'] ** 2).sum() ** 0.5), len(world.devices(name)))
            for name, state in zip(world.vehicles, states)]
    return (f'<b>{escape(world.name)}</b> at {world.time_s:g} s: {escape(world.description)}' +
            table(rows, ('vehicle', 'x, y, z in m', 'speed in m/s', 'devices')))


def run_table(run: Run) -> str:
    """Returns the scores of a run and how it ended."""
    summary = run.summary
    title = (f"<b>{escape(str(summary.get('world')))}</b>, {summary.get('sim_time_s', 0):g} s, "
             f"seed {escape(str(summary.get('seed')))}, run hash {escape(str(summary.get('run_hash')))}")
    rows = sorted((name, value) for name, value in run.metrics.items() if value is not None)
    return title + table(rows, ('metric', 'value'))


def study_table(study: Study) -> str:
    """Returns mean and 95 % confidence interval of each figure of a study, by case."""
    summary = study.summary
    title = (f"<b>{escape(str(summary.get('study')))}</b>: {escape(str(summary.get('description')))}; "
             f"{escape(str(summary.get('runs')))} runs")
    figures = summary.get('figures', [])
    rows = [[case['name'], *(_statistic(case['figures'].get(figure)) for figure in figures)]
            for case in summary.get('cases', [])]
    return title + table(rows, ('case', *figures))


def _statistic(entry):
    if not entry or entry.get('mean') is None:
        return '-'
    interval = entry.get('mean_95')
    bounds = '' if not interval or None in interval else f' ({interval[0]:.4g} to {interval[1]:.4g})'
    return f"{entry['mean']:.4g}{bounds}"


def _hundredths(value):
    """Returns a number with two decimals; never -0.00."""
    return f'{round(float(value), 2) + 0.0:.2f}'


def _shown(value):
    return f'{value:.4g}' if isinstance(value, float) else str(value)
