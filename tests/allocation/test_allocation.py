"""Redundant inputs against their definitions: KKT systems, internal forces, quadratic programs by enumeration."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from itertools import product
from typing import Any

import allocation_models as models
import pytest
from flint import arb_mat
from laws_harness import System

from symgen.backends.c.plain import emit_c
from symgen.backends.python.module import emit_python
from symgen.ir.kernel import Status
from symgen.linear_algebra.exterior import ActuationForms
from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace
from symgen.linear_algebra.reflected_inputs import ReflectedInputs
from symgen.methods.derivation import Derivation
from symgen.methods.redundancy.allocation import InputAllocation
from symgen.methods.spaces import derivations
from symgen.model.load import load_text
from symgen.report.sections.allocation import allocated_inputs
from symgen.symbolic.evaluate import Evaluator
from symgen.verify.reference.arithmetic.linear import column, norm, solve
from symgen.verify.reference.arithmetic.tape import ball, precision
from symgen.verify.reference.evaluation import Evaluation
from symgen.verify.reference.inputs.allocation import internal_force
from symgen.verify.reference.quantities import QUANTITIES
from symgen.verify.reference.reference import State
from symgen.verify.run import verify
from symgen.verify.running.sources import generated_sources
from symgen.verify.sampling.states import sample_states
from symgen.verify.tolerance import FACTOR, expectations

BITS = 256
STATES = 8
EXACT = 1e-50
ROBOT = models.parallel_robot()
WEIGHTS = {
    models.AXIS: "weights: {right: 3}",
    models.PLATE: "weights: {p: 0.5, s: 7}",
    models.SKID: "weights: {q_1: 0.2, v: 3}, preload: {p: 1.5, v: -0.8}",
    ROBOT: "weights: {drive_1: 2, drive_2: 0.3}",
}
LIMITS = {
    models.AXIS: "weights: {right: 3}, preload: 0.7, limits: {left: [-1, 1], right: [-0.5, 0.7]}",
    models.PLATE: "weights: {p: 0.5}, limits: {p: [-0.4, 0.4], s: [-0.3, 0.3], t_1: [-0.5, 0.2]}",
    ROBOT: "preload: 0.2, limits: {drive_1: [-0.3, 0.3], drive_2: [-0.2, 0.4], drive_3: [-0.2, 0.2]}",
}


@cache
def system(text: str, block: str, outputs: tuple[str, ...] = ("inverse_dynamics",)) -> System:
    return System(f"{text}allocation: {{{block}}}\n", outputs)


@cache
def states(made: System) -> list[State]:
    return [sample.state for sample in sample_states(made.reference, ["inverse_dynamics"], STATES)]


def evaluations(made: System) -> Iterator[tuple[State, Evaluation]]:
    """The sampled states with what the reference knows of each: M, B and tau come from there, and nothing else."""
    for state in states(made):
        with precision(BITS):
            yield state, made.reference.evaluation(state)


def settings(made: System, state: State) -> dict[str, Any]:
    return {p.name: ball(x) for p, x in zip(made.model.parameters, state.parameters, strict=True)}


def by_input(made: System, state: State, given: Sequence[tuple[str, str]], absent: int) -> list[Any]:
    values, names = settings(made, state), dict(given)
    return [values[names[i.name]] if i.name in names else ball(absent) for i in made.model.inputs]


def nearest(e: Evaluation, weights: Sequence[Any], target: Any, fixed: dict[int, Any]) -> Any:
    """The u with M u + B'lambda = tau nearest to the target in the weights' norm, some u_k given: the KKT system."""
    n, m, r = e.system.n, e.system.m, e.system.r
    size = m + r + n
    matrix = [[ball(0)] * size for _ in range(size)]
    right = [ball(0)] * size
    for i in range(n):
        for k in range(m):
            matrix[i][k] = e.at.control[i, k]
            matrix[n + k][m + r + i] = e.at.control[i, k]
        for a in range(r):
            matrix[i][m + a] = e.at.constraints[a, i]
            matrix[n + m + a][m + r + i] = e.at.constraints[a, i]
        right[i] = e.load[i, 0]
    for k in range(m):
        if k in fixed:
            matrix[n + k] = [ball(int(j == k)) for j in range(size)]
            right[n + k] = fixed[k]
        else:
            matrix[n + k][k] = weights[k]
            right[n + k] = weights[k] * target[k, 0]
    solution = solve(arb_mat(size, size, [x for row in matrix for x in row]), column(right)).entries()
    return column(solution[:m])


def assert_kernel(made: System, state: State) -> list[float]:
    """The kernel's u, within the tolerance of the reference."""
    status, u = made.run("inverse_dynamics", state)
    assert status is Status.OK
    expected = expectations(made.reference, state, ["inverse_dynamics"], "float64", "test")["inverse_dynamics"]
    assert expected.in_units(expected.distance(u)) <= FACTOR
    return u


