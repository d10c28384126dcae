"""Laws that generated results obey: projector, Penrose conditions, skew symmetry, balance of power.

A law of exact values holds for results y = y* + e up to terms linear in e; with |e| <= 16 (d + eps |y*|) that gives
each defect a bound, to which what the reference itself violates (rounded states of dependent constraints) is added.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, partial
from typing import Any, TypeAlias

from flint import arb_mat

from symgen.verify.reference.arithmetic.linear import column, norm
from symgen.verify.reference.evaluation import Evaluation
from symgen.verify.reference.friction import friction_of
from symgen.verify.reference.reference import REFERENCE_BITS, Reference
from symgen.verify.sampling.states import Sample
from symgen.verify.tolerance import FACTOR, Expectation

Values: TypeAlias = Mapping[str, Any]
Law: TypeAlias = tuple[str, Callable[[Values], Any], Callable[[Values, Mapping[str, float]], float]]


def defects(
    reference: Reference,
    sample: Sample,
    expected: Mapping[str, Expectation],
    results: Mapping[str, tuple[float, ...]],
) -> Iterator[tuple[str, str, float]]:
    """Each law the results can be tested on at one state, the quantity it judges, and its defect over its bound."""

    def evaluated() -> list[tuple[str, str, float]]:
        return list(_defects(reference.evaluation(sample.state), sample.admissible, expected, results))

    yield from reference.regular(evaluated, REFERENCE_BITS)


def _defects(
    evaluation: Evaluation,
    admissible: bool,
    expected: Mapping[str, Expectation],
    results: Mapping[str, tuple[float, ...]],
) -> Iterator[tuple[str, str, float]]:
    """The same at one working precision."""
    exact = {name: expectation.value for name, expectation in expected.items()}
    given = {
        name: arb_mat(exact[name].nrows(), exact[name].ncols(), list(entries)) for name, entries in results.items()
    }
    room = {name: FACTOR * expectation.unit for name, expectation in expected.items()}
    for needed, (name, defect, bound) in _laws(evaluation, admissible):
        if all(quantity in given for quantity in needed):
            allowed = bound(exact, room) + 2 * norm(defect(exact))
            size = norm(defect(given))
            yield name, needed[0], size / allowed if allowed else float(size > 0)


def _laws(evaluation: Evaluation, admissible: bool) -> Iterator[tuple[tuple[str, ...], Law]]:
    """The quantities a law is about, the one it judges first, and the law."""
    rows = ("constraint_jacobian", "B")
    yield from _projection("nullspace_projector", "N", (rows,))
    yield from _penrose()
    yield from _projection("task_nullspace_projector", "N_x", (rows, ("task_jacobian", "J_x")))
    still, least = "task_nullspace_projector", "velocity_from_task"
    yield (
        (least, still),
        ("N_x qd = 0 (qd the least rates)", lambda y: y[still] * y[least], _bound_of_product(still, least)),
    )
    c = "projected_coriolis_matrix"
    rate = cache(partial(_projected_mass_rate, evaluation))
    yield (
        (c,),
        ("d/dt G~ - 2 C~ is skew", lambda y: rate() - y[c] - y[c].transpose(), lambda _, e: 2 * e[c]),
    )
    if admissible:
        q = "forward_dynamics"
        # neither is worked out where no accelerations are looked at: both may take longer than all that is
        weight = cache(lambda: evaluation.at.mass * evaluation.rate)
        rest = cache(partial(_power_without_accelerations, evaluation))
        yield (
            (q,),
            ("power balance", lambda y: weight().transpose() * y[q] + rest(), lambda _, e: norm(weight()) * e[q]),
        )


def _projection(n: str, symbol: str, vanishing: Sequence[tuple[str, str]]) -> Iterator[tuple[tuple[str, ...], Law]]:
    """That N is an orthogonal projector, and that these matrices vanish on what it leaves."""
    squared = f"{symbol} {symbol} = {symbol}"
    yield (n,), (squared, lambda y: y[n] * y[n] - y[n], lambda _, e: 3 * e[n] + e[n] ** 2)
    yield (n,), (f"{symbol}' = {symbol}", lambda y: y[n].transpose() - y[n], lambda _, e: 2 * e[n])
    for b, letter in vanishing:
        yield (n, b), (f"{letter} {symbol} = 0", partial(_product, b, n), _bound_of_product(b, n))


def _product(a: str, b: str, y: Values) -> Any:
    return y[a] * y[b]


def _bound_of_product(a: str, b: str) -> Callable[[Values, Mapping[str, float]], float]:
    return lambda y, e: norm(y[a]) * e[b] + (norm(y[b]) + e[b]) * e[a]


def _penrose() -> Iterator[tuple[tuple[str, ...], Law]]:
    """The four conditions on A = M~ and X = M~+."""
    a, x = "projected_control_matrix", "projected_control_pseudoinverse"

    def product_bound(y: Values, e: Mapping[str, float]) -> float:
        return 2 * ((norm(y[a]) + e[a]) * e[x] + norm(y[x]) * e[a])

    def first(y: Values, e: Mapping[str, float]) -> float:
        return (norm(y[a]) + e[a]) * product_bound(y, e) + 2 * e[a]

    def second(y: Values, e: Mapping[str, float]) -> float:
        return (norm(y[x]) + e[x]) * product_bound(y, e) + 2 * e[x]

    yield (x, a), ("A X A = A (A = M~, X = M~+)", lambda y: y[a] * y[x] * y[a] - y[a], first)
    yield (x, a), ("X A X = X", lambda y: y[x] * y[a] * y[x] - y[x], second)
    yield (x, a), ("(A X)' = A X", lambda y: _skew(y[a] * y[x]), product_bound)
    yield (x, a), ("(X A)' = X A", lambda y: _skew(y[x] * y[a]), product_bound)


def _skew(matrix: Any) -> Any:
    return matrix - matrix.transpose()


def _projected_mass_rate(e: Evaluation) -> Any:
    """d/dt (N G N) along N qd."""
    velocity = e.projected_rate
    half = e.projector_dot(velocity) * e.at.mass * e.projector
    return half + half.transpose() + e.projector * e.mass_dot(velocity) * e.projector


def _power_without_accelerations(e: Evaluation) -> Any:
    """d/dt (T + U) - qd'(M u + Q_a) + qd'B' lambda, but for the term qd'G qdd; qd'G_dot qd/2 = qd'C qd."""
    rate = e.rate.transpose()
    kinetic = rate * e.motion(e.rate)[0]
    multipliers = e.inverse.transpose() * (e.force - e.at.mass * e.accelerations)
    constraint = (e.at.constraints * e.rate).transpose() * multipliers
    supplied = rate * (e.at.control * column(e.u) + e.applied(e.rate))
    if e.system.model.rough:
        force = friction_of(e, True).force
        multipliers -= e.inverse.transpose() * (force - e.at.mass * (e.weighted * force))
        constraint = (e.at.constraints * e.rate).transpose() * multipliers
        supplied -= rate * force
    return kinetic + rate * e.at.potential_gradient - supplied + constraint
