"""States nearer to a drop of rank than coordinates are to their own rounding elsewhere: beside one at 0."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from symgen.generation.draft import Draft, draft_of
from symgen.generation.results import Options
from symgen.ir.kernel import Block, Check, Kernel, Literal, Load, Local, Statement, Status
from symgen.ir.raised import Raised, with_raised_thresholds
from symgen.laboratory.zoo.witness.witness import Witness
from symgen.model.load import load_text
from symgen.pipeline import generate
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.margins import next_to_singular
from symgen.verify.margins.next_to_singular import NextToSingular
from symgen.verify.reference.reference import State
from symgen.verify.sampling.nearby import Surroundings
from symgen.verify.sampling.states import in_scalar
from symgen.verify.tolerance import FACTOR, expectations

# Two legs that fold in planes at right angles carry a table straight up: flat, at 0, two directions are lost at once.
LIFT = """\
model: lift
parameters: {l: {value: 0.23}, d: {value: 0.44}}
gravity: [0, 0, -9.81]
frames:
  end: {parent: knee_1, translation: [0, 0, l]}
  dock: {parent: table, translation: ["-d", d, 0]}
joints:
  foot_0: {type: revolute, axis: x, at: [0, "-d", 0], coordinate: p_0}
  knee_0: {type: revolute, axis: x, parent: foot_0, at: [0, 0, l], coordinate: k_0}
  table: {type: revolute, axis: x, parent: knee_0, at: [0, 0, l], coordinate: e}
  foot_1: {type: revolute, axis: y, at: ["-d", 0, 0], coordinate: p_1}
  knee_1: {type: revolute, axis: y, parent: foot_1, at: [0, 0, l], coordinate: k_1}
bodies:
  foot_0: {mass: 0.58, com: [0, 0, l/2], inertia: {xx: 0.02, yy: 0.02, zz: 0.003}}
  knee_0: {mass: 5.1, com: [0, 0, l/2], inertia: {xx: 0.02, yy: 0.02, zz: 0.003}}
  table: {mass: 3, com: [0, d, 0], inertia: {xx: 0.2, yy: 0.2, zz: 0.3}}
  foot_1: {mass: 4, com: [0, 0, l/2], inertia: {xx: 0.02, yy: 0.02, zz: 0.003}}
  knee_1: {mass: 1.4, com: [0, 0, l/2], inertia: {xx: 0.02, yy: 0.02, zz: 0.003}}
loops:
  hinge: {type: revolute, between: [end, dock], axis: y}
inputs:
  lift: {joint: k_0}
configuration: {p_0: 0.49, k_0: -0.98, e: 0.49, p_1: 0.49, k_1: -0.98}
"""
# Three cranks and two bars, which lie in a line at 0: minors of rows are products of four sines there.
CRANKS = """\
model: cranks
parameters: {l: {value: 0.16}, d: {value: 0.25}, m: {value: 4.3}}
gravity: [0, -9.81, 0]
joints:
  crank_0: {type: revolute, axis: z, at: [0, 0, 0], coordinate: a_0}
  crank_1: {type: revolute, axis: z, at: [d, 0, 0], coordinate: a_1}
  crank_2: {type: revolute, axis: z, at: [2*d, 0, 0], coordinate: a_2}
  bar_0: {type: revolute, axis: z, parent: crank_0, at: [l, 0, 0], coordinate: b_0}
  bar_1: {type: revolute, axis: z, parent: crank_1, at: [l, 0, 0], coordinate: b_1}
bodies:
  crank_0: {mass: m, com: [l/2, 0, 0], inertia: {zz: 0.02}}
  crank_1: {mass: m, com: [l/2, 0, 0], inertia: {zz: 0.02}}
  crank_2: {mass: m, com: [l/2, 0, 0], inertia: {zz: 0.02}}
  bar_0: {mass: m, com: [d/2, 0, 0], inertia: {zz: 0.05}}
  bar_1: {mass: m, com: [d/2, 0, 0], inertia: {zz: 0.05}}