@pytest.mark.parametrize("text", WEIGHTS, ids=lambda text: text.split()[1])
def test_weights_and_preferred_values_solve_the_kkt_system(text: str) -> None:
    made = system(text, WEIGHTS[text])
    allocation = made.model.allocation
    assert allocation is not None
    for state, e in evaluations(made):
        weights = by_input(made, state, allocation.weights, 1)
        target = column(by_input(made, state, allocation.preferred, 0))
        wanted = nearest(e, weights, target, {})
        assert norm(QUANTITIES["inverse_dynamics"](e) - wanted) <= EXACT * norm(wanted)
        assert_kernel(made, state)


@pytest.mark.parametrize("text", [models.LAME, models.CRANKS], ids=lambda text: text.split()[1])
def test_weights_where_inputs_or_rows_depend_on_each_other(text: str) -> None:
    """W (u - p) is orthogonal to every internal force, and the motion is the one without allocation."""
    first, second = ("left", "right") if "left" in text else ("A", "C")
    made = system(text, f"weights: {{{first}: 3, {second}: 0.7}}, preload: {{{second}: 2}}")
    plain = System(text, ("inverse_dynamics",))
    assert made.model.allocation is not None
    for state, e in evaluations(made):
        weights = by_input(made, state, made.model.allocation.weights, 1)
        target = column(by_input(made, state, made.model.allocation.preferred, 0))
        u = QUANTITIES["inverse_dynamics"](e)
        # the columns of 1 - M~+ M~ span the internal forces
        internal = e.control_inverse * e.projected_control * ball(-1)
        for k in range(made.model.m):
            internal[k, k] += 1
        weighted = column([w * x for w, x in zip(weights, (u - target).entries(), strict=True)])
        assert norm(internal.transpose() * weighted) <= EXACT * norm(u)
        free = plain.reference.evaluation(State(state.q, state.qd, state.qdd, state.u, state.parameters[:1]))
        assert norm(e.projected_control * (u - QUANTITIES["inverse_dynamics"](free))) <= EXACT * norm(u)
        assert_kernel(made, state)


@pytest.mark.parametrize("text", LIMITS, ids=lambda text: text.split()[1])
def test_internal_force_moves_nothing_and_has_norm_one(text: str) -> None:
    made = system(text, LIMITS[text])
    assert made.model.allocation is not None
    for state, e in evaluations(made):
        weights = by_input(made, state, made.model.allocation.weights, 1)
        z = internal_force(e, weights)
        assert norm(e.projected_control * z) <= EXACT
        assert abs(float(sum(w * x * x for w, x in zip(weights, z.entries(), strict=True)) - 1)) <= EXACT


