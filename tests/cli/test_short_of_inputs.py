"""A trolley and its hoist cannot swing the load: that is said where u is called and where it is made."""

from __future__ import annotations

from pathlib import Path

import pytest

from symgen.cli import main as cli

CRANE = """\
model: crane
coordinates:
  x: {unit: m}
  l: {unit: m, range: [1, 5]}
  theta: {unit: rad}
parameters:
  m_t: {value: 20, unit: kg}
  m_l: {value: 5, unit: kg}
kinetic_energy: m_t*x_dot**2/2 + m_l*((x_dot + l_dot*sin(theta) + l*theta_dot*cos(theta))**2
  + (l_dot*cos(theta) - l*theta_dot*sin(theta))**2)/2
inputs:
  F: {unit: N, acts_on: {x: 1}}
  S: {unit: N, acts_on: {l: 1}}
SWING
outputs: [inverse_dynamics, inverse_dynamics_residual]
"""
SWING = "  tau: {unit: N*m, acts_on: {theta: 1}}"
NOTICE = "the inputs span 2 of 3 directions"


@pytest.mark.parametrize("short", [True, False], ids=["two inputs", "three inputs"])
def test_inputs_that_do_not_span(tmp_path: Path, capsys: pytest.CaptureFixture[str], short: bool) -> None:
    path = tmp_path / "crane.yaml"
    path.write_text(CRANE.replace("SWING\n", "" if short else SWING + "\n"))
    assert cli.main([str(path), "--only", "c,python", "--no-verify", "--out", str(tmp_path)]) == 0
    assert (f"notice: inverse_dynamics: {NOTICE}" in capsys.readouterr().err) == short
    for written in ("c/crane.h", "python/crane.py"):
        assert (NOTICE in " ".join((tmp_path / "crane" / written).read_text().split())) == short
