"""Every rewriting keeps the value: random expressions built twice, raw and through the constructors."""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from symgen.symbolic import traverse
from symgen.symbolic.angles.angle_forms import angle_form
from symgen.symbolic.angles.sharing import share_angles
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.evaluate import FUNCTIONS, Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, substitute, topological, weights_alone

NAMES = ("x", "y", "z")
POINT = {"x": 0.83, "y": -1.37, "z": 0.41}
OTHER = {"x": -0.29, "y": 0.77, "z": 2.13}
EXPONENTS = (Fraction(2), Fraction(3), Fraction(-1), Fraction(5, 2))
QUICK = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])

leaves = st.one_of(
    st.sampled_from(NAMES),
    st.integers(-3, 3),
    st.fractions(min_value=-2, max_value=2, max_denominator=4),
)


def _grown(children: st.SearchStrategy[object]) -> st.SearchStrategy[object]:
    return st.one_of(
        st.tuples(st.sampled_from(("add", "sub", "mul", "div")), children, children),
        st.tuples(st.sampled_from(("neg", "sin", "cos")), children),
        st.tuples(st.sampled_from(("abs", "sqrt", "atan", "tanh")), children),
        st.tuples(st.just("power"), children, st.sampled_from(EXPONENTS)),
    )


trees = st.recursive(leaves, _grown, max_leaves=14)


def build(graph: Graph, tree: object) -> Scalar:
    """The tree through the constructors."""
    match tree:
        case str():
            return graph.symbol(tree)
        case int() | Fraction():
            return graph.const(tree)
        case ("power", base, exponent):
            return graph.power(build(graph, base), exponent)
        case ("neg", a):
            return graph.neg(build(graph, a))
        case (name, a):
            return graph.function(name, (build(graph, a),))
        case (name, a, b):
            return {"add": graph.add, "sub": graph.sub, "mul": graph.mul, "div": graph.div}[name](
                build(graph, a), build(graph, b)
            )
    raise TypeError(tree)


def plain(tree: object, point: dict[str, float]) -> float:
    """The tree's value by Python's own arithmetic; NaN where it has none."""
    match tree:
        case str():
            return point[tree]
        case int() | Fraction():
            return float(tree)
        case ("power", base, exponent):
            value = plain(base, point)
            try:
                return math.nan if value < 0 and exponent.denominator > 1 else value ** float(exponent)
            except (ZeroDivisionError, OverflowError):
                return math.nan
    name, *parts = tree
    values = [plain(part, point) for part in parts]
    try:
        return float(FUNCTIONS[name](*values))
    except (ValueError, ZeroDivisionError, OverflowError):
        return math.nan


def precise(tree: object, point: dict[str, mpmath.mpf]) -> mpmath.mpf:
    """The tree's value in the digits that mpmath works with."""
    match tree:
        case str():
            return point[tree]
        case int() | Fraction():
            return mpmath.mpf(tree.numerator) / tree.denominator
        case ("power", base, exponent):
            return precise(base, point) ** (mpmath.mpf(exponent.numerator) / exponent.denominator)
    name, *parts = tree
    values = [precise(part, point) for part in parts]
    return FUNCTIONS[name](*values) if name in ("add", "sub", "mul", "div", "neg") else getattr(mpmath, name)(*values)


def slope(tree: object, name: str) -> float:
    """The derivative at POINT by a difference at 60 digits, some 30 of them right; no absolute values in `tree`."""
    with mpmath.workdps(60):
        point, step = {key: mpmath.mpf(value) for key, value in POINT.items()}, mpmath.mpf(10) ** -20
        high, low = (precise(tree, {**point, name: point[name] + side}) for side in (step, -step))
        return float((high - low) / (2 * step))


def conditioned(tree: object, point: dict[str, float]) -> bool:
    """Whether the value and those close by agree to many digits and no intermediate is huge, tiny or undefined."""
    values = [plain(tree, {k: v * (1 + s * 1e-13) for k, v in point.items()}) for s in (-1, 0, 1)]
    return all(math.isfinite(v) for v in values) and _tame(tree, point)


def _tame(tree: object, point: dict[str, float]) -> bool:
    if not isinstance(tree, tuple):
        return True
    value = plain(tree, point)
    if not (math.isfinite(value) and (value == 0 or 1e-3 < abs(value) < 1e3)):
        return False
    if tree[0] == "div" and abs(plain(tree[2], point)) < 1e-3:
        return False
    if tree[0] in ("power", "sqrt", "abs") and abs(plain(tree[1], point)) < 1e-3:
        return False
    return all(_tame(part, point) for part in tree[1:] if isinstance(part, tuple))


@QUICK
@given(trees)
def test_constructors_keep_the_value(tree: object) -> None:
    for point in (POINT, OTHER):
        if conditioned(tree, point):
            graph = Graph()
            (value,) = Evaluator([build(graph, tree)])(point)
            assert value == pytest.approx(plain(tree, point), rel=1e-8, abs=1e-8)