@pytest.mark.parametrize("text", LIMITS, ids=lambda text: text.split()[1])
def test_direction_has_the_documented_sign_along_every_null_space(text: str) -> None:
    made = system(text, LIMITS[text])
    mechanics, generic = made.derivations.mechanics, made.derivations.generic
    spaces = {name: derivation.space for name, derivation in derivations(mechanics, generic).items()}
    assert len(spaces) == 1 + bool(made.model.r)
    for space in spaces.values():
        forms, restriction = space.actuation(mechanics.inputs, generic.alpha)
        minors = [product.get((1 << forms.rows.n) - 1, mechanics.graph.zero) for product in forms.products[0][::-1]]
        evaluate = Evaluator([*minors, restriction.orientation(mechanics.graph)])
        for state, e in evaluations(made):
            *values, sign = evaluate(point(made, state))
            z = [float(x) for x in internal_force(e, [ball(1)] * made.model.m).entries()]
            signed = [sign * (-1) ** k * x for k, x in enumerate(values)]
            size = sum(x * x for x in signed) ** 0.5
            assert signed == pytest.approx([size * x for x in z], rel=1e-9, abs=1e-9 * size)


def point(made: System, state: State) -> dict[str, float]:
    """A state as values of the graph's symbols."""
    names = made.model.coordinates
    values = {c.name: float(x) for c, x in zip(names, state.q, strict=True)}
    values |= {c.rate: float(x) for c, x in zip(names, state.qd, strict=True)}
    values |= {c.acceleration: float(x) for c, x in zip(names, state.qdd, strict=True)}
    return values | {p.name: float(x) for p, x in zip(made.model.parameters, state.parameters, strict=True)}


@pytest.mark.parametrize("text", LIMITS, ids=lambda text: text.split()[1])
def test_every_way_gives_the_same_inputs(text: str) -> None:
    made = system(text, LIMITS[text])
    for derivation in derivations(made.derivations.mechanics, made.derivations.generic).values():
        evaluate = Evaluator(derivation.inverse_dynamics)
        for state, e in evaluations(made):
            wanted = [float(x) for x in QUANTITIES["inverse_dynamics"](e).entries()]
            size = max(map(abs, wanted))
            assert evaluate(point(made, state)) == pytest.approx(wanted, rel=1e-9, abs=1e-9 * size)


