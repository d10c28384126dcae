"""Methods to be compared with: by name, labelled where they are offered, and where the published ones fail."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from symgen.cli.main import main
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Status
from symgen.lowering.schedule import schedule
from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.methods.method import INPUTS
from symgen.methods.selection import Methods
from symgen.methods.table import METHODS, Use, label
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities

# A puck with a thruster that stands and two that motors turn: any two of them move it, where they are not parallel.
PUCK = """
model: thrusters
coordinates: {a: {unit: rad}, b: {unit: rad}, x: {unit: m}, y: {unit: m}}
parameters: {J: {value: 0.3, range: [0.1, 1]}, m: {value: 2, range: [1, 4]}}
kinetic_energy: J/2*(a_dot**2 + b_dot**2) + m/2*(x_dot**2 + y_dot**2)
inputs:
  T_a: {acts_on: {a: 1}}
  T_b: {acts_on: {b: 1}}
  F_0: {acts_on: {x: 1}}
  F_a: {acts_on: {x: cos(a), y: sin(a)}}
  F_b: {acts_on: {x: cos(b), y: sin(b)}}
outputs: [inverse_dynamics, forward_dynamics]
"""
BY_A, BY_B = (1.2, 0.3), (0.3, 1.2)  # where F_0 stands best beside F_a, beside F_b
QDD = (0.7, -0.4, 1.1, 0.6)


def puck(a: float, b: float) -> Model:
    return load_text(f"{PUCK}configuration: {{a: {a}, b: {b}}}\n", "thrusters.yaml")


def run(model: Model, method: str, a: float, b: float) -> tuple[int, tuple[float, ...]]:
    """Status and u where the motors stand at `a` and `b`."""
    derived = derive_quantities(model, (INPUTS,), {INPUTS: method})
    program = schedule(derived.mechanics, derived.quantities, ("float64",))["float64"]
    parts = {"q": (a, b, 0.4, 0.2), "qd": (0.3, -0.2, 0.1, 0.5), "qdd": QDD, "u": ()}
    status, u = Interpreter(program.sincos, "float64").run(program.kernels[0], parts, (0.3, 2.0))
    return status, tuple(u)


def least(a: float, b: float) -> list[float]:
    """The smallest forces that move it so."""
    columns = np.array([[1, math.cos(a), math.cos(b)], [0, math.sin(a), math.sin(b)]])
    return [0.3 * QDD[0], 0.3 * QDD[1], *np.linalg.pinv(columns) @ (2 * np.array(QDD[2:]))]


@pytest.mark.parametrize(("start", "lost"), [(BY_A, (math.pi, 1.0)), (BY_B, (1.0, math.pi))])
def test_without_switching_the_inputs_that_the_start_chooses_fail_where_they_are_parallel(
    start: tuple[float, float], lost: tuple[float, float]
) -> None:
    model = puck(*start)
    for method in ("printed", "printed_fixed"):
        status, u = run(model, method, 0.9, 2.1)
        assert status == Status.OK
        assert u == pytest.approx(least(0.9, 2.1), rel=1e-13)
    status, u = run(model, "printed", *lost)
    assert status == Status.OK
    assert u == pytest.approx(least(*lost), rel=1e-13, abs=1e-13)
    assert run(model, "printed_fixed", *lost)[0] == Status.ACTUATION_RANK


def test_where_it_is_singular_is_told() -> None:
    model = puck(*BY_A)
    methods = Methods(model, genericity(System(model)))
    fixed, switched = (methods.choose(INPUTS, name) for name in ("printed_fixed", "printed"))
    assert not isinstance(fixed, str)
    assert not isinstance(switched, str)
    assert switched[1].validity.admitted
    singular = fixed[1].validity.singular
    assert singular
    assert [math.sin(dict(one.state)["a"]) for one in singular] == pytest.approx([0] * len(singular), abs=1e-2)


def test_one_choice_of_inputs_needs_no_switching() -> None:
    text = PUCK.replace("  F_b: {acts_on: {x: cos(b), y: sin(b)}}\n", "")
    model = load_text(text, "thrusters.yaml")
    reason = Methods(model, genericity(System(model))).choose(INPUTS, "printed_fixed")
    assert reason == "there is one choice of inputs, which `printed` takes"


def test_what_is_not_chosen_is_labelled_where_it_is_offered(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compared = [row.name for row in METHODS if row.use is Use.COMPARISON]
    assert compared == ["printed", "printed_fixed", "weighted", "kkt"]
    assert {label(quantity, row.name) for row in METHODS for quantity in row.quantities if row.use < Use.LAST} == {""}
    with pytest.raises(SystemExit):
        main(["--help"])
    printed = "".join(capsys.readouterr().out.split())
    assert f"householder,forcomparison{','.join(compared[:-1])}or{compared[-1]};" in printed
    assert "forcomparisonandaslastresortshiftedorkkt;" in printed
    file = tmp_path / "thrusters.yaml"
    file.write_text(PUCK)
    assert main(["explain", str(file), "forward_dynamics"]) == 0
    (line,) = (line for line in capsys.readouterr().out.splitlines() if line.strip().startswith("kkt ("))
    assert ", for comparison and as last resort: " in line
    assert main(["explain", str(file), "--method", "printed_fixed"]) == 0
    assert "), taken, for comparison: this method is singular where" in capsys.readouterr().out