@pytest.mark.campaign
@QUICK
@given(st.lists(trees, min_size=1, max_size=3))
def test_sharing_angles_keeps_the_values(forest: list[object]) -> None:
    if not all(conditioned(tree, POINT) for tree in forest):
        return
    graph = Graph()
    outputs = [build(graph, tree) for tree in forest]
    shared = share_angles(graph, outputs)
    for before, after in zip(Evaluator(outputs)(POINT), Evaluator(shared)(POINT), strict=True):
        assert after == pytest.approx(before, rel=1e-8, abs=1e-8)
    assert cost(shared).angles <= cost(outputs).angles


@QUICK
@given(trees)
def test_derivatives_are_those_of_differences_at_many_digits(tree: object) -> None:
    graph = Graph()
    output = build(graph, tree)
    if not conditioned(tree, POINT) or "abs" in str(tree):
        return
    symbols = [graph.symbol(name) for name in NAMES]
    exact = Evaluator(gradient(graph, output, symbols))(POINT)
    along = [derivative_along(graph, [output], {symbol: graph.one})[0] for symbol in symbols]
    forward = Evaluator(along)(POINT)
    for name, reverse, straight in zip(NAMES, exact, forward, strict=True):
        expected = slope(tree, name)
        size = max(1.0, abs(expected))
        assert reverse == pytest.approx(expected, rel=1e-9, abs=1e-9 * size)
        assert straight == pytest.approx(expected, rel=1e-9, abs=1e-9 * size)


@QUICK
@given(trees, trees)
def test_substitution_is_composition(tree: object, inner: object) -> None:
    graph = Graph()
    output, replacement = build(graph, tree), build(graph, inner)
    (composed,) = substitute(graph, [output], {graph.symbol("x"): replacement})
    value = plain(inner, POINT)
    if math.isfinite(value) and abs(value) > 1e-3 and conditioned(tree, {**POINT, "x": value}):
        if not conditioned(inner, POINT):
            return
        assert Evaluator([composed])(POINT)[0] == pytest.approx(plain(tree, {**POINT, "x": value}), rel=1e-6, abs=1e-6)


@QUICK
@given(trees)
def test_operands_come_before_operators(tree: object) -> None:
    graph = Graph()
    output = build(graph, tree)
    order = topological([output])
    place = {node: i for i, node in enumerate(order)}
    assert order[-1] is output
    assert len(place) == len(order)
    assert all(place[a] < place[node] for node in order for a in node.args)


@pytest.fixture
def graph() -> Graph:
    return Graph()


def test_equal_operations_are_one_node(graph: Graph) -> None:
    x, y = graph.symbol("x"), graph.symbol("y")
    assert x + y is y + x
    assert x * y is y * x
    assert x - y is not y - x
    assert (x + y) * (x - y) is (x - y) * (y + x)


def test_zeros_ones_and_signs(graph: Graph) -> None:
    x, y = graph.symbol("x"), graph.symbol("y")
    assert (x * 0).is_zero
    assert (x - x).is_zero
    assert x + 0 is x
    assert x * 1 is x
    assert (x / x).is_one
    assert graph.neg(-x) is x
    assert -(x - y) is y - x
    assert (-x) * (-y) is x * y
    assert x + (-y) is x - y
    assert x + x is 2 * x
    assert (2 * x + 3 * x) is 5 * x
    assert x * y / y is x
    assert (x + y) - y is x
    assert 2 * (3 * x) is 6 * x
    assert x / 4 is x * Fraction(1, 4)
    assert graph.sum([]).is_zero
    assert graph.product([]).is_one


def test_trigonometric_keys_and_signs(graph: Graph) -> None:
    x, y = graph.symbol("x"), graph.symbol("y")
    sin, cos = (lambda a: graph.trig("sin", a)), (lambda a: graph.trig("cos", a))
    assert sin(x - y) is -sin(y - x)
    assert cos(x - y) is cos(y - x)
    assert sin(x + y - x) is sin(y)
    assert sin((x + y) + x) is sin(2 * x + y)
    assert sin(x - x).is_zero
    assert cos(x - x).is_one
    assert sin(-x) is -sin(x)
    assert angle_form(2 * x - 3 * (y - x)) == {x: 5, y: -3}