@pytest.mark.parametrize("text", [*WEIGHTS, *LIMITS], ids=lambda text: text.split()[1])
def test_reflections_of_the_inputs_give_the_same(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """As where determinants would be too many: the direction of the internal force keeps its sign."""
    made = system(text, {**WEIGHTS, **LIMITS}[text])
    monkeypatch.setattr("symgen.linear_algebra.null_space.null_spaces.small_family", lambda *_: False)
    mechanics, generic = made.derivations.mechanics, made.derivations.generic
    ways = derivations(mechanics, generic)
    assert made.model.r == 0 or set(ways) == {"minors", "householder"}
    ways.setdefault("householder", Derivation(mechanics, generic, HouseholderSpace(mechanics.graph, (), made.model.n)))
    for derivation in ways.values():
        assert made.model.allocation is not None
        allocated = InputAllocation(mechanics, generic, made.model.allocation, derivation.space)
        assert isinstance(allocated.forms, ReflectedInputs)
        guards = derivation.inverse_dynamics_guards
        evaluate = Evaluator([*derivation.inverse_dynamics, *(guard.denominator for guard in guards)])
        for state, e in evaluations(made):
            wanted = [float(x) for x in QUANTITIES["inverse_dynamics"](e).entries()]
            values = evaluate(point(made, state))
            assert values[: len(wanted)] == pytest.approx(wanted, rel=1e-12, abs=1e-12 * max(map(abs, wanted)))
            assert all(x > 0 for x in values[len(wanted) :])


def by_enumeration(made: System, state: State, e: Evaluation) -> Any | None:
    """The quadratic program: every choice of inputs held at a limit, the best one that keeps all limits."""
    allocation = made.model.allocation
    assert allocation is not None
    values = settings(made, state)
    weights = by_input(made, state, allocation.weights, 1)
    target = nearest(e, weights, column([ball(0)] * made.model.m), {})
    if allocation.preload is not None:
        target = target + internal_force(e, weights) * values[allocation.preload]
    names = [item.name for item in made.model.inputs]
    limits = [(names.index(x.input), values[x.lower], values[x.upper]) for x in allocation.limits]
    best, least = None, float("inf")
    for held in product((None, 1, 2), repeat=len(limits)):
        fixed = {limit[0]: limit[which] for limit, which in zip(limits, held, strict=True) if which is not None}
        if len(fixed) > 1:  # one direction is free: a second limit is met at exceptional states only
            continue
        u = nearest(e, weights, target, fixed)
        kept = all(low - 1e-60 <= u[k, 0] <= high + 1e-60 for k, low, high in limits)
        excess = float(sum(w * x * x for w, x in zip(weights, (u - target).entries(), strict=True)))
        if kept and excess < least:
            best, least = u, excess
    return best


def scaled(state: State, factor: float) -> State:
    """The state with all rates and accelerations smaller, so that the inputs are."""
    return State(
        state.q,
        tuple(factor * x for x in state.qd),
        tuple(factor * factor * x for x in state.qdd),
        state.u,
        state.parameters,
    )


@pytest.mark.parametrize("text", LIMITS, ids=lambda text: text.split()[1])
def test_limits_are_the_solution_of_the_quadratic_program(text: str) -> None:
    made = system(text, LIMITS[text])
    allocation = made.model.allocation
    assert allocation is not None
    seen = {"free": 0, "held": 0, "impossible": 0}
    for state in states(made):
        for factor in (0.05, 0.2, 0.6):
            milder = scaled(state, factor)
            with precision(BITS):
                e = made.reference.evaluation(milder)
                wanted = by_enumeration(made, milder, e)
                u = QUANTITIES["inverse_dynamics"](e)
                if wanted is None:
                    seen["impossible"] += 1
                    assert_pareto(made, milder, e)
                else:
                    weights = by_input(made, milder, allocation.weights, 1)
                    start = column([ball(0)] * made.model.m)
                    shift = settings(made, milder)[allocation.preload] if allocation.preload else ball(0)
                    untouched = nearest(e, weights, start, {}) + internal_force(e, weights) * shift
                    seen["free" if norm(untouched - wanted) <= EXACT * norm(wanted) else "held"] += 1
                    assert norm(u - wanted) <= EXACT * norm(wanted)
            assert_kernel(made, milder)
    assert all(seen.values()), seen


def assert_pareto(made: System, state: State, e: Evaluation) -> None:
    """The motion is produced, and a small step either way along the internal force makes some excess larger."""
    allocation = made.model.allocation
    assert allocation is not None
    u = QUANTITIES["inverse_dynamics"](e)
    assert norm(e.projected_control * u - e.projector * e.load) <= EXACT * norm(e.load)
    values = settings(made, state)
    names = [item.name for item in made.model.inputs]
    z = internal_force(e, by_input(made, state, allocation.weights, 1))

    def excess(inputs: Any) -> list[Any]:
        excesses = []
        for limit in allocation.limits:
            x = inputs[names.index(limit.input), 0]
            excesses.append((x - values[limit.upper]).max(values[limit.lower] - x).max(ball(0)))
        return excesses

    here = excess(u)
    assert any(x > 0 for x in here)
    for step in (ball(1e-40), ball(-1e-40)):
        assert any(there > now for there, now in zip(excess(u + z * step), here, strict=True))


def test_one_axis_by_hand() -> None:
    """m x_ddot = u_1 + 2 u_2, M = [1, 2]: z = (2, -1)/sqrt(w_1 4 + w_2), the sign of det[M without column 1] = +2."""
    made = system(models.AXIS, "preload: 3")
    status, u = made.run("inverse_dynamics", made.state([0.3], qdd=[2.0]))
    assert status is Status.OK
    assert u == pytest.approx([2 + 6 / 5**0.5, 4 - 3 / 5**0.5], rel=1e-15)
    weighted = system(models.AXIS, "weights: {left: 2, right: 1}, preload: 3")
    status, u = weighted.run("inverse_dynamics", weighted.state([0.3], qdd=[2.0]))
    # least 2 u_1^2 + u_2^2 with u_1 + 2 u_2 = 10: (10/9, 40/9); z^T W z = 1 for z = (2, -1)/3
    assert u == pytest.approx([10 / 9 + 2, 40 / 9 - 1], rel=1e-15)


def test_kinks_are_where_an_input_reaches_its_limit() -> None:
    """u_1 + 2 u_2 = 5 x_ddot: (1, 2) x_ddot up to u_1 = 3, then u_2 grows by 5/2 instead of 2."""
    made = system(models.AXIS, "limits: {left: [-3, 3], right: [-20, 20]}")

    def inputs(acceleration: float) -> list[float]:
        return made.run("inverse_dynamics", made.state([0.0], qdd=[acceleration]))[1]

    for middle, slopes in ((1.0, (2.0, 2.0)), (3.0, (2.0, 2.5)), (5.0, (2.5, 2.5)), (-3.0, (2.5, 2.0))):
        below, here, above = (inputs(middle + step)[1] for step in (-0.25, 0.0, 0.25))
        assert ((here - below) / 0.25, (above - here) / 0.25) == pytest.approx(slopes, rel=1e-12)
    for block, many in (("scale: true", True), ("preload: 3", False)):
        limits = "limits: {left: [-3, 3], right: [-9, 9]}"
        model = load_text(f"{models.AXIS}allocation: {{{limits}, {block}}}\n", "axis.yaml")
        assert model.allocation is not None
        section = repr(allocated_inputs(model, model.allocation, determined=False))
        assert "have kinks" in section
        assert ("A further one is where" in section) is many


def test_limits_that_contradict_each_other_leave_the_preload_where_it_is() -> None:
    """x_ddot = 2 needs u_1 + 2 u_2 = 10, both below 1: no u keeps that, and the least one lies between the two."""
    made = system(models.AXIS, "limits: {left: [-1, 1], right: [-1, 1]}")
    status, u = made.run("inverse_dynamics", made.state([0.0], qdd=[2.0]))
    assert status is Status.OK
    assert u == pytest.approx([2, 4], rel=1e-15)


def test_an_input_exactly_at_its_limit_outside_the_internal_force() -> None:
    """q on y alone: its part of the internal force is 0 everywhere, and its limits say nothing."""
    text = """\
model: apart
coordinates: {x: {unit: m}, y: {unit: m}}
kinetic_energy: x_dot**2/2 + y_dot**2/2
inputs: {a: {acts_on: {x: 1}}, b: {acts_on: {x: 1}}, q: {acts_on: {y: 1}}}
"""
    made = system(text, "limits: {a: [-1, 1.5], q: [-2, 2]}")
    assert [notice.message for notice in made.model.notices] == [
        "the motion alone determines `q`: no other input can take over what is beyond its limits"
    ]
    for y in (2.0, 5.0):
        status, u = made.run("inverse_dynamics", made.state([0.0, 0.0], qdd=[4.0, y]))
        assert status is Status.OK
        assert u == pytest.approx([1.5, 2.5, y], rel=1e-15)


def test_limits_of_an_input_that_takes_no_part_where_it_is_beyond_them() -> None:
    """u_a + sin(x) u_b = x_ddot: at x = 0 no u_b brings u_a below its limit, and near it a large one does."""
    text = """\
model: lever
coordinates: {x: {unit: rad}}
kinetic_energy: x_dot**2/2
inputs: {a: {acts_on: {x: 1}}, b: {acts_on: {x: sin(x)}}}
"""
    made = system(text, "limits: {a: [-1, 1]}")
    status, u = made.run("inverse_dynamics", made.state([0.0], qdd=[10.0]))
    assert status is Status.OK
    assert u == [10, 0]
    status, u = made.run("inverse_dynamics", made.state([1e-3], qdd=[10.0]))
    assert u == pytest.approx([1, 9 / math.sin(1e-3)], rel=1e-12)


@pytest.mark.parametrize("infinite", [1e300, float("inf")])
def test_endless_limits_at_run_time_are_no_limits(infinite: float) -> None:
    made = system(models.AXIS, "limits: {left: [-1, 1], right: [-1, 1]}")
    free = dict.fromkeys(["limit_left_upper", "limit_right_upper"], infinite)
    free |= dict.fromkeys(["limit_left_lower", "limit_right_lower"], -infinite)
    state = made.state([0.0], qdd=[2.0])
    names = [p.name for p in made.model.parameters]
    parameters = tuple(free.get(name, x) for name, x in zip(names, state.parameters, strict=True))
    status, u = made.run("inverse_dynamics", State(state.q, state.qd, state.qdd, state.u, parameters))
    assert status is Status.OK
    assert u == pytest.approx([2, 4], rel=1e-15)


def test_inverse_dynamics_is_the_only_quantity_that_changes() -> None:
    plain = System(models.SKID, ("all",))
    made = system(models.SKID, WEIGHTS[models.SKID], ("all",))
    assert plain.names == made.names
    for name in plain.names:
        same = plain.kernel(name) == made.kernel(name)
        assert same == (name != "inverse_dynamics"), name


def test_settings_are_the_last_members_of_the_struct() -> None:
    made = system(ROBOT, "weights: {drive_2: m_1*5}, preload: 0.2, limits: {drive_1: [-0.2, 2*0.2]}")
    names = [p.name for p in made.model.parameters]
    added = ["weight_drive_2", "preload", "limit_drive_1_lower", "limit_drive_1_upper"]
    assert names[-4:] == added
    header = emit_c(made.model, made.program())["c/rapkm_2rrr_rr.h"]
    for name, value in zip(added, ("1.0", "0.2", "-0.2", "0.4"), strict=True):
        assert header.split(f" {name}; /**< ")[1].split(" */")[0].endswith(f"default {value}")


def test_no_set_of_subsets_is_empty_of_weights() -> None:
    """Weights of all inputs equal to one number change nothing but the scale."""
    made = system(models.PLATE, "weights: {p: 2, q_1: 2, s: 2, t_1: 2}")
    plain = System(models.PLATE, ("inverse_dynamics",))
    for state in states(made):
        same = tuple(2.0 for _ in range(4))
        alike = State(state.q, state.qd, state.qdd, state.u, (*state.parameters[:3], *same))
        _, u = made.run("inverse_dynamics", alike)
        _, wanted = plain.run("inverse_dynamics", State(*(*parts(alike), state.parameters[:3])))
        assert u == pytest.approx(wanted, rel=1e-12)


def parts(state: State) -> tuple[tuple[Any, ...], ...]:
    return state.q, state.qd, state.qdd, state.u


def test_forms_count_a_subset_by_the_weights_outside_it() -> None:
    made = system(models.PLATE, "weights: {p: 1, q_1: 1, s: 1, t_1: 1}")
    mechanics, generic = made.derivations.mechanics, made.derivations.generic
    forms, _ = derivations(mechanics, generic)["minors"].space.actuation(mechanics.inputs, generic.alpha)
    w = [mechanics.graph.symbol(f"weight {k}") for k in range(4)]
    weighted = ActuationForms(forms.rows, forms.inputs, forms.degree, w)
    assert [weighted.importance(subset) for subset in weighted.subsets] == [w[3], w[2], w[1], w[0]]


@pytest.mark.toolchain
@pytest.mark.parametrize("text", [models.AXIS, ROBOT], ids=lambda text: text.split()[1])
def test_c_and_python_agree_with_the_reference(tool: Callable[[str], str], text: str) -> None:
    tool("cc")
    made = system(text, LIMITS[text])
    files = emit_python(made.model, made.program())
    for scalar in ("float64", "float32"):
        files |= emit_c(made.model, made.program(scalar))
    c_sources, python_source = generated_sources(made.model, files)
    certificate = verify(made.model, made.program().kernels, c_sources, python_source, STATES)
    assert certificate.failures == ()
    assert set(certificate.targets) >= {"C float64", "C float32", "Python float64"}
