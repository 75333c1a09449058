# SPDX-License-Identifier: BSD-3-Clause
"""Checks of arguments: each raises one sentence with the function, the rule and the value.

A wrong type raises TypeError, a wrong value raises Error.
"""
from __future__ import annotations

import numbers
import operator
import os
from typing import Any, Iterable

import numpy as np

from . import _shoal

_INT64 = 2**63


def shown(value: Any) -> str:
    """Returns a value as short ASCII text, also one that has no text."""
    try:
        text = ascii(value)
    except Exception:
        text = f'an object of {type(value).__name__}'
    return text if len(text) <= 60 else text[:57] + '...'


def integer(who: str, name: str, value: Any, low: int = -_INT64, high: int = _INT64 - 1) -> int:
    """Returns an integer from low to high, also one of NumPy."""
    try:
        if isinstance(value, (bool, np.bool_)):
            raise TypeError
        whole = operator.index(value)
    except Exception:
        raise TypeError(f'{who}: {name} must be an integer, got {shown(value)}') from None
    if not low <= whole <= high:
        rule = f'>= {low}' if whole < low else f'<= {high}'
        raise _shoal.Error(f'{who}: {name} must be {rule}, got {shown(value)}')
    return whole


def number(who: str, name: str, value: Any, low: float, high: float = 1e9, above: bool = False) -> float:
    """Returns a number from low to high, or above low."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f'{who}: {name} must be a number, got {shown(value)}')
    try:
        real = float(value)
    except OverflowError:
        real = float('inf')
    if not (low < real if above else low <= real) or not real <= high:
        rule = f'{">" if above else ">="} {low:g} and <= {high:g}'
        raise _shoal.Error(f'{who}: {name} must be {rule}, got {shown(value)}')
    return real


def text(who: str, name: str, value: Any) -> str:
    """Returns a str that UTF-8 can hold, without the character 0."""
    if not isinstance(value, str):
        raise TypeError(f'{who}: {name} must be a str, got {shown(value)}')
    try:
        value.encode()
    except UnicodeEncodeError:
        raise _shoal.Error(f'{who}: {name} has characters that UTF-8 cannot hold, got {shown(value)}') from None
    if '\0' in value:
        raise _shoal.Error(f'{who}: {name} must not have the character 0, got {shown(value)}')
    return value


def names(who: str, name: str, value: Any) -> list[str]:
    """Returns a list of names; one name is a list of one."""
    if isinstance(value, str):
        return [text(who, name, value)]
    if isinstance(value, Iterable) and not isinstance(value, (bytes, bytearray, memoryview)):
        return [text(who, f'each of {name}', each) for each in value]
    raise TypeError(f'{who}: {name} must be a list of names, got {shown(value)}')


def path(who: str, name: str, value: Any) -> str | bytes:
    """Returns a path as the module takes it: bytes when it is not UTF-8."""
    try:
        plain = os.fspath(value)
        encoded = os.fsencode(plain)
    except UnicodeEncodeError:
        raise _shoal.Error(f'{who}: {name} has characters that a path cannot hold, got {shown(value)}') from None
    except Exception:
        raise TypeError(f'{who}: {name} must be a path, got {shown(value)}') from None
    if b'\0' in encoded:
        raise _shoal.Error(f'{who}: {name} must not have the character 0, got {shown(value)}')
    try:
        return encoded.decode()
    except UnicodeDecodeError:
        return encoded


def function(who: str, name: str, value: Any) -> None:
    """Checks that a value may be called."""
    if not callable(value):
        raise TypeError(f'{who}: {name} must be a function, got {shown(value)}')


def array(who: str, name: str, value: Any, shape: tuple[int, ...], dtype: Any = float) -> np.ndarray:
    """Returns an array of a shape, without broadcasting."""
    kind = 'bool' if dtype is bool else 'numbers'
    try:
        made = np.asarray(value)
        if not (made.dtype == bool if dtype is bool else np.can_cast(made.dtype, float, 'same_kind')):
            raise TypeError
    except Exception:
        raise TypeError(f'{who}: {name} must be an array of {kind}, got {shown(value)}') from None
    if made.shape != shape:
        raise _shoal.Error(f'{who}: {name} must have the shape {shape}, got {made.shape}')
    return made.astype(dtype, copy=False)
