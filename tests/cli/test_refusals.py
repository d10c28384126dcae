"""Models that are refused only once they are derived and verified: with a place where there is one, and a remedy."""

from __future__ import annotations

from pathlib import Path

import pytest

from symgen.cli import main

MODEL = """model: steep
coordinates: {x: {}, y: {}, z: {}}
parameters: {m: {value: 2}}
kinetic_energy: m/2*(x_dot**2 + y_dot**2 + z_dot**2)
potential_energy: FIELD
constraints:
  geometric:
    row: ROW
inputs:
  u: {acts_on: {x: 1}}
  v: {acts_on: {z: 1}}
outputs: OUTPUTS
"""


def _told(tmp_path: Path, capsys: pytest.CaptureFixture[str], **parts: str) -> str:
    text = MODEL
    for key, value in parts.items():
        text = text.replace(key, value)
    path = tmp_path / "steep.yaml"
    path.write_text(text, encoding="utf-8")
    assert main([str(path), "--out", str(tmp_path / "out"), "--only", "c,python"]) == 1
    assert not (tmp_path / "out" / "steep").exists()
    return capsys.readouterr().err


def test_where_no_states_are_found_the_row_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """exp(exp(exp(exp(x)))) leaves room for one configuration in 1e6."""
    told = _told(tmp_path, capsys, FIELD="0", ROW="exp(exp(exp(exp(3*x)))) - y", OUTPUTS="inverse_dynamics")
    assert "steep.yaml:8:10: " in told
    assert "remedy: give a start under `configuration`" in told
    assert "internal error" not in told


def test_a_number_beyond_float32_is_told_with_a_way_out(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """1e30 * 1e20 x is 1e50 in the kernel."""
    told = _told(tmp_path, capsys, FIELD="1e30*sin(1e20*x)", ROW="x - y", OUTPUTS="potential_force")
    assert "a number of about 1e50, which is beyond the range of float32" in told
    assert "`--scalar float64`" in told


def test_rows_that_hold_nothing_press_on_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Multipliers of a model none of whose rows counts are zeros."""
    path = tmp_path / "free.yaml"
    path.write_text(
        MODEL.replace("FIELD", "0").replace("ROW", "x - y - x + y").replace("OUTPUTS", "[multipliers]"), "utf-8"
    )
    assert main([str(path), "--out", str(tmp_path / "out"), "--only", "python"]) == 0
    assert "`row` is zero for all configurations" in capsys.readouterr().err
