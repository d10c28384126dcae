"""Places behind corners: reached from solved neighbours, whatever the chunks and the blocks are."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
import pytest
from studied_arm import SHIPPED, plan_of, results_of, study_of

from symgen.study.asked.request import StudyAxis
from symgen.study.chunks import chunk_values
from symgen.study.neighbours.lattice import NodeLattice, node_lattice
from symgen.study.plan import VariedName

pytestmark = pytest.mark.toolchain
# Links of 1 and 0.4 m: the tip has a ring around the base, 0.6 to 1.4 m away, and no way across its middle.
RING = """model: ring
coordinates: {a: {}, b: {}}
parameters:
  l: {value: 0.4, range: [0.1, 0.8]}
  m: {value: 1, range: [0.5, 2]}
kinetic_energy: m*(a_dot**2 + b_dot**2)
inputs: {u: {acts_on: {a: 1}}, v: {acts_on: {b: 1}}}
task: {x: cos(a) + l*cos(a + b), y: sin(a) + l*sin(a + b)}
measured: [a, b]
configuration: {a: -0.4, b: 1.4}
"""


@cache
def ring() -> Path:
    path = Path(mkdtemp(prefix="symgen-test-")) / "ring.yaml"
    path.write_text(RING, encoding="utf-8")
    return path


def distances(*axes: np.ndarray) -> np.ndarray:
    return np.hypot(*np.meshgrid(*axes, indexing="ij"))


@pytest.mark.parametrize("sides", [(15, 15), (29, 8)])
def test_what_lies_behind_the_middle_is_reached_around_it(sides: tuple[int, int], tmp_path: Path) -> None:
    plan = plan_of([f"x=-1.5:1.5:{sides[0]}", f"y=-1.5:1.5:{sides[1]}"], "reach", ring())
    reach = results_of(tmp_path / "partial", plan).reach.values
    away = distances(*(np.linspace(-1.5, 1.5, side) for side in sides))
    assert (reach[(away > 0.62) & (away < 1.38)] == 1).all()
    assert (reach[(away < 0.6) | (away > 1.4)] == 0).all()


def test_samples_are_reached_from_the_nodes_around_them(tmp_path: Path) -> None:
    plan = plan_of(["x=-1.5:1.5", "y=-1.5:1.5"], "reach", ring(), sample="sobol", count=512)
    results = results_of(tmp_path / "partial", plan)
    away = np.hypot(results.x.values, results.y.values)
    assert (results.reach.values[(away > 0.65) & (away < 1.35)] == 1).all()
    assert (results.reach.values[(away < 0.6) | (away > 1.4)] == 0).all()


def test_the_elbow_stays_bent_to_the_side_it_starts_on(tmp_path: Path) -> None:
    work = study_of(tmp_path / "partial", plan_of(["x=-1.5:1.5:16", "y=-1.5:1.5:16"], "reach", ring()))
    block = work.states.of(chunk_values(work.plan, work.chunks, 0))
    q = block.parts["q"][:, :, 0]
    reached = block.placed[:, 0] == 0
    assert (np.sin(q[reached, 1]) > 0).all()
    tip = np.cos(q[:, 0]) + 0.4 * np.cos(q.sum(axis=1)), np.sin(q[:, 0]) + 0.4 * np.sin(q.sum(axis=1))
    given = chunk_values(work.plan, work.chunks, 0)[reached]
    assert np.allclose(np.stack(tip, axis=-1)[reached], given, atol=1e-9)


def test_no_way_passes_a_place_where_a_leg_is_stretched(tmp_path: Path) -> None:
    """Of the shipped five-bar: legs that bend to the other side would belong to another assembly mode."""
    plan = plan_of(["x=-0.5:0.5:41", "y=-0.5:0.5:41"], "reach", SHIPPED / "five_bar.yaml")
    work = study_of(tmp_path / "partial", plan)
    elbows = [k for k, c in enumerate(plan.model.coordinates) if c.name.endswith("_elbow")]
    block = work.states.of(chunk_values(work.plan, work.chunks, 0))
    q = block.parts["q"][block.placed[:, 0] == 0, :, 0]
    assert len(elbows) == 2
    assert len(q) > 500
    assert (np.ptp(np.sign(np.sin(q[:, elbows])), axis=0) == 0).all()


@pytest.mark.parametrize("show", ["reach", "modes", "regular"])
def test_a_place_has_the_same_bits_in_any_block(show: str, tmp_path: Path) -> None:
    plan = plan_of(["x=-1.5:1.5:21", "y=-1.5:1.5:21"], show, ring())
    whole, parts = (study_of(tmp_path / name, plan) for name in ("whole", "parts"))
    values = chunk_values(plan, whole.chunks, 0)
    together = whole.states.of(values)
    for points in (np.arange(400, 441), np.arange(3), np.array([220])):
        alone = parts.states.of(values[points])
        assert alone.parts["q"].tobytes() == together.parts["q"][points].tobytes()
        assert (alone.placed == together.placed[points]).all()
        for one, all_of_them in ((alone.assembled, together.assembled), (alone.regular, together.regular)):
            assert (one is None) == (all_of_them is None)
            if one is not None and all_of_them is not None:
                assert (one == all_of_them[points]).all()


def test_states_along_ranges_are_reached_too(tmp_path: Path) -> None:
    plan = plan_of(["l=0.35:0.4:2"], "reach", ring(), along=("x=-1:-0.8:3", "y=-0.3:0.3:3"))
    assert (results_of(tmp_path / "partial", plan).reach_min.values == 1).all()


def test_values_of_a_grid_are_values_of_its_nodes() -> None:
    plan = plan_of(["x=-1.5:1.5:21", "m=1:2:9", "y=-1:1:41", "l=0.3:0.3:1"], "reach", ring())
    lattice = node_lattice(plan)
    assert lattice is not None
    # the mass does not move anything, and the length is one value
    assert [one.axis.name for one in lattice.names] == ["x", "y"]
    assert lattice.counts == (181, 161)
    assert set(np.round(np.linspace(-1, 1, 41), 12)) <= set(np.round(lattice.values[:, 1], 12))


def test_without_names_that_move_anything_there_are_no_nodes() -> None:
    assert node_lattice(plan_of(["m=1:2:9"], "reach", ring())) is None


def lattice_of(*counts: int) -> NodeLattice:
    names = (VariedName(StudyAxis(f"n{k}", 0.0, 1.0, None), "task", k, "") for k in range(len(counts)))
    return NodeLattice(tuple(names), counts)


def test_each_node_is_beside_those_that_differ_by_a_step() -> None:
    lattice = lattice_of(3, 1, 4)
    pairs = [(int(a), int(b)) for one, two in lattice.beside(np.arange(12)) for a, b in zip(one, two, strict=True)]
    steps = [np.abs(np.subtract(*(np.unravel_index(k, lattice.counts) for k in pair))) for pair in pairs]
    assert all(sorted(step) == [0, 0, 1] for step in steps)
    assert len(set(pairs)) == len(pairs) == 2 * (2 * 4 + 3 * 3)


def test_corners_of_a_cell_are_each_named_once() -> None:
    lattice = lattice_of(3, 5)
    made: dict[int, list[int]] = {0: [], 1: [], 2: []}
    for points, nodes in lattice.corners(np.array([[0.2, 0.3], [0.5, 0.3], [1.0, 1.0]])):
        for point, node in zip(points, nodes, strict=True):
            made[int(point)].append(int(node))
    assert made[0][0] == 1
    assert sorted(made[0]) == [1, 2, 6, 7]
    # on a line between two of them, and on one
    assert made[1] == [6, 7]
    assert made[2] == [14]
    assert math.prod(lattice.counts) == len(lattice)