points:
  tip_1: {frame: crank_1, at: [l, 0, 0]}
  end_0: {frame: bar_0, at: [d, 0, 0]}
  tip_2: {frame: crank_2, at: [l, 0, 0]}
  end_1: {frame: bar_1, at: [d, 0, 0]}
loops:
  pin_1: {type: point, between: [end_0, tip_1]}
  pin_2: {type: point, between: [end_1, tip_2]}
inputs: {u_1: {joint: a_1}, u_2: {joint: a_2}}
configuration: {a_0: -0.85, a_1: -0.85, a_2: -0.85, b_0: 0.85, b_1: 0.85}
"""
# Two links without inertia of their own carry a point mass: in a line, at 0, a motion of them moves nothing.
ARM = """\
model: arm
coordinates: {a_1: {unit: rad}, a_2: {unit: rad}, a_3: {unit: rad}}
parameters:
  l_1: {value: 1.1}
  l_2: {value: 0.25}
  l_3: {value: 0.41}
  m_2: {value: 2.6}
  m_3: {value: 4}
  J_3: {value: 0.38}
definitions:
  vx_2: -l_1*sin(a_1)*a_1_dot - l_2*sin(a_1 + a_2)*(a_1_dot + a_2_dot)
  vy_2: l_1*cos(a_1)*a_1_dot + l_2*cos(a_1 + a_2)*(a_1_dot + a_2_dot)
  rate: a_1_dot + a_2_dot + a_3_dot
  vx_3: vx_2 - l_3*sin(a_1 + a_2 + a_3)*rate
  vy_3: vy_2 + l_3*cos(a_1 + a_2 + a_3)*rate
