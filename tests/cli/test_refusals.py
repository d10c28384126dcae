"""Models that are refused only once they are derived and verified: with a place where there is one, and a remedy."""

from __future__ import annotations

from pathlib import Path

import pytest

from symgen.cli.main import main
from symgen.verify.sampling.states import VerificationError

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


def _refusal(tmp_path: Path, capsys: pytest.CaptureFixture[str], **parts: str) -> str:
    text = MODEL
    for key, value in parts.items():
        text = text.replace(key, value)
    path = tmp_path / "steep.yaml"
    path.write_text(text, encoding="utf-8")
    assert main([str(path), "--out", str(tmp_path / "out"), "--only", "c,python"]) == 1
    assert not (tmp_path / "out" / "steep").exists()
    return capsys.readouterr().err


def test_where_no_states_are_found_the_row_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Loading found a configuration, and verification finds no others."""

    def none(*_: object, **__: object) -> None:
        raise VerificationError("steep: only 0 regular configurations were found; give a start")

    monkeypatch.setattr("symgen.verify.expected.sample_states", none)
    errors = _refusal(tmp_path, capsys, FIELD="0", ROW="x**2 - y", OUTPUTS="inverse_dynamics")
    assert "steep.yaml:8:10: only 0 regular configurations were found\n" in errors
    assert "remedy: give a start\n" in errors


@pytest.mark.campaign
def test_states_are_found_where_functions_are_steep(tmp_path: Path) -> None:
    """exp(exp(exp(exp(3 x)))) leaves room for one configuration in 1e6."""
    path = tmp_path / "steep.yaml"
    row = "exp(exp(exp(exp(3*x)))) - y"
    path.write_text(MODEL.replace("FIELD", "0").replace("ROW", row).replace("OUTPUTS", "inverse_dynamics"), "utf-8")
    assert main([str(path), "--out", str(tmp_path / "out"), "--only", "python"]) == 0


def test_a_number_beyond_float32_is_told_with_a_way_out(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """1e30 * 1e20 x is 1e50 in the kernel."""
    errors = _refusal(tmp_path, capsys, FIELD="1e30*sin(1e20*x)", ROW="x - y", OUTPUTS="potential_force")
    assert "a number of about 1e50, which is beyond the range of float32" in errors
    assert "`--scalar float64`" in errors


@pytest.mark.campaign
def test_rows_that_hold_nothing_press_on_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Multipliers of a model none of whose rows counts are zeros."""
    path = tmp_path / "free.yaml"
    path.write_text(
        MODEL.replace("FIELD", "0").replace("ROW", "x - y - x + y").replace("OUTPUTS", "[multipliers]"), "utf-8"
    )
    assert main([str(path), "--out", str(tmp_path / "out"), "--only", "python"]) == 0
    assert "`row` is zero for all configurations" in capsys.readouterr().err


def test_a_misspelt_option_is_answered_with_the_one_that_was_meant(capsys: pytest.CaptureFixture[str]) -> None:
    """Options are wanted in full, so that a beginning of one is a slip, too."""
    with pytest.raises(SystemExit) as caught:
        main(["model.yaml", "--output", "all", "--scaler=float64", "--xyz"])
    assert caught.value.code == 2
    said = capsys.readouterr().err
    assert "did you mean `--outputs` for `--output`?" in said
    assert "did you mean `--scalar` for `--scaler`?" in said
    assert "`--xyz`" not in said
