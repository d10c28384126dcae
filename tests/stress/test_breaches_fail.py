"""A kernel that breaks the rule of statuses fails `symgen stress`, with a table of what breaks it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from symgen.ir.kernel import Status
from symgen.laboratory.stress import command, run
from symgen.laboratory.stress.families import SingularFamilies
from symgen.laboratory.stress.statuses.rule import counted
from symgen.verify.running.compile import Outcome

ROD = """
model: rod
coordinates: {a: {unit: rad, range: [-1, 1]}, s: {unit: m, range: [0.5, 1]}}
parameters:
  m: {value: 2, unit: kg, range: [1, 3]}
  J: {value: 0.3, unit: kg*m**2}
kinetic_energy: J/2*a_dot**2 + m/2*(s_dot**2 + s**2*a_dot**2)
potential_energy: m*9.81*s*sin(a)
inputs: {turn: {unit: N*m, acts_on: {a: 1}}, push: {unit: N, acts_on: {s: 1}}}
"""


class Spoilt:
    """Kernels of which one loses digits, and another one refuses every state."""

    def __init__(self, kernels: Any) -> None:
        self._kernels, self.names = kernels, kernels.names

    def run(self, name: str, state: Any, scalar: str) -> Outcome:
        outcome: Outcome = self._kernels.run(name, state, scalar)
        if name == "forward_dynamics" and scalar == "float32":
            return Outcome(outcome.status, tuple(1.001 * x for x in outcome.entries))
        return Outcome(Status.ACTUATION_RANK, outcome.entries) if name == "inverse_dynamics" else outcome


# nothing is broken where kernels are as they are: `test_units` runs the command, too
@pytest.mark.parametrize("spoilt", [pytest.param(False, marks=pytest.mark.campaign), True])
def test_breaches_of_the_rule_fail(
    spoilt: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "rod.yaml").write_text(ROD, encoding="utf-8")
    monkeypatch.setattr(command, "stress_charts", lambda _: {})  # there are no families to draw
    monkeypatch.setattr(run, "search", lambda _: SingularFamilies((), True, ()))
    if spoilt:
        monkeypatch.setattr(run, "counted", lambda r, kernels, *rest: counted(r, Spoilt(kernels), *rest))  # type: ignore[arg-type]
    code = command.run_stress(tmp_path / "rod.yaml", tmp_path / "out", 0, False, lambda _: None)
    printed = capsys.readouterr()
    assert code == spoilt
    assert ("the rule is broken by" in printed.out) == spoilt
    if spoilt:
        table = printed.out[printed.out.index("the rule is broken by") :].splitlines()
        assert [line.split()[:2] for line in table[2:5]] == [["u", "float64"], ["u", "float32"], ["qdd", "float32"]]
        assert "forward_dynamics, float32: " in printed.err
        assert "while no measure is below its threshold, as status 3" in printed.err
