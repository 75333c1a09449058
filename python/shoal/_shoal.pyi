# SPDX-License-Identifier: BSD-3-Clause
from typing import Any

class Error(RuntimeError, ValueError):
    """An input, a file, a message or a bus that Shoal refuses; the text is the one that the program `shoal` prints."""

def __getattr__(name: str) -> Any: ...
