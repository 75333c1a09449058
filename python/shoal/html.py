# SPDX-License-Identifier: BSD-3-Clause
"""Tables of worlds and runs for notebooks."""
from html import escape


def table(rows, head=()):
    """Returns an HTML table of rows of values."""
    def row(values, cell):
        return '<tr>' + ''.join(f'<{cell}>{escape(_shown(value))}</{cell}>' for value in values) + '</tr>'
    return ('<table>' + (row(head, 'th') if head else '') + ''.join(row(values, 'td') for values in rows) +
            '</table>')


def world_table(world):
    """Returns the vehicles of a world, with position, speed and devices."""
    states = world.states()
    rows = [(name, ', '.join(f'{x:.2f}' for x in state['position_m']),
             (state['velocity_mps'] ** 2).sum() ** 0.5, len(world.devices(name)))
            for name, state in zip(world.vehicles, states)]
    return (f'<b>{escape(world.name)}</b> at {world.time_s:g} s: {escape(world.description)}' +
            table(rows, ('vehicle', 'x, y, z in m', 'speed in m/s', 'devices')))


def run_table(run):
    """Returns the scores of a run and how it ended."""
    summary = run.summary
    title = f"<b>{escape(summary['world'])}</b>, {summary['sim_time_s']:g} s, seed {summary['seed']}"
    rows = sorted((name, value) for name, value in summary.get('metrics', {}).items() if value is not None)
    return title + table(rows, ('metric', 'value'))


def _shown(value):
    return f'{value:.4g}' if isinstance(value, float) else str(value)