def test_addition_theorem(graph: Graph) -> None:
    x, y, f = graph.symbol("x"), graph.symbol("y"), graph.symbol("f")
    (sx, cx), (sy, cy) = ((graph.trig("sin", a), graph.trig("cos", a)) for a in (x, y))
    assert (sx * sx + cx * cx).is_one
    assert cx * cy + sx * sy is graph.trig("cos", x - y)
    assert cx * cy - sx * sy is graph.trig("cos", x + y)
    assert sx * sy - cx * cy is -graph.trig("cos", x + y)
    assert sx * cy + cx * sy is graph.trig("sin", x + y)
    assert sx * cy - cx * sy is graph.trig("sin", x - y)
    assert cx * sy - sx * cy is graph.trig("sin", y - x)
    assert f * (sx * cy) + (f * cx) * sy is f * graph.trig("sin", x + y)
    assert f * sx * sx + cx * f * cx is f
    # coefficients that are sums, the same but for their sign
    m, tenth = graph.symbol("m"), graph.const(Fraction(1, 10))
    assert sx * cy * (-tenth - m) + cx * sy * (tenth + m) is (tenth + m) * graph.trig("sin", y - x)
    # other coefficients do not combine
    mixed = 2 * (cx * cy) + sx * sy
    assert mixed.op == "add"


def test_what_a_square_of_a_sine_leaves_of_1(graph: Graph) -> None:
    """Where the sine is nearly 1 the difference has no digit of the cosine; nothing else is a square."""
    x, y = graph.symbol("x"), graph.symbol("y")
    sine, cosine = graph.trig("sin", x), graph.trig("cos", x)
    assert graph.one - sine * sine is cosine * cosine
    assert graph.one - cosine * cosine is sine * sine
    assert sine * sine - graph.one is -(cosine * cosine)
    assert (3 * y - sine * (3 * y * sine)).op == "mul"
    for left, right in ((graph.one, sine), (2 * graph.one, sine * sine), (y, sine * sine), (graph.one, sine * cosine)):
        assert (left - right).op == "sub"
    assert (graph.one + sine * sine).op == "add"


def test_roots(graph: Graph) -> None:
    x = graph.symbol("x")
    assert graph.function("sqrt", (graph.const(Fraction(9, 4)),)).constant == Fraction(3, 2)
    assert graph.function("sqrt", (x * x,)) is graph.function("abs", (x,))
    assert graph.function("abs", (-x,)) is graph.function("abs", (x,))
    assert graph.power(x, Fraction(3)) is x * (x * x)


def test_cost_counts_shared_operations_once(graph: Graph) -> None:
    x, y = graph.symbol("x"), graph.symbol("y")
    shared = x * y
    counted = cost([shared + x, shared - y, shared / x, graph.trig("sin", x), graph.trig("cos", x)])
    assert (counted.additive, counted.multiplications, counted.divisions, counted.angles) == (2, 1, 0, 1)
    division = cost([graph.function("exp", (x,)) / (x + y)])
    assert (division.additive, division.divisions, division.functions) == (1, 1, 1)
    assert division.weight == 1 + 6 + 60


@pytest.mark.parametrize("bits", [3, 8192])
def test_outputs_are_counted_by_themselves(bits: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """What they share counts for each; an angle that is a sum counts as one, and its sum."""
    monkeypatch.setattr(traverse, "BITS", bits)
    graph = Graph()
    x, y, z = (graph.symbol(name) for name in "xyz")
    turned = graph.trig("sin", x + y) * z + graph.trig("cos", x + y)
    outputs = [turned, turned / (x - z), graph.function("exp", (turned * x,)), x, graph.const(2), -turned, x + y]
    assert weights_alone(outputs) == [cost([one]).weight for one in outputs] == [33, 40, 94, 0, 0, 33, 1]
    assert weights_alone([]) == []


def test_sums_of_known_angles_are_products(graph: Graph) -> None:
    x, y, z = (graph.symbol(name) for name in NAMES)
    outputs = [graph.trig("sin", a) for a in (x, y, x + y, x - y, x + y + z, 2 * x, z)]
    shared = share_angles(graph, outputs)
    assert cost(outputs).angles == 7
    assert cost(shared).angles == 3
    for before, after in zip(Evaluator(outputs)(POINT), Evaluator(shared)(POINT), strict=True):
        assert after == pytest.approx(before, abs=1e-15)


@pytest.mark.parametrize(("op", "slopes"), [("max", (0.0, 1.0)), ("min", (1.0, 0.0))])
def test_the_derivative_of_the_larger_and_the_smaller_is_that_of_the_one_taken(
    op: str, slopes: tuple[float, float]
) -> None:
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    derivatives = gradient(graph, graph.function(op, (x, y)), [x, y])
    assert tuple(Evaluator(derivatives)({"x": -3.0, "y": 2.0})) == slopes
    assert tuple(Evaluator(derivatives)({"x": 4.0, "y": 2.0})) == slopes[::-1]


def test_frozen_direction_stands_still(graph: Graph) -> None:
    x, y = graph.symbol("x"), graph.symbol("y")
    rate = graph.symbol("rate")
    assert derivative_along(graph, [x * y], {x: rate})[0] is rate * y
    assert derivative_along(graph, [y * y], {x: rate})[0].is_zero
    assert [d is w for d, w in zip(gradient(graph, x * y, [x, y, rate]), (y, x, graph.zero), strict=True)] == [True] * 3
