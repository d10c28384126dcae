"""Many coordinates under few rows: what takes least in the reference gives what the definition gives."""

from __future__ import annotations

import random

import numpy as np
import pytest
from flint import arb, arb_mat

from symgen.model.load import load_text
from symgen.verify.lanes import ranks_in_lanes
from symgen.verify.lanes.ranks_in_lanes import RankedPart, is_regular
from symgen.verify.reference import recorded_model
from symgen.verify.reference.arithmetic.adjoints import shorter_gradients
from symgen.verify.reference.arithmetic.linear import (
    determinant,
    identity,
    independent_rows,
    norm,
    pseudoinverse,
    right_pseudoinverse,
)
from symgen.verify.reference.arithmetic.tape import FUNCTIONS, Tape, precision, replay_of
from symgen.verify.reference.configurations.manifold import ManifoldRanks
from symgen.verify.reference.configurations.parts import Part
from symgen.verify.reference.inputs.driven import Driven, blocks_of_inputs
from symgen.verify.reference.reference import Reference, State
from symgen.verify.reference.system import ReferenceSystem
from symgen.verify.reference.translation import literal_values


def chain(links: int) -> str:
    """A chain whose end is pinned to the ground, with a drive at every other joint."""
    lines = ["model: necklace", "gravity: [0, -9.81, 0]", "joints:"]
    for k in range(links):
        parent = f", parent: j{k - 1}, at: [0.3, 0, 0]" if k else ""
        lines.append(f"  j{k}: {{type: revolute, axis: z, coordinate: a{k}{parent}}}")
    lines += ["frames:", f"  end: {{parent: j{links - 1}, translation: [0.3, 0, 0]}}", "bodies:"]
    lines += [f"  j{k}: {{mass: 1, com: [0.15, 0, 0], inertia: {{zz: 0.01}}}}" for k in range(links)]
    lines += ["constraints:", "  geometric: {across: end.x - 0.7, up: end.y}", "inputs:"]
    lines += [f"  u{k}: {{joint: a{k}}}" for k in range(0, links, 2)]
    lines += ["configuration: {" + ", ".join(f"a{k}: {1.2 if k == 0 else -0.5}" for k in range(links)) + "}"]
    return "\n".join([*lines, "outputs: [inverse_dynamics]", ""])


def drawn(dice: random.Random, rows: int, columns: int) -> arb_mat:
    return arb_mat(rows, columns, [dice.uniform(-1, 1) for _ in range(rows * columns)])


def with_blocks(rows: arb_mat, control: arb_mat) -> Driven:
    n, m = control.nrows(), control.ncols()
    acted_on = [[i for i in range(n) if control[i, j] != 0] for j in range(m)]
    return Driven(rows, control, blocks_of_inputs(Part(tuple(range(n)), inputs=tuple(range(m))), acted_on))


@pytest.mark.parametrize("linked", [False, True], ids=["inputs apart", "inputs of common coordinates"])
def test_u_by_the_rows_is_u_by_the_pseudoinverse(linked: bool) -> None:
    dice = random.Random(f"u {linked}")
    rows, control, load = drawn(dice, 2, 9), arb_mat(9, 6), drawn(dice, 9, 1)
    for j in range(6):
        control[j, j] = dice.uniform(1, 2)
        if linked and j % 2:
            control[j - 1, j] = dice.uniform(1, 2)
    with precision(256):
        projector = identity(9) - right_pseudoinverse(rows, 2) * rows
        projected = projector * control
        own = with_blocks(rows, control)
        assert len([block for block in own.blocks if block.inputs]) == (3 if linked else 6)
        apart = own.inputs(load) - pseudoinverse(projected, 6) * (projector * load)
        assert all(abs(float(x)) < 1e-60 for x in apart.entries())
        share = determinant(projected.transpose() * projected) / determinant(control.transpose() * control)
        assert abs(float(own.share() - share)) < 1e-60


def test_inputs_that_act_alike_are_told() -> None:
    rows, control = arb_mat(1, 4, [1, 1, 1, 1]), arb_mat(4, 2, [1, 2, 0, 0, 0, 0, 1, 2])
    own = with_blocks(rows, control)
    with pytest.raises(ZeroDivisionError):
        own.inputs(arb_mat(4, 1, [1, 2, 3, 4]))


