"""A system in other rates, angles or bodies is the same system, exactly: values in a field, no rounding."""

from __future__ import annotations

import random
from collections.abc import Sequence

import pytest
from flint import fmpz_mod_ctx, fmpz_mod_mat

from symgen.mechanics.absolute_angles import AbsoluteAngles
from symgen.mechanics.never_zero import Definite
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.absolute import in_absolute_angles
from symgen.methods.forward_dynamics.columns_apart import apart
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.inverse_dynamics.rates import combined, reduced_rates
from symgen.model.load import load_text
from symgen.symbolic.fingerprint import PRIME
from symgen.symbolic.graph import Graph
from symgen.symbolic.identity import every_identity_evaluated, same_values
from symgen.symbolic.matrix import Matrix, flatten, identity, matmul, matvec, transpose
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.transplant import transplanted

FIELD = fmpz_mod_ctx(PRIME)


def _same(rule: str, before: Sequence[Scalar], after: Sequence[Scalar]) -> None:
    with every_identity_evaluated():
        same_values(rule, before, after)


def _rank(matrix: Matrix) -> int:
    return int(fmpz_mod_mat([[entry.value for entry in row] for row in matrix], FIELD).rank()) if matrix else 0


def test_absolute_angles_are_there_and_back() -> None:
    """Work is the same: f . S y = (S^T f) . y."""
    for seed in range(100):
        graph, draw, n = Graph(), random.Random(seed), 6
        order = draw.sample(range(n), n)
        parents: list[int | None] = [None] * n
        for place, j in enumerate(order[1:], 1):
            parents[j] = draw.choice([None, *order[:place]])
        change = AbsoluteAngles(tuple(parents))
        y, f = (tuple(graph.symbol(f"{name}{j}") for j in range(n)) for name in "yf")
        _same("there and back", y, change.absolute(change.relative(y)))
        _same("back and there", y, change.relative(change.absolute(y)))
        work = [graph.sum(a * b for a, b in zip(f, change.relative(y), strict=True))]
        _same("forces", work, [graph.sum(a * b for a, b in zip(change.forces(f), y, strict=True))])


# Links in a chain, with a spring and friction between them.
CHAIN = """model: chain
parameters: {l: {value: 0.4, range: [0.1, 1]}, k: {value: 0.3, range: [0.1, 1]}, J: {value: 2, range: [0.1, 10]}}
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}, e: {unit: rad}, s: {unit: m}}
definitions:
  tip_x: l*cos(a) + 0.03*sin(a) + k*cos(a + b) + l*cos(a + b + c)
  tip_y: l*sin(a) - 0.03*cos(a) + k*sin(a + b) + l*sin(a + b + c)
kinetic_energy: >-
  (J*(a_dot**2 + b_dot**2 + c_dot**2 + 2*d_dot**2 + e_dot**2) + 3*s_dot**2
  + 0.1*cos(b)*a_dot*b_dot + 0.2*cos(c)*b_dot*c_dot + 0.1*cos(e)*d_dot*e_dot)/2
potential_energy: 2*(b - 0.3)**2 + 3*sin(a + b)
constraints:
  geometric:
    along: tip_x - 1 - k*cos(d) - l*cos(d + e)
    across: tip_y - k*sin(d) - l*sin(d + e)
    bar: 0.6*s + 0.8*tip_x - tip_y
applied_forces: {b: -0.4*b_dot}
inputs: {push: {acts_on: {s: 1}}, turn: {acts_on: {b: 1}}}
outputs: [multipliers]
configuration: {a: 1.9, b: -1.0, c: -0.5, d: 2.3, e: -1.1, s: 0.0}
"""


def test_a_system_in_absolute_angles_is_the_system() -> None:
    """G_y = S^T G S, B_y = B S, M_y = S^T M, and the balance of forces."""
    turned = in_absolute_angles(load_text(CHAIN, "chain.yaml"))
    assert turned is not None
    change = turned.change
    assert change is not None
    plain, graph, n = System(turned.model), turned.graph, turned.n
    axes = [change.relative(axis) for axis in identity(graph, n)]
    s = transpose(tuple(axes), n)
    names = {
        str(old.payload): new
        for olds, news in ((plain.q, turned.q), (plain.qd, turned.qd), (plain.qdd, turned.qdd))
        for old, new in zip(olds, change.relative(news), strict=True)
    }

    def there(matrix: Matrix) -> Matrix:
        return tuple(tuple(transplanted(graph, row, names)) for row in matrix)

    mass = matmul(graph, transpose(s, n), matmul(graph, there(plain.mass_matrix), s, n), n)
    _same("G", flatten(mass), flatten(turned.mass_matrix))
    _same("B", flatten(matmul(graph, there(plain.constraint_jacobian), s, n)), flatten(turned.constraint_jacobian))
    for own, other in zip(plain.inputs, turned.inputs, strict=True):
        _same("M", change.forces(there((own,))[0]), other)
    _same("balance", change.forces(there((plain.balance,))[0]), turned.balance)


def test_columns_beside_each_other_are_the_same_equations() -> None:
    turned = in_absolute_angles(load_text(CHAIN, "chain.yaml"))
    assert turned is not None
    problem = Problem(turned, ())
    separated = apart(problem)
    assert separated is not None
    graph, n = turned.graph, turned.n
    axes = [separated.brought_back(Motion(axis, (), ())).accelerations for axis in identity(graph, n)]
    t = transpose(tuple(axes), n)
    assert t != identity(graph, n)
    mass = matmul(graph, transpose(t, n), matmul(graph, problem.mass_matrix, t, n), n)
    _same("T^T G T", flatten(mass), flatten(separated.mass_matrix))
    _same("B T", flatten(matmul(graph, problem.rows, t, n)), flatten(separated.rows))
    _same("T^T f", matvec(graph, transpose(t, n), problem.force), separated.force)


