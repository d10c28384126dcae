"""Witness: MuJoCo reads the same MJCF files; mass matrices, forces and the rows of equalities agree."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from mjcf_files import COUPLED, FOUR_BAR, RADIANS, TIED, TREE, load
from mujoco_witness import Witness, check_rows, check_tree
from mujoco_witness import mujoco as mujoco_module

WITHIN = 1e-13

TREES = {"tree": TREE, "radians": RADIANS, "four_bar": FOUR_BAR, "tied": TIED.format(equality="")}


@pytest.mark.parametrize("text", TREES.values(), ids=TREES)
def test_mass_matrices_and_forces(text: str, tmp_path: Path) -> None:
    check_tree(load(tmp_path, text), Witness(text), WITHIN)


def test_a_pin_in_the_plane(tmp_path: Path) -> None:
    model = load(tmp_path, FOUR_BAR)
    assert [row.name for row in model.constraints] == ["pin_x", "pin_z"]
    assert dict(model.configuration)["a"] == pytest.approx(0.2)
    check_rows(model, Witness(FOUR_BAR), WITHIN)
    assert model.inputs[0].name == "drive"


@pytest.mark.parametrize(
    "equality",
    [
        '<connect body1="left" body2="ball" anchor="0.4 0.1 0"/>',
        '<connect body1="ball" anchor="0.1 0.3 -0.2"/>',
        '<weld body1="left" body2="right"/>',
        '<weld body1="hand" body2="ball" anchor="0.1 0 0"/><connect body1="left" body2="ball" anchor="0.1 0.1 0"/>',
    ],
)
def test_rows_where_the_machine_begins(equality: str, tmp_path: Path) -> None:
    text = TIED.format(equality=equality)
    check_rows(load(tmp_path, text), Witness(text), WITHIN)


@pytest.mark.parametrize("equality", ['<connect body1="left" body2="ball" anchor="0.4 0.1 0"/>',
                                      '<weld body1="hand" body2="ball"/>'])  # fmt: skip
def test_rows_where_loops_have_moved(equality: str, tmp_path: Path) -> None:
    """Other configurations with closed loops, which Newton's method finds by MuJoCo's rows."""
    text = TIED.format(equality=equality)
    model, witness = load(tmp_path, text), Witness(text)
    for seed in range(3):
        q = np.array(witness.model.qpos0)
        _, v, _ = witness.state(seed)
        mujoco_module.mj_integratePos(witness.model, q, v, 0.3)
        for _ in range(30):
            residual, rows = witness.rows(q)
            mujoco_module.mj_integratePos(witness.model, q, -np.linalg.pinv(rows) @ residual, 1.0)
        check_rows(model, witness, 1e-9, q)


def test_sites_that_meet(tmp_path: Path) -> None:
    text = TIED.format(equality='<connect site1="s" site2="t"/>').replace(
        '<geom size="0.07" pos="0.1 0 0"/>', '<geom size="0.07" pos="0.1 0 0"/><site name="t" pos="0.2 0 0"/>'
    )
    model, witness = load(tmp_path, text), Witness(text)
    q = np.array(witness.model.qpos0)
    for _ in range(50):
        residual, rows = witness.rows(q)
        mujoco_module.mj_integratePos(witness.model, q, -np.linalg.pinv(rows) @ residual, 1.0)
    check_rows(model, witness, 1e-9, q)


def test_couplings(tmp_path: Path) -> None:
    model, witness = load(tmp_path, COUPLED), Witness(COUPLED)
    assert [row.name for row in model.constraints] == ["a_coupling", "c_coupling"]
    for b in (-0.7, 0.1, 0.6):
        p = b - np.radians(-20)
        a = np.radians(10) + 0.1 - 2.5 * p
        c = 0.1 + 0.05 + 0.2 * p + 0.3 * p**2 - 0.1 * p**3 + 0.4 * p**4
        check_rows(model, witness, WITHIN, np.array([a, b, c]))
