# SPDX-License-Identifier: BSD-3-Clause
"""Runs estimators in Python for shoal-nav: reads one call per line as JSON, and answers those that need an answer."""

import copy
import importlib.util
import json
import math
import os
import struct
import sys
import traceback
import types

try:
    import numpy
except ImportError:
    numpy = None


def vector(numbers):
    return numpy.array(numbers, dtype=float) if numpy is not None else list(numbers)


def matrix(numbers):
    rows = [numbers[0:2], numbers[2:4]]
    return numpy.array(rows, dtype=float) if numpy is not None else rows


def pack(p, P):
    """The 12 bytes of a position: east, north in cm, deviations in cm rounded up, correlation."""
    def whole(value, size):
        limit = 2 ** (8 * size - 1) - 1
        return int(max(-limit, min(limit, round(value)))).to_bytes(size, "big", signed=True)

    deviations = [math.sqrt(max(0.0, P[i][i])) for i in (0, 1)]
    product = deviations[0] * deviations[1]
    correlation = max(-0.9999, min(0.9999, P[0][1] / product)) if product > 0 else 0
    sizes = [math.ceil(min(max(d, 0.01), 655.35) / 0.01 - 1e-9) for d in deviations]
    return whole(p[0] / 0.01, 3) + whole(p[1] / 0.01, 3) + struct.pack(">HH", *sizes) + whole(correlation * 32767, 2)


def unpack(payload):
    """Position and covariance of pack()."""
    p = [0.01 * int.from_bytes(payload[i:i + 3], "big", signed=True) for i in (0, 3)]
    east, north, correlation = struct.unpack(">HHh", payload[6:12])
    east, north = 0.01 * east, 0.01 * north
    across = correlation / 32767 * east * north
    return vector(p), matrix([east * east, across, across, north * north])


def shoal_nav():
    module = types.ModuleType("shoal_nav")
    module.pack, module.unpack = pack, unpack
    return module


def load(path, name):
    sys.modules["shoal_nav"] = shoal_nav()
    sys.path.insert(0, os.path.dirname(os.path.abspath(path)))
    spec = importlib.util.spec_from_file_location(os.path.splitext(os.path.basename(path))[0], path)
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)  # as an import does
    spec.loader.exec_module(module)
    if not isinstance(getattr(module, name, None), type):
        raise TypeError(f"has no class {name}")
    return getattr(module, name)


def call(estimator, what, given):
    """Makes a call, and returns its answer; None for calls without one."""
    if what == "start":
        setup = types.SimpleNamespace(**given)
        setup.position = vector(given["position"])
        setup.errors = setup.team_errors[setup.own]
        estimator.start(setup)
        return {}
    if what == "predict":
        estimator.predict(given["t"], vector(given["v"]), matrix(given["q"]))
    elif what == "fix":
        estimator.fix(given["t"], vector(given["p"]), given["std"])
    elif what in ("on_range", "on_bearing"):
        if what == "on_bearing" and not hasattr(estimator, what):
            return None
        message = types.SimpleNamespace(**given)
        message.payload = bytes.fromhex(given["payload"])
        getattr(estimator, what)(message)
    elif what == "make_payload":
        return {"payload": bytes(estimator.make_payload(given["t"], given["most"])).hex()}
    elif what == "now":
        p, P = estimator.now(given["t"])
        if len(p) != 2 or len(P) != 2 or any(len(row) != 2 for row in P):
            raise ValueError("now() must return two coordinates and a covariance of 2 x 2")
        numbers = [float(p[0]), float(p[1]), float(P[0][0]), float(P[0][1]), float(P[1][0]), float(P[1][1])]
        if not all(math.isfinite(number) for number in numbers):
            raise ValueError("now() returned numbers that are not finite")
        a, b, c, d = numbers[2:]
        if not (a > 0 and d > 0 and a * d - b * c > 0 and abs(b - c) <= 1e-6 * math.sqrt(a * d)):
            raise ValueError("now() must return a covariance that is symmetric and positive definite")
        return {"numbers": numbers}
    return None


def main():
    answers = os.fdopen(os.dup(1), "w")
    requests = os.fdopen(os.dup(0))
    os.dup2(2, 1)  # what an estimator prints is not an answer
    with open(os.devnull) as nothing:
        os.dup2(nothing.fileno(), 0)  # what it reads is not a request
    estimators, error, kind = {}, None, None
    for line in requests:
        request = json.loads(line)
        what, number = request["do"], request["id"]
        answer, cannot_work = None, False
        try:
            if what == "load":
                kind = load(request["path"], request["class"])
                answer = {"on_bearing": hasattr(kind, "on_bearing")}
            elif error is None and what == "new":
                estimators[number] = kind()
            elif error is None and what == "copy":
                estimators[number] = copy.deepcopy(estimators[request["of"]])
            elif what == "drop":
                estimators.pop(number, None)
            elif error is None:
                answer = call(estimators[number], what, request["given"])
        except (Exception, KeyboardInterrupt) as exception:  # any mistake in an estimator
            last = traceback.extract_tb(exception.__traceback__)[-1]
            place = os.path.basename(last.filename)
            where = "" if place.startswith("<") else f" ({place}:{last.lineno})"
            text = "".join(c if c.isprintable() else " " for c in str(exception))[:300]
            cannot_work = what == "start" and isinstance(exception, ValueError)
            error = f"{type(exception).__name__}: {text}{where}".encode("utf-8", "replace").decode()
        if what in ("load", "start", "make_payload", "now"):
            failed = {"error": error, "cannot_work": cannot_work}
            answers.write(json.dumps(failed if error is not None else answer) + "\n")
            answers.flush()


main()