SLIDES = """model: slides
parameters: {k: {value: 1, range: [0.5, 2]}, l: {value: 1, range: [0.5, 2]}, m: {value: 1}}
coordinates: {a: {unit: rad}, b: {unit: rad}}
kinetic_energy: m*(a_dot**2 + b_dot**2)
inputs: {turn: {acts_on: {a: 1}}}
outputs: [inverse_dynamics]
"""


@pytest.mark.parametrize("shape", [(2, 4), (3, 5), (4, 6)])
def test_reduced_rates_span_the_null_space(shape: tuple[int, int]) -> None:
    """B motion is as much as the core tells, and nothing is lost: rank B + width = rank core + n."""
    steps = 0
    for seed in range(40):
        system, draw = System(load_text(SLIDES, "slides.yaml")), random.Random(seed)
        graph, (a, b) = system.graph, system.q
        k, long, m = system.parameters
        pairs = [(graph.trig("cos", x), graph.trig("sin", x)) for x in (a, b, a + b)]
        r, n = shape
        rows = [[graph.zero] * n for _ in range(r)]
        for row in rows:
            i, j = draw.sample(range(n), 2)
            (c, s), size = draw.choice(pairs), draw.choice((k, long, k * long, m))
            row[i], row[j] = draw.choice(((size * c, size * s), (-size * s, size * c), (size * c, size * m)))
            for _ in range(draw.randrange(2)):
                row[draw.randrange(n)] = draw.choice((k, -long, m * pairs[0][0], graph.one, k * pairs[1][1]))
        given = tuple(map(tuple, rows))
        with every_identity_evaluated():
            rates = reduced_rates(graph, Definite(system), given, n)
        assert _rank(rates.motion) == rates.width
        assert n - _rank(given) == rates.width - _rank(rates.core)
        through = matmul(graph, given, rates.motion, rates.width)
        assert _rank((*through, *rates.core)) == _rank(rates.core) == _rank(through)
        steps += n - rates.width
    assert steps > 20


def test_sums_are_combined_term_by_term() -> None:
    paired = 0
    for seed in range(200):
        graph, draw = Graph(), random.Random(seed)
        p, q, k, m = (graph.symbol(name) for name in "pqkm")
        c, s = graph.trig("cos", p), graph.trig("sin", p)
        x, y = graph.zero, graph.zero
        for size in draw.sample((k, m, k * m, 3 * k), 2):
            turned = graph.trig("cos", p + q), graph.trig("sin", p + q)
            first, second = turned if draw.random() < 0.7 else turned[::-1]
            sign = draw.choice((1, -1))
            x, y = x + sign * size * first, y + draw.choice((sign, 1, -1)) * size * second
        plain = graph.raw("add", (graph.raw("mul", (c, x)), graph.raw("mul", (s, y))))
        combination = combined(c, x, s, y)
        _same("combining", [plain], [combination])
        paired += combination.size < plain.size
    assert paired > 10


# The bodies furthest out are given by parameters alone, as one function of all bodies takes them.
OWN = ("mass", "x", "y", "z", "xx", "yy", "zz", "xy", "xz", "yz")
VALUES = (2, 0.2, 0.1, 0.3, 0.5, 0.6, 0.7, 0.01, 0.02, 0.03)
GIVEN = ", ".join(
    f"{name}_{own}: {{value: {value}}}" for name in ("fore", "hand") for own, value in zip(OWN, VALUES, strict=True)
)
BODIES = "\n".join(
    f"  {name}: {{mass: {name}_mass, com: [{name}_x, {name}_y, {name}_z], inertia: "
    + "{" + ", ".join(f"{own}: {name}_{own}" for own in OWN[4:]) + "}}"
    for name in ("fore", "hand")
)
ARM = f"""model: arm
parameters: {{J: {{value: 0.3}}, h: {{value: 0.2}}, {GIVEN}}}
joints:
  base: {{type: revolute, axis: z, coordinate: a}}
  upper: {{type: revolute, parent: base, at: [0.1, 0, 0.4], axis: y, coordinate: b}}
  fore: {{type: revolute, parent: upper, at: [0.7, 0.1, 0], axis: [1, 2, 2], coordinate: c}}
  hand: {{type: revolute, parent: fore, at: [0.5, 0, h], axis: x, coordinate: d}}
bodies:
  base: {{mass: 4, com: [0.1, 0.2, 0.3], inertia: {{xx: 0.3, yy: 0.4, zz: J, xy: 0.02, xz: 0.03, yz: 0.01}}}}
  upper: {{mass: 3, com: [0.3, 0.1, h], inertia: {{xx: 0.2, yy: J, zz: 0.5, xy: 0.01, xz: 0.02, yz: 0.03}}}}
{BODIES}
gravity: [0, 1, -9.81]
inputs: {{u_1: {{joint: a}}, u_2: {{joint: b}}, u_3: {{joint: c}}, u_4: {{joint: d}}}}
outputs: [inverse_dynamics]
"""


def test_lumped_bodies_take_the_same_forces() -> None:
    model = load_text(ARM, "arm.yaml")
    apart_, together = (System(model, lumped=lumped) for lumped in (False, True))
    _same("lumping", apart_.balance, together.balance)
