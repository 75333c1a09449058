# SPDX-License-Identifier: BSD-3-Clause
"""Values of Python as YAML."""
import json
import math


def yaml_of(value) -> str:
    """Returns a value as YAML on few lines: JSON, but with the numbers that JSON does not have."""
    return json.dumps(_plain(value), indent=1 if isinstance(value, dict) and len(str(value)) > 80 else None,
                      ensure_ascii=False)


def _plain(value):
    """Returns a value in dicts, lists, texts and numbers; arrays and numbers of NumPy become theirs."""
    if isinstance(value, dict):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    if hasattr(value, 'tolist'):
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        raise TypeError(f'a value of a world must be finite, got {value!r}')
    if value is None or isinstance(value, (str, bool, int, float)):
        return value
    raise TypeError(f'a value of a world must be text, a number, a list or a dict, got {value!r}')