kinetic_energy: m_2/2*(vx_2**2 + vy_2**2) + m_3/2*(vx_3**2 + vy_3**2) + J_3/2*rate**2
inputs: {u_1: {acts_on: {a_1: 1}}, u_2: {acts_on: {a_2: 1}}, u_3: {acts_on: {a_3: 1}}}
"""
# What is lost is lost twice, once it is refined: 1e-4 of it at 1e-12.
METHOD = {"forward_dynamics": "schur_qr_refined"}


@cache
def lift() -> tuple[Draft, Expected]:
    model = load_text(LIFT, "lift.yaml")
    expected = Expected(model, ["forward_dynamics"], 16, lambda _: None)
    expected.values("float64")
    return draft_of(model, ["forward_dynamics"], Options(methods=METHOD, scalars=("float64",))), expected


def drafted(text: str, name: str, method: str) -> tuple[Draft, Expected]:
    """One quantity by a method, and what both scalar types are to give."""
    model = load_text(text, "model.yaml")
    expected = Expected(model, [name], 16, lambda _: None)
    for scalar in ("float64", "float32"):
        expected.values(scalar)
    return draft_of(model, [name], Options(methods={name: method})), expected


def flat(share: float) -> State:
    """All but flat, and moving along."""
    pose, rate = (1.0, -2.0, 1.0, 1.0, -2.0), 0.25
    q, qd = (tuple(size * x for x in pose) for size in (share, rate))
    # what is left of the rates of a table on two legs that rise alike
    return State(q, (*qd[:4], qd[4] * (1 - 1e-5)), (0.0,) * 5, (3.0,), (0.23, 0.44), ())


def units(kernel: Kernel, state: State) -> float | Status:
    draft, expected = lift()
    (made,) = outcomes(kernel, draft.programs["float64"].sincos, "float64", [state])
    if not made.valid:
        return Status(made.status)
    known = expectations(expected.reference, state, [kernel.name], "float64", "flat")[kernel.name]
    return known.in_units(known.distance(made.entries))


@pytest.mark.campaign
def test_a_kernel_that_loses_digits_next_to_a_drop_has_a_status_there() -> None:
    """Further away, where the other states of a verification are, nothing changes."""
    draft, expected = lift()
    kernels = draft.kernels("forward_dynamics")
    thresholds = NextToSingular(expected).raised(kernels, draft.programs)
    raised = with_raised_thresholds(kernels["float64"], "float64", thresholds["float64"])
    before, after = ([units(one, flat(x)) for x in (1e-12, 1e-6, 1e-2)] for one in (kernels["float64"], raised))
    assert isinstance(before[0], float)
    assert before[0] > FACTOR
    assert after[0] is Status.CONSTRAINT_RANK
    assert after[1:] == before[1:]
    assert all(isinstance(one, float) and one < FACTOR for one in after[1:])


@pytest.mark.campaign
def test_where_no_threshold_refuses_what_is_lost_a_method_is_rejected(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, tool: Callable[[str], str]
) -> None:
    tool("cc")
    model = tmp_path / "lift.yaml"
    model.write_text(LIFT, encoding="utf-8")
    options = Options(parts=("c",), states=16, outputs=("forward_dynamics",), methods=METHOD, scalars=("float64",))
    assert generate(model, options, lambda _: None).left_out == ()
    monkeypatch.setattr(next_to_singular, "MOST_DECADES", 0)
    (left_out,) = generate(model, options, lambda _: None).left_out
    assert left_out.quantity == "forward_dynamics"
    assert "next to a singular state, which no threshold refuses" in left_out.tried[0][1]
    # another method holds there
    assert generate(model, replace(options, methods={}), lambda _: None).left_out == ()


@pytest.mark.campaign
def test_a_number_too_small_to_have_digits_is_a_status() -> None:
    """Beside what it is made of it is as large as ever: 1e-43 of float32, of which two bits are left."""
    name = "inverse_dynamics"
    draft, expected = drafted(CRANKS, name, "minor")
    kernels = draft.kernels(name)
    assert NextToSingular(expected).raised(kernels, draft.programs) == {"float32": Raised(ranks=0)}
    q, qd, qdd = (tuple(size * x for x in (1, 1, 1, -1, -1)) for size in (-3.7e-10, 1.0, 0.5))
    state = in_scalar(State(q, qd, qdd, (0.0, 0.0), (0.16, 0.25, 4.3), ()), "float32")
    known = expectations(expected.reference, state, [name], "float32", "small")[name]
    sines = draft.programs["float32"].sincos
    made, raised = (
        outcomes(kernel, sines, "float32", [state])[0]
        for kernel in (kernels["float32"], with_raised_thresholds(kernels["float32"], "float32", Raised(ranks=0)))
    )
    assert made.valid
    assert known.in_units(known.distance(made.entries)) > FACTOR
    assert raised.status in (Status.ACTUATION_RANK, Status.CONSTRAINT_RANK)


def test_configurations_around_0_are_met_where_no_direction_is_lost() -> None:
    """Rows that vanish keep their directions: nothing leads there, but all of V that is near 0 is looked at."""
    model = load_text(CRANKS, "cranks.yaml")
    expected = Expected(model, ["inverse_dynamics"], 16, lambda _: None)
    q = Surroundings(expected.reference, expected.drawn, expected.modes).around_zero(32).parts["q"]
    assert len(q) > 4
    assert 0 < np.abs(q).max() < 0.1
    # each crank stands like the first one, or its bar crosses
    assert np.abs(np.sin(q[:, 0]) - np.sin(q[:, 1]) + 0.25 / 0.16 * np.sin(q[:, 0] + q[:, 3])).max() < 1e-9


@pytest.mark.campaign
def test_pairs_of_float32_have_a_status_where_they_have_lost_all_digits() -> None:
    """Three inputs for one direction: what they do along it is as much as ever where the rows have none left of it."""
    name = "inverse_dynamics"
    text = LIFT.replace("lift: {joint: k_0}", "lift: {joint: k_0}\n  u_2: {joint: p_1}\n  u_3: {joint: k_1}")
    draft, expected = drafted(text, name, "householder")
    taken = draft.taken(name)
    kernels = draft.kernels_along(
        replace(taken, choice=replace(taken.choice, wide=("float32",))), ("float64", "float32")
    )
    thresholds = NextToSingular(expected).raised({"float32": kernels["float32"]}, draft.programs)
    raised = with_raised_thresholds(kernels["float32"], "float32", thresholds["float32"])

    def statuses(share: float) -> tuple[float, int]:
        state = replace(flat(share), u=(3.0, 0.0, 0.0))
        state = in_scalar(state, "float32")
        known = expectations(expected.reference, state, [name], "float32", "flat")[name]
        made, limited = (
            outcomes(one, draft.programs["float32"].sincos, "float32", [state])[0]
            for one in (kernels["float32"], raised)
        )
        assert made.valid
        return known.in_units(known.distance(made.entries)), limited.status

    units_there, status_there = statuses(1e-11)
    assert units_there > FACTOR
    assert status_there == Status.CONSTRAINT_RANK
    units_beside, status_beside = statuses(1e-3)
    assert units_beside < FACTOR
    assert status_beside == 0


@pytest.mark.campaign
def test_pairs_of_float32_have_a_status_where_a_direction_all_but_has_no_mass() -> None:
    """Further away they hold, and thresholds of rows, of which there are none, stay."""
    name = "forward_dynamics"
    draft, expected = drafted(ARM, name, "schur_qr")
    taken = draft.taken(name)
    wide = replace(taken, choice=replace(taken.choice, wide=("float64", "float32")))
    kernels = draft.kernels_along(wide, ("float64", "float32"))
    thresholds = NextToSingular(expected).raised(kernels, draft.programs)
    assert thresholds.keys() == {"float32"}
    assert thresholds["float32"].ranks is None
    raised = with_raised_thresholds(kernels["float32"], "float32", thresholds["float32"])

    def both(a_2: float) -> tuple[float, Status]:
        parameters = (1.1, 0.25, 0.41, 2.6, 4.0, 0.38)
        state = State((0.7, a_2, 0.9), (0.1, -0.2, 0.3), (0.0,) * 3, (1.0, -2.0, 0.5), parameters, ())
        state = in_scalar(state, "float32")
        known = expectations(expected.reference, state, [name], "float32", "in line")[name]
        made, limited = (
            outcomes(one, draft.programs["float32"].sincos, "float32", [state])[0]
            for one in (kernels["float32"], raised)
        )
        assert made.valid
        return known.in_units(known.distance(made.entries)), Status(limited.status)

    lost = [both(x * 10.0**-power) for power in range(1, 5) for x in (1, 2, 3, 5, 7)]
    assert max(units for units, _ in lost) > FACTOR
    assert all(units < FACTOR for units, status in lost if status is Status.OK)
    assert {status for _, status in lost} == {Status.OK, Status.MASS_RANK}


def test_kernels_with_twice_the_digits_of_float64_and_other_quantities_keep_their_thresholds() -> None:
    draft, expected = lift()
    (kernel,) = draft.kernels("forward_dynamics").values()
    taken = draft.taken("forward_dynamics")
    wide = replace(taken, choice=replace(taken.choice, wide=("float64",)))
    assert NextToSingular(expected).raised(draft.kernels_along(wide, ("float64",)), draft.programs) == {}
    other = replace(kernel, name="nullspace_projector")
    assert NextToSingular(expected).raised({"float64": other}, draft.programs) == {}


def test_the_unit_of_error_is_known_next_to_a_drop() -> None:
    """With too few digits what inputs do to a result would drown in what rounding does to the reference."""
    _, expected = lift()
    made = [
        expectations(expected.reference, flat(share), ["forward_dynamics"], "float64", "flat")["forward_dynamics"]
        for share in (1e-12, 1e-9)
    ]
    next_to, beside = (one.unit / one.size for one in made)
    assert next_to < 3 * beside < 1e-10


def test_thresholds_of_ranks_alone_are_raised() -> None:
    """Be they numbers or products, of causes too, which are looked at whether anything else is lost or not."""
    value, scale, number = Local("value"), Local("scale"), Literal(Fraction(1, 8))
    again = Statement(("twice",), "add", (value, value))
    cause = Block((again,), (Check(Status.CONSTRAINT_RANK, Local("twice"), scale),))
    checks = (
        Check(Status.ACTUATION_RANK, value, number, first=cause, apart=True),
        Check(Status.CONSTRAINT_RANK, value, scale),
        Check(Status.CONSTRAINT_RANK, number, scale),
        Check(Status.MASS_RANK, value, scale),
    )
    named = Block((Statement(("raised_1",), "mul", (value, number)),), ())
    blocks = (named, Block((), checks), Block((again,), ()))
    kernel = Kernel("k", (), (Load("value", "q", 0), Load("scale", "q", 1)), blocks, (value,), (1,))
    _, made, after = with_raised_thresholds(kernel, "float32", Raised(ranks=3)).blocks
    factor, least = Literal(Fraction(1000)), Literal(Fraction(1, 2**102))
    products = [Statement((name,), "mul", (scale, factor)) for name in ("raised_2", "raised_3")]
    assert [*made.statements] == [again, *products]
    assert after.statements == ()
    limits = [(check.status, check.limit) for check in made.checks]
    rows, inputs, masses = Status.CONSTRAINT_RANK, Status.ACTUATION_RANK, Status.MASS_RANK
    raised = [(rows, Local("raised_3")), (rows, least)]
    assert limits == [
        *((rows, Local("raised_2")), (rows, least)),
        *((inputs, Literal(Fraction(125))), (inputs, least)),
        *raised,
        *raised,
        (masses, scale),
    ]
    assert all(check.first is None and not check.apart for check in made.checks)
    _, made, _ = with_raised_thresholds(kernel, "float32", Raised(ranks=0)).blocks
    assert [*made.statements] == [again]
    assert [check.limit for check in made.checks] == [scale, least, number, least, scale, least, scale, least, scale]
    _, made, _ = with_raised_thresholds(kernel, "float32", Raised(masses=3)).blocks
    assert made.checks[:-2] == checks[:-1]
    assert [check.limit for check in made.checks[-2:]] == [Local("raised_2"), least]


def test_sweeps_meet_states_on_the_constraints_there() -> None:
    """The rows that are left at 1e-12 would let either leg go its own way: the rank that they have elsewhere counts."""
    witness = Witness(LIFT)
    walker, defaults = witness.walker(), witness.defaults()
    _, ranks = walker.states(defaults, 3)
    assert ranks.geometric == 4
    beside = np.array([1.32e-12, -2.64e-12, 1.32e-12, 0.94e-12, -1.88e-12])
    on = walker.refined(beside, defaults, ranks.geometric)
    assert np.allclose(on, on[0] * np.array([1, -2, 1, 1, -2]), rtol=1e-14, atol=0)
    assert not np.allclose(*walker.refined(beside, defaults)[[0, 3]], rtol=0.1, atol=0)


def test_a_rank_that_would_name_why_masses_are_lost_is_looked_at_before_them() -> None:
    """Rows that lose rank may keep enough of their masses' measure, whose own threshold stays."""
    value, scale = Local("value"), Local("scale")
    again = Statement(("twice",), "add", (value, value))
    cause = Block((again,), (Check(Status.CONSTRAINT_RANK, Local("twice"), scale),))
    load = Load("value", "q", 0)
    check = Check(Status.MASS_RANK, value, scale, first=cause, apart=True)
    limit = Statement(("scale",), "mul", (value, value))
    kernel = Kernel("masses", (), (load,), (Block((limit,), (check,)),), (value,), (1,))
    (block,) = with_raised_thresholds(kernel, "float64", Raised(ranks=2)).blocks
    assert [one.status for one in block.checks] == [Status.CONSTRAINT_RANK, Status.CONSTRAINT_RANK, Status.MASS_RANK]
    assert block.checks[-1] == replace(check, first=None, apart=False)
    assert [one.targets[0] for one in block.statements] == ["scale", "twice", "raised_1"]
    # where masses alone are raised rows are looked at as before
    (block,) = with_raised_thresholds(kernel, "float64", Raised(masses=2)).blocks
    assert [one.status for one in block.checks] == [Status.CONSTRAINT_RANK, Status.MASS_RANK, Status.MASS_RANK]
    assert block.checks[0].limit is scale
