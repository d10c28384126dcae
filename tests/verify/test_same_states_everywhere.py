"""States that are looked at, and what is estimated there, have the same bits on every machine."""

from __future__ import annotations

import hashlib
import math
import os
import subprocess
import sys
from collections.abc import Iterator
from types import MappingProxyType

import numpy as np
import pytest
import shipped

from symgen.verify.lanes.loops_in_lanes import LoopsInLanes
from symgen.verify.lanes.portable_lanes import sines
from symgen.verify.lanes.ranks_in_lanes import RankedPart
from symgen.verify.lanes.rates_in_lanes import RatesInLanes
from symgen.verify.lanes.rounding import RoundingErrors
from symgen.verify.lanes.small_matrices import inverses, products, pseudoinverses, times
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.reference import Reference

STATES = 40
# Those that have other bits on other machines.
VECTORISED = ("sin", "cos", "tan", "arcsin", "arccos", "arctan", "arctan2", "exp", "log", "sinh", "cosh", "tanh")
DECOMPOSITIONS = ("inv", "pinv", "solve", "svd", "lstsq", "eigvalsh")
# Kernels of linear algebra and functions that any processor has.
OLDEST = MappingProxyType({"OPENBLAS_CORETYPE": "Prescott", "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4"})


def digest() -> str:
    """What all bits of states near V of a parallel robot, of their rates and of the estimates there come to."""
    model = shipped.model("rapkm_2rrr_rr")
    reference, dice = Reference(model), np.random.default_rng(3)
    literals, n = [float(x) for x in reference.literals()], model.n
    loops = LoopsInLanes(reference.system, literals)
    parameters = np.tile([float(x) for x in default_parameters(model)], (STATES, 1))
    q, qd, qdd = (dice.uniform(-3, 3, (STATES, n)) for _ in range(3))
    whole = RankedPart(range(n), range(model.r), range(model.m), reference.ranks.constraints, reference.ranks.actuation)
    closed, shut = loops.newton(loops.damped(q, parameters), parameters)
    assert shut.any()
    given = {"q": closed, "qd": qd, "qdd": qdd, "u": dice.uniform(-1, 1, (STATES, model.m)), "p": parameters}
    rates, accelerations, _ = RatesInLanes(reference.system, [whole], loops).admissible(given)
    hashed = hashlib.sha256()
    for made in (closed, rates, accelerations):
        hashed.update(made.tobytes())
    kernels = shipped.programs("rapkm_2rrr_rr")["float64"].kernels
    inverse = next(kernel for kernel in kernels if kernel.name == "inverse_dynamics")
    for made in RoundingErrors(inverse).with_units({**given, "qd": rates, "qdd": accelerations}):
        hashed.update(made.tobytes())
    return hashed.hexdigest()


def _refuse(*_: object, **__: object) -> None:
    raise AssertionError("the last bits of this function are the machine's own")


def test_functions_of_the_machine_take_no_part(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in VECTORISED:
        monkeypatch.setattr(np, name, _refuse)
    for name in DECOMPOSITIONS:
        monkeypatch.setattr(np.linalg, name, _refuse)
    digest()


@pytest.mark.campaign
def test_an_older_processor_comes_to_the_same_bits() -> None:
    """Of libraries that choose what they run by the processor."""
    path = os.pathsep.join(sys.path)
    command = [sys.executable, "-W", "ignore", "-c", "import test_same_states_everywhere as t; print(t.digest())"]
    environment = {**os.environ, **OLDEST, "PYTHONPATH": f"{os.path.dirname(__file__)}{os.pathsep}{path}"}
    made = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert made.stdout.split() == [digest()]


def test_sines_are_those_of_the_library_to_two_units() -> None:
    dice = np.random.default_rng(5)
    angles = np.concatenate((dice.normal(size=200) * 3, dice.normal(size=200) * 1e4, [0.0, -0.0, 1e12, math.nan]))
    for made, function in zip(sines(angles), (math.sin, math.cos), strict=True):
        for angle, value in zip(angles.tolist(), made.tolist(), strict=True):
            wanted = function(angle)
            assert abs(value - wanted) <= 2 * math.ulp(wanted) or (math.isnan(angle) and math.isnan(value))


def _matrices(count: int, rows: int, columns: int) -> Iterator[np.ndarray]:
    """Matrices, the same with a row that depends on others, with one that vanishes, and with none at all."""
    plain = np.random.default_rng(rows + columns).normal(size=(count, rows, columns))
    yield plain
    if rows > 2:
        dependent, gone = plain.copy(), plain.copy()
        dependent[:, 2], gone[:, 1] = dependent[:, 0] - 2 * dependent[:, 1], 0.0
        mixed = np.where(np.arange(count)[:, None, None] % 2, plain, dependent)
        yield from (dependent, gone, mixed)
    yield 0 * plain


@pytest.mark.parametrize("shape", [(1, 1), (2, 5), (3, 3), (6, 12), (7, 4)])
def test_pseudoinverses_are_those_of_singular_values(shape: tuple[int, int]) -> None:
    for rows in _matrices(12, *shape):
        made, wanted = pseudoinverses(rows, 1e-8), np.linalg.pinv(rows, rcond=1e-8)
        assert np.abs(made - wanted).max() <= 1e-11 * (1 + np.abs(wanted).max())


def test_products_and_inverses_are_those_of_the_library() -> None:
    rows = np.random.default_rng(1).normal(size=(9, 5, 8))
    across = np.swapaxes(rows, 1, 2)
    gram = products(rows, across)
    assert np.abs(gram - rows @ across).max() <= 1e-13
    assert np.abs(inverses(gram) @ gram - np.eye(5)).max() <= 1e-10
    vectors = rows[:, 0]
    assert np.abs(times(rows, vectors) - (rows @ vectors[:, :, None])[:, :, 0]).max() <= 1e-13
