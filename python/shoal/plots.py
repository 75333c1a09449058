# SPDX-License-Identifier: BSD-3-Clause
"""Plots of a results folder as axes of matplotlib, which must be installed (python3-matplotlib).

`folder` is the path of a results folder, or a shoal.Run that has one; `axes` are those to draw into, None: new ones;
`metrics` are names of metrics, or one name; None: all.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Sequence

import numpy as np

from ._shoal import Error
from .checks import integer, names
from .results import _columns, _file_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .results import Folder

# Colors of vehicles by their place in the results, as on the live page: the table of sim/base/vehicle_colors.hpp.
VEHICLE_COLORS = ('#56b4e9', '#e69f00', '#009e73', '#d55e00', '#cc79a7', '#0072b2', '#a6761d', '#8c6bb1')


def _axes(axes):
    if axes is not None:
        return axes
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError('shoal.plots needs matplotlib: install the Debian package python3-matplotlib '
                          f'({error})') from None
    return plt.figure(layout='constrained').add_subplot()


def _legend(axes):
    if axes.get_legend_handles_labels()[0]:
        axes.legend()


def tracks(folder: Folder, axes: Axes | None = None) -> Axes:
    """Draws the true track of every vehicle, seen from above, in m; returns the axes."""
    axes = _axes(axes)
    columns = _columns(_file_of(folder, 'tracks.csv'))
    for number, vehicle in enumerate(dict.fromkeys(columns['vehicle'])):
        own = columns['vehicle'] == vehicle
        color = VEHICLE_COLORS[number % len(VEHICLE_COLORS)]
        axes.plot(columns['x_m'][own], columns['y_m'][own], label=vehicle, color=color)
        axes.plot(columns['x_m'][own][:1], columns['y_m'][own][:1], 'o', color=color)
    axes.set_aspect('equal', adjustable='datalim')
    axes.set_xlabel('x east in m')
    axes.set_ylabel('y north in m')
    _legend(axes)
    return axes


def _by_metric(folder, metrics):
    columns = _columns(_file_of(folder, 'errors.csv'))
    chosen = None if metrics is None else names('plots', 'metrics', metrics)
    for metric in dict.fromkeys(columns['metric']) if chosen is None else chosen:
        if metric not in columns['metric']:
            known = ', '.join(dict.fromkeys(columns['metric'])) or 'none'
            raise Error(f"the run has no errors of a metric '{metric}'; metrics with errors: {known}")
        own = columns['metric'] == metric
        yield metric, {name: values[own] for name, values in columns.items()}


def errors(folder: Folder, metrics: str | Sequence[str] | None = None, axes: Axes | None = None) -> Axes:
    """Draws position error against time in m, with three times the sigma that the estimate claims; returns the axes."""
    axes, bounded = _axes(axes), False
    for metric, own in _by_metric(folder, metrics):
        line, = axes.plot(own['time_s'], own['error_m'], label=metric)
        if np.isfinite(own['sigma_m']).any():
            bounded = True
            axes.plot(own['time_s'], 3 * own['sigma_m'], '--', color=line.get_color(), linewidth=0.8)
    axes.set_xlabel('time in s')
    axes.set_ylabel('error in m (dashed: three times its own sigma)' if bounded else 'error in m')
    _legend(axes)
    return axes


def nees(folder: Folder, metrics: str | Sequence[str] | None = None, axes: Axes | None = None,
         dimensions: int = 2) -> Axes:
    """Draws the normalized estimation error squared against time, with the 95 % interval of a consistent filter.

    dimensions: number of coordinates of the estimate; the interval is that of chi-square with as many degrees of
        freedom (Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, section
        5.4)
    """
    integer('plots.nees', 'dimensions', dimensions, 1, 100)
    known = [(metric, own) for metric, own in _by_metric(folder, metrics) if np.isfinite(own['nees']).any()]
    if not known:
        raise Error('no metric of the run has a NEES: those of the type consistency have one')
    axes = _axes(axes)
    for metric, own in known:
        axes.plot(own['time_s'], own['nees'], label=metric)
    low, high = _chi_square(0.025, dimensions), _chi_square(0.975, dimensions)
    axes.axhspan(low, high, color='0.9', zorder=0)
    axes.set_yscale('log')
    axes.set_xlabel('time in s')
    axes.set_ylabel(f'NEES (grey: 95 % interval of {dimensions} dimensions)')
    _legend(axes)
    return axes


def _chi_square(probability, degrees):
    """Returns the quantile of chi-square, by bisection of its distribution (a series of the incomplete gamma)."""
    from math import exp, gamma

    def distribution(x):
        a, x = degrees / 2, x / 2
        term = total = 1 / a
        n = 0
        while term > 1e-14 * total:
            n += 1
            term *= x / (a + n)
            total += term
        return total * x ** a * exp(-x) / gamma(a)
    low, high = 0.0, 200.0
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if distribution(middle) < probability else (low, middle)
    return (low + high) / 2