def test_gradients_backwards_are_those_of_taylor_polynomials(monkeypatch: pytest.MonkeyPatch) -> None:
    model = load_text(chain(20), "necklace.yaml")
    backwards = ReferenceSystem(model)
    monkeypatch.setattr(recorded_model, "shorter_gradients", lambda *_: None)
    forwards = ReferenceSystem(model)
    assert 3 * backwards.geometry_replay.operations < forwards.geometry_replay.operations
    with precision(200):
        q = [arb(k) / 7 for k in range(20)]
        literals = literal_values(forwards.literals)
        residuals, rows = backwards.geometry(q, (), literals)
        also, expected = forwards.geometry(q, (), literals)
        assert all(x == 0 or abs(float(x)) < 1e-50 for x in (residuals - also).entries())
        assert all(abs(float(x)) < 1e-50 for x in (rows - expected).entries())


@pytest.mark.parametrize("name", [name for name in FUNCTIONS if name not in ("div", "pow", "atan2", "sub", "neg")])
def test_every_function_has_its_derivative_backwards(name: str) -> None:
    """Against differences, of a quotient and a difference of it too."""
    tape = Tape()
    x, y = tape.input(0), tape.input(1)
    two = name in ("add", "mul")
    made = tape.binary(name, x, y) if two else tape.unary(name, x)
    result = tape.binary("sub", tape.binary("atan2", made, y), tape.unary("neg", tape.binary("div", y, made)))
    padding = [tape.unary("sin", tape.input(k)) for k in range(2, 90)]
    (gradient,) = shorter_gradients(tape, [result], padding, 2) or [[]]
    values, slopes = replay_of(tape, [result]), replay_of(tape, gradient)
    with precision(300):
        step, at = arb(2) ** -90, [arb("0.4"), arb("0.7")]
        for k, slope in enumerate(slopes.run(at)):
            ahead, behind = ([v + s * step * (k == j) for j, v in enumerate(at)] for s in (1, -1))
            difference = (values.run(ahead)[0] - values.run(behind)[0]) / (2 * step)
            assert abs(float(slope - difference)) < 1e-50


def test_pivots_that_floats_tell_are_told_by_floats() -> None:
    dice = random.Random("ranks")
    tall = drawn(dice, 9, 4)
    chosen = independent_rows(tall)
    assert chosen is not None
    assert len(chosen) == 4
    nearly = arb_mat(3, 3, [1, 0, 0, 0, 1, 0, 1, 1, arb(2) ** -50])
    assert independent_rows(nearly) == [0, 1, 2]
    assert independent_rows(arb_mat(3, 2, [1, 2, 2, 4, 3, 6])) is not None
    assert len(independent_rows(arb_mat(3, 2, [1, 2, 2, 4, 3, 6])) or []) == 1


def test_loads_by_the_power_of_bodies_are_those_by_their_jacobians(monkeypatch: pytest.MonkeyPatch) -> None:
    model = load_text(chain(24), "necklace.yaml")
    dice = random.Random("loads")
    q, qd, qdd, u = (tuple(dice.uniform(-1, 1) for _ in range(count)) for count in (24, 24, 24, 12))
    state = State(q, qd, qdd, u, ())
    evaluations = []
    for at_hand in (None, True):
        if at_hand:
            monkeypatch.setattr(ReferenceSystem, "has_jacobians_at_hand", at_hand)
        reference = Reference(model, ManifoldRanks(2, 2, 12))
        assert reference.system.has_jacobians_at_hand is bool(at_hand)
        with precision(256):
            at = reference.evaluation(state)
            evaluations.append((at.load, at.motion(at.rate)[0], at.mass_dot(at.rate)))
    for backwards, expected in zip(*evaluations, strict=True):
        assert norm(backwards - expected) <= 1e-60 * norm(expected)


@pytest.mark.parametrize("drives", [45, 58], ids=["fewer than directions", "as many as directions"])
def test_many_drives_under_few_rows_are_regular_where_a_decomposition_says_so(
    drives: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Along some of the rows drives reach nothing, or nearly so."""
    dice = np.random.default_rng(7)
    rows, control = dice.standard_normal((12, 2, 60)), np.zeros((12, 60, drives))
    control[:, np.arange(drives), np.arange(drives)] = 3.0
    rows[::3, :, 44:] *= 0.0
    rows[1::3, :, 44:] *= 1e-4
    part = RankedPart(range(60), range(2), range(drives), 2, drives)
    regular = is_regular(part, rows, control)
    monkeypatch.setattr(ranks_in_lanes, "MANY_INPUTS", 1000)
    assert (regular == is_regular(part, rows, control)).all()
    assert regular[2::3].all()
    assert not regular[::3].any()
    assert not regular[1::3].any()
