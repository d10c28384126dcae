"""Programs that call the C library's sine and cosine: no test of a range, nothing left over, the same results."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import replace

import pytest
import shipped

from symgen.backends.defaults import default_values
from symgen.backends.locals import all_statements, used_locals
from symgen.generation.results import TRIG, Options
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Block, Check, Scalar, Status
from symgen.ir.library_trig import with_library_trig
from symgen.pipeline import generate


def checks(block: Block) -> Iterator[Check]:
    for check in block.checks:
        yield check
        if check.first is not None:
            yield from checks(check.first)


@pytest.mark.parametrize("scalar", shipped.SCALARS)
@pytest.mark.parametrize("name", shipped.SWEPT)
def test_nothing_but_the_range_tests_goes(name: str, scalar: Scalar) -> None:
    portable = shipped.programs(name)[scalar]
    library = with_library_trig(portable)
    assert library.sincos is None
    for before, after in zip(portable.kernels, library.kernels, strict=True):
        assert not [c for b in after.blocks for c in checks(b) if c.status is Status.ANGLE_RANGE]
        kept = [c.status for b in before.blocks for c in checks(b) if c.status is not Status.ANGLE_RANGE]
        assert kept == [c.status for b in after.blocks for c in checks(b)]
        gone = set(all_statements(before)) - set(all_statements(after))
        assert {statement.operation for statement in gone} <= {"abs"}
        used = used_locals(after)
        assert all(used.intersection(statement.targets) for statement in after.statements)
        assert before.outputs == after.outputs


def test_far_angles_have_results_and_infinite_ones_do_not() -> None:
    program = with_library_trig(shipped.programs("front_car")["float64"])
    (kernel,) = (kernel for kernel in program.kernels if kernel.name == "constraint_jacobian")
    parameters = [float(value) for value in default_values(shipped.model("front_car")).values()]
    interpreter = Interpreter(None)
    status, far = interpreter.run(kernel, {"q": [0.0, 0.0, 1e9, 0.5]}, parameters)
    assert status is Status.OK
    assert any(abs(abs(value) - abs(math.sin(1e9))) < 1e-15 for value in far)
    assert interpreter.run(kernel, {"q": [0.0, 0.0, math.inf, 0.5]}, parameters)[0] is Status.NOT_FINITE


def test_every_file_says_whose_sine_it_calls() -> None:
    path = shipped.ROOT / "models/front_car.yaml"
    options = Options(parts=("c", "python"), outputs=("inverse_dynamics",), verify=False)
    for trig in TRIG:
        own = trig == "portable"
        files = generate(path, replace(options, trig=trig), lambda _: None).files
        assert json.loads(files["derivation.json"])["sine_and_cosine"] == trig
        for source in ("c/front_car.c", "c/front_car_f.c", "c/front_car_batch.c", "python/front_car.py"):
            assert ("_sincos" in str(files[source]) or "_pair" in str(files[source])) == own, source
        assert ("np.sin(" in str(files["python/front_car.py"])) != own
        assert ("sinf(" in str(files["c/front_car_f.c"])) != own
