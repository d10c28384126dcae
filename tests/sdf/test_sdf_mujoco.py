"""Witness: MuJoCo reads the same machines from places in the world; poses, axes, trees and rows of loops agree."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from mujoco_witness import Witness, check_tree
from row_spaces import projector
from sdf_files import Part, joint, link, load, mjcf, placed, robot, rows

from symgen.mechanics.system import System
from symgen.symbolic.evaluate import Evaluator

WITHIN = 1e-13

CHAIN = robot(
    '<pose>0 0 0.5 0 0 0.2</pose>\n<frame name="mark"><pose>0.1 0 0 0.4 0 0</pose></frame>\n',
    '<frame name="on_a" attached_to="a"><pose degrees="true">0 0.1 0 30 0 60</pose></frame>\n',
    link("a", "<pose>0.1 0.2 0.3 0.1 0.2 0.3</pose>"),
    link("b", '<pose relative_to="on_a">0.5 0.1 0.4 -0.3 0.5 1</pose>'),
    link("c", '<pose relative_to="b" rotation_format="quat_xyzw">0.2 0.6 0.1 0.1 0.2 0.3 0.9</pose>'),
    link("d", '<pose relative_to="mark">0.3 0.3 0.9 1.2 -0.4 0.2</pose>'),
    joint("first", "revolute", "world", "a", "0 0.6 0.8", "<pose>0.05 0 0.1 0.3 0 0</pose>"),
    joint("cross", "universal", "on_a", "b", "1 0 0", "<axis2><xyz>0 1 0</xyz></axis2>"),
    # written from the far link to the near one
    '<joint name="slide" type="prismatic"><parent>c</parent><child>b</child>'
    '<axis><xyz expressed_in="mark">0 3 4</xyz><dynamics><damping>0.4</damping><spring_stiffness>5</spring_stiffness>'
    "<spring_reference>0.1</spring_reference></dynamics></axis></joint>\n",
    joint("ball", "ball", "c", "d", ""),
)


def chain_for_mujoco() -> str:
    base = placed((0, 0, 0.5, 0, 0, 0.2))
    a = base @ placed((0.1, 0.2, 0.3, 0.1, 0.2, 0.3))
    b = a @ placed((0, 0.1, 0, np.pi / 6, 0, np.pi / 3)) @ placed((0.5, 0.1, 0.4, -0.3, 0.5, 1))
    x, y, z, w = np.array([0.1, 0.2, 0.3, 0.9]) / np.linalg.norm([0.1, 0.2, 0.3, 0.9])
    turned = np.eye(4)
    turned[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    turned[:3, 3] = 0.2, 0.6, 0.1
    c = b @ turned
    mark = base @ placed((0.1, 0, 0, 0.4, 0, 0))
    d = mark @ placed((0.3, 0.3, 0.9, 1.2, -0.4, 0.2))
    first = a @ placed((0.05, 0, 0.1, 0.3, 0, 0))
    return mjcf(
        [
            Part("a", a, "world", (("first", "hinge", first[:3, 3], first[:3, :3] @ [0, 0.6, 0.8], ""),)),
            Part("b", b, "a", (("one", "hinge", b[:3, 3], b[:3, 0], ""), ("two", "hinge", b[:3, 3], b[:3, 1], ""))),
            Part("c", c, "b", (
                ("slide", "slide", b[:3, 3], mark[:3, :3] @ [0, -3, -4], 'damping="0.4" stiffness="5" springref="0.1"'),
            )),
            Part("d", d, "c", (("ball", "ball", d[:3, 3], d[:3, 0], ""),)),
        ]
    )  # fmt: skip


def test_poses_axes_and_joints_read_backwards(tmp_path: Path) -> None:
    model = load(tmp_path, CHAIN)
    assert [c.name for c in model.coordinates][:4] == ["first", "cross_1", "cross_2", "slide"]
    check_tree(model, Witness(chain_for_mujoco()), WITHIN)


LOOP = robot(
    link("a", "<pose>0.1 0.2 0.3 0.1 0.2 0.3</pose>"),
    link("b", "<pose>0.5 0.1 0.4 -0.3 0.5 1</pose>"),
    link("c", "<pose>0.2 0.6 0.1 0.2 0 -0.7</pose>"),
    joint("one", "revolute", "world", "a", "0 0 1"),
    joint("two", "ball", "a", "b", ""),
    joint("three", "ball", "world", "c", ""),
    joint("last", "{kind}", "b", "c", "{axis}", "<pose>0.1 0 0 0.2 0.1 0</pose>"),
)
# of the velocity of c against b, in the axes of the joint: rows of (w, v) that vanish
HELD = {
    "fixed": np.eye(6),
    "ball": np.eye(6)[3:],
    "prismatic": np.eye(6)[[0, 1, 2, 3, 4]],
    "revolute": np.eye(6)[[0, 1, 3, 4, 5]],
}


@pytest.mark.parametrize("kind", HELD)
def test_rows_of_loops(kind: str, tmp_path: Path) -> None:
    """The rows where the file has the machine, against the velocities of both links by MuJoCo."""
    model = load(tmp_path, LOOP.format(kind=kind, axis="" if kind in ("fixed", "ball") else "0 0 1"))
    a, b, c = (placed(p) for p in (
        (0.1, 0.2, 0.3, 0.1, 0.2, 0.3), (0.5, 0.1, 0.4, -0.3, 0.5, 1), (0.2, 0.6, 0.1, 0.2, 0, -0.7)
    ))  # fmt: skip
    at = c @ placed((0.1, 0, 0, 0.2, 0.1, 0))
    witness = Witness(mjcf([
        Part("a", a, "world", (("one", "hinge", a[:3, 3], a[:3, 2], ""),)),
        Part("b", b, "a", (("two", "ball", b[:3, 3], b[:3, 0], ""),)),
        Part("c", c, "world", (("three", "ball", c[:3, 3], c[:3, 0], ""),)),
    ]))  # fmt: skip
    q = np.array(witness.model.qpos0)
    _, _, matrix = witness.rates(q, *np.zeros((2, witness.model.nv)))
    state = dict(zip((c.name for c in model.coordinates), map(float, q), strict=True))
    mine = rows(model, state)
    norms = [row.name.endswith("_norm") for row in model.constraints]
    relative = witness.velocities("c", at[:3, 3]) - witness.velocities("b", at[:3, 3])
    turned = np.kron(np.eye(2), at[:3, :3].T)
    theirs = HELD[kind] @ turned @ relative
    assert np.abs(Evaluator(list(System(model).constraint_residual))(state)).max() < WITHIN
    assert np.abs(projector(mine[~np.array(norms)] @ matrix) - projector(theirs)).max() < WITHIN
