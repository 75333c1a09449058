# SPDX-License-Identifier: BSD-3-Clause
"""Values of Python as YAML."""
from __future__ import annotations

import json
import math
import os
from typing import Any

from . import _shoal
from .checks import shown, text

_MAX_DEPTH = 100


def yaml_of(who: str, value: Any) -> str:
    """Returns a value as YAML on few lines: JSON, which is YAML.

    Raises Error or TypeError, for the function `who`, for what a world cannot have.
    """
    plain = _plain(who, value, 0)
    return json.dumps(plain, indent=1 if isinstance(plain, dict) and len(str(plain)) > 80 else None,
                      ensure_ascii=False)


def _plain(who, value, depth):
    """Returns a value in dicts, lists, texts and numbers; arrays and numbers of NumPy become theirs."""
    if depth > _MAX_DEPTH:
        raise _shoal.Error(f'{who}: a value may be nested at most {_MAX_DEPTH} levels deep; this one is deeper, or '
                           'contains itself')
    if isinstance(value, dict):
        return {text(who, 'a key', str(key)): _plain(who, each, depth + 1) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(who, each, depth + 1) for each in value]
    if isinstance(value, (str, os.PathLike)):
        return text(who, 'a text', os.fspath(value))
    if value is None or isinstance(value, (bool, int)):
        return value
    if isinstance(value, float):
        if not math.isfinite(value):
            raise _shoal.Error(f'{who}: a number must be finite, got {value!r}')
        return value
    if hasattr(type(value), 'tolist'):
        return _plain(who, value.tolist(), depth + 1)
    raise TypeError(f'{who}: a value must be text, a number, a list or a dict, got {shown(value)}')
