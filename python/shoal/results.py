# SPDX-License-Identifier: BSD-3-Clause
"""The results folder of a run: tracks and errors as arrays, or as DataFrame where pandas is installed.

`folder` is the path of a results folder, or a shoal.Run that has one.
"""
from __future__ import annotations

import csv
import os
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from . import checks
from ._shoal import Error

if TYPE_CHECKING:
    import pandas

    from .run import Run

    Table: TypeAlias = pandas.DataFrame | dict[str, np.ndarray]
    Folder: TypeAlias = str | os.PathLike | Run


def _file_of(folder, name):
    results = getattr(folder, 'results', folder)
    if results is None:
        raise Error('the run has no results: run() needs a folder for them')
    return os.path.join(os.fsdecode(checks.path('a results folder', 'folder', results)), name)


_TEXT = {'vehicle', 'metric', 'case', 'ended', 'run_hash'}  # these may look like numbers


def _columns(path):
    """Returns a dict of the columns of a CSV file; columns of numbers are arrays."""
    try:
        with open(path, newline='', encoding='utf-8') as file:
            rows = list(csv.reader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise Error(f'{path}: {getattr(error, "strerror", None) or error}') from None
    if not rows:
        raise Error(f'{path}: the file is empty')
    made = {}
    for index, name in enumerate(rows[0]):
        try:
            values = [row[index] for row in rows[1:]]
        except IndexError:
            raise Error(f'{path}: a row has no column {name!r}') from None
        try:
            made[name] = np.array(values, object) if name in _TEXT else np.array([float(value or 'nan')
                                                                                  for value in values])
        except ValueError:
            made[name] = np.array(values, object)
    return made


def _table(columns):
    """Returns the columns as a DataFrame where pandas is installed, else as they are."""
    try:
        import pandas
    except ImportError:
        return columns
    return pandas.DataFrame(columns)


def tracks(folder: Folder) -> Table:
    """Returns the true poses of all vehicles: columns time_s, vehicle, x_m, y_m, z_m, yaw_rad, in world axes."""
    return _table(_columns(_file_of(folder, 'tracks.csv')))


def errors(folder: Folder) -> Table:
    """Returns the errors of all estimates that metrics score.

    time_s: simulated time in s
    metric: name of the metric
    error_m: distance between estimate and truth
    estimate_x_m, estimate_y_m, estimate_z_m: estimate in world axes
    truth_x_m, truth_y_m, truth_z_m: truth in world axes
    travelled_m: distance that the vehicle has traveled
    sigma_m: standard deviation that the estimate claims; NaN: it gave none
    nees: normalized estimation error squared; NaN: there is none
    """
    return _table(_columns(_file_of(folder, 'errors.csv')))
