"""Machines that follow a path side by side move as each of them alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from symgen.mechanics.genericity import parameter_values
from symgen.mechanics.system import System
from symgen.model.load import load_model
from symgen.paths.path_equations import PathError, path_equations
from symgen.paths.path_family import PathFamily
from symgen.paths.trajectory import solve_path

MODELS = Path(__file__).parents[2] / "models"
LENGTHS = (0.05, 0.17, 0.2, 0.24)


def family(name: str, path: str, varied: str, values: tuple[float, ...]):  # type: ignore[no-untyped-def]
    model = load_model(MODELS / name)
    (chosen,) = (one for one in model.paths if one.name == path)
    equations = path_equations(model, chosen)
    known = parameter_values(System(model))
    p = np.array([[{**known, varied: value}[one.name] for one in model.parameters] for value in values])
    return model, chosen, equations, PathFamily(model, chosen, equations), p


def test_each_machine_moves_as_alone() -> None:
    model, path, equations, together, p = family("rapkm_2rrr_rr.yaml", "circle", "l_1", LENGTHS)
    lost, *motions = together.solved(p)
    assert lost is None
    with pytest.raises(PathError):
        solve_path(model, path, equations.of(p[0].tolist()))
    for one, motion in zip(p[1:], motions, strict=True):
        alone = solve_path(model, path, equations.of(one.tolist()))
        assert np.abs(motion.q - alone.q).max() < 1e-13
        assert np.abs(motion.qd - alone.qd).max() < 1e-11
        assert np.abs(motion.qdd - alone.qdd).max() < 1e-9


def test_others_beside_a_machine_do_not_change_a_bit() -> None:
    *_, together, p = family("rapkm_2rrr_rr.yaml", "circle", "l_1", LENGTHS)
    motions = together.solved(p)
    for k in (1, 3):
        (alone,) = together.solved(p[[k]])
        assert all((getattr(alone, name) == getattr(motions[k], name)).all() for name in ("q", "qd", "qdd"))


def test_a_step_that_is_too_long_is_taken_as_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    *_, together, p = family("rapkm_2rrr_rr.yaml", "circle", "l_1", LENGTHS[2:])
    expected = together.solved(p)
    monkeypatch.setattr("symgen.paths.path_family.CHORD_STEPS", 1)
    fallen_back = together.solved(p)
    for one, other in zip(expected, fallen_back, strict=True):
        assert np.abs(one.q - other.q).max() < 1e-13


def test_the_parameters_that_a_path_depends_on() -> None:
    model, _, equations, *_ = family("rapkm_2rrr_rr.yaml", "circle", "l_1", LENGTHS)
    used = {model.parameters[k].name for k in equations.parameters_used}
    assert used == {"l_1", "l_2", "x_1", "x_2", "x_3", "y_1", "y_2", "y_3"}
