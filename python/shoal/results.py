# SPDX-License-Identifier: BSD-3-Clause
"""The results folder of a run: tracks and errors as arrays, or as DataFrame where pandas is installed."""
import csv
import os

import numpy as np

from ._shoal import Error


def _columns(path):
    """Returns a dict of the columns of a CSV file; columns of numbers are arrays."""
    try:
        with open(path, newline='', encoding='utf-8') as file:
            rows = list(csv.reader(file))
    except OSError as error:
        raise Error(f'{path}: {error.strerror}') from None
    if not rows:
        raise Error(f'{path}: the file is empty')
    made = {}
    for index, name in enumerate(rows[0]):
        try:
            values = [row[index] for row in rows[1:]]
        except IndexError:
            raise Error(f'{path}: a row has no column {name!r}') from None
        try:
            made[name] = np.array([float(value) for value in values])
        except ValueError:
            made[name] = np.array(values, dtype=object)
    return made


def _table(columns):
    """Returns the columns as a DataFrame where pandas is installed, else as they are."""
    try:
        import pandas
    except ImportError:
        return columns
    return pandas.DataFrame(columns)


def tracks(folder):
    """Returns the true poses of all vehicles: columns time_s, vehicle, x_m, y_m, z_m, yaw_rad."""
    return _table(_columns(os.path.join(os.fspath(folder), 'tracks.csv')))


def errors(folder):
    """Returns the errors of all estimates that metrics score.

    Columns: time_s, metric, error_m, estimate_x_m, ..., truth_x_m, ..., travelled_m, sigma_m (NaN: the estimate gave
    none), nees.
    """
    return _table(_columns(os.path.join(os.fspath(folder), 'errors.csv')))
