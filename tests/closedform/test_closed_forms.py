"""Closed forms of the shipped models and of small ones: style, values, structure, integrability, singular sets."""

from functools import cache
from pathlib import Path

import mpmath
import pytest
import sympy
from mpmath import mp
from shipped import NAMES
from sympy import Add, Matrix, Mul, Symbol, cos, simplify, sin

from symgen.closedform.algebra.substitution import substitute
from symgen.closedform.forms import ClosedForm, ClosedForms, derive_closed_forms
from symgen.closedform.points import RingPoint, generic_points
from symgen.closedform.spelling import spell_expression
from symgen.model.load import load_model, load_text
from symgen.model.model import Model
from symgen.model.published import PublishedMatrix

MODELS = Path(__file__).parents[2] / "models"


@cache
def shipped(name: str) -> tuple[Model, ClosedForms]:
    model = load_model(MODELS / f"{name}.yaml")
    return model, derive_closed_forms(model)


def derive(text: str) -> tuple[Model, ClosedForms]:
    model = load_text(text, "test.yaml")
    return model, derive_closed_forms(model)


def evaluate(form: ClosedForm, point: RingPoint) -> mpmath.matrix:
    """The printed matrix at a point, intermediates included."""
    assert form.matrix is not None
    values = {Symbol(name): sympy.Float(value, 50) for name, value in point.values.items()}
    for symbol, meaning in form.intermediates:
        values[symbol] = meaning.evalf(40, subs=values)
    numbers = [[mp.mpf(str(e.evalf(40, subs=values))) for e in row] for row in form.matrix.tolist()]
    return mpmath.matrix(numbers)


def rank_pseudoinverse(matrix: mpmath.matrix, rank: int) -> mpmath.matrix:
    """The Moore-Penrose inverse with a known rank."""
    wide = matrix.rows < matrix.cols
    u, s, v = mpmath.svd_r(matrix.T if wide else matrix)
    inverse = mpmath.matrix(v.cols, u.rows)
    for k in range(rank):
        inverse += v[k, :].T * u[:, k].T / s[k]
    return inverse.T if wide else inverse


def check_projections(model: Model, forms: ClosedForms) -> None:
    """N_B, M~ and M~^+ as printed against singular value decompositions at points of V, 40 digits."""
    mp.dps = 50
    mechanics, structure = forms.exact.mechanics, forms.structure
    for point in generic_points(model, mechanics, 2):
        expected = mpmath.eye(model.n)
        if model.constraints:
            jacobian = mpmath.matrix(point.matrix(mechanics.jacobian))
            inverse = rank_pseudoinverse(jacobian, structure.constraint_rank)
            expected -= inverse * jacobian
            if forms.forms["constraint_pseudoinverse"].matrix is not None:
                assert mpmath.norm(evaluate(forms.forms["constraint_pseudoinverse"], point) - inverse) < 1e-30
        assert mpmath.norm(evaluate(forms.forms["nullspace_projector"], point) - expected) < 1e-30
        if model.inputs:
            control = expected * mpmath.matrix(point.matrix(mechanics.control))
            assert mpmath.norm(evaluate(forms.forms["projected_control_matrix"], point) - control) < 1e-30
            inverse = rank_pseudoinverse(control, structure.degree_of_actuation)
            assert mpmath.norm(evaluate(forms.forms["projected_control_pseudoinverse"], point) - inverse) < 1e-28
            load = mpmath.matrix(point.matrix(forms.exact.load))
            assert mpmath.norm(evaluate(forms.forms["inverse_dynamics"], point) - inverse * load) < 1e-26


@pytest.mark.parametrize("name", NAMES)
def test_projections_of_the_shipped_models(name: str) -> None:
    check_projections(*shipped(name))


@pytest.mark.parametrize("name", NAMES)
def test_complement_and_skewness(name: str) -> None:
    model, forms = shipped(name)
    mechanics = forms.exact.mechanics
    for point in generic_points(model, mechanics, 1):
        if model.constraints and "orthogonal_complement" in forms.forms:
            jacobian = mpmath.matrix(point.matrix(mechanics.jacobian))
            assert mpmath.norm(jacobian * evaluate(forms.forms["orthogonal_complement"], point)) < 1e-30


@pytest.mark.parametrize(
    ("name", "equation"), [("front_car", "(43)"), ("front_car", "(44)"), ("skate", "(36)"), ("rear_car", "(47)")]
)
def test_the_papers_own_form_entry_for_entry(name: str, equation: str) -> None:
    model, forms = shipped(name)
    (item,) = (p for p in model.published if p.equation == equation and isinstance(p, PublishedMatrix))
    printed = Matrix([[spell_expression(substitute(e, dict(item.where))) for e in row] for row in item.value])
    assert forms.forms[item.quantity].matrix == printed.as_immutable()
    assert not forms.forms[item.quantity].intermediates


def is_product_of_sines(expression: sympy.Expr) -> bool:
    factors = Mul.make_args(expression)
    return all(f.is_Number or f.free_symbols <= {Symbol("l_1"), Symbol("l_2")} or f.func is sin for f in factors)


def test_curves_of_figure_6_are_products_of_sines() -> None:
    _, forms = shipped("rapkm_2rrr_rr")
    minors = dict(forms.forms["projected_control_pseudoinverse"].intermediates)
    b, psi = sympy.symbols("b_1:4"), [Symbol(f"a_{i}") + Symbol(f"b_{i}") for i in (1, 2, 3)]
    for (i, j), k in {(1, 2): 3, (1, 3): 2, (2, 3): 1}.items():
        meaning = minors[Symbol(f"Phi_{i}_{j}")]
        assert is_product_of_sines(meaning)
        expected = Symbol("l_2") ** 2 * sin(b[k - 1]) * sin(psi[i - 1] - psi[j - 1])
        assert meaning in (expected, -expected)
    assert minors[Symbol("Sigma_Delta")] == sum(Symbol(f"Phi_{i}") ** 2 for i in ("1_2", "1_3", "2_3"))


def test_actuation_determinants_are_the_curves_of_figure_6() -> None:
    model, forms = shipped("rapkm_2rrr_rr")
    assert [inputs for inputs, _ in forms.actuation_determinants] == [
        ("drive_1", "drive_2"),
        ("drive_1", "drive_3"),
        ("drive_2", "drive_3"),
    ]
    mp.dps = 50
    (point,) = generic_points(model, forms.exact.mechanics, 1)
    jacobian = mpmath.matrix(point.matrix(forms.exact.mechanics.jacobian))
    projector = mpmath.eye(6) - rank_pseudoinverse(jacobian, 4) * jacobian
    values = {Symbol(name): sympy.Float(value, 50) for name, value in point.values.items()}
    squares = point.polynomial(forms.exact.phi_squares)
    for (first, second), (_, delta) in zip(((0, 1), (0, 2), (1, 2)), forms.actuation_determinants, strict=True):
        minor = projector[first, first] * projector[second, second] - projector[first, second] ** 2
        assert is_product_of_sines(delta)
        assert abs(mp.mpf(str(delta.evalf(40, subs=values))) ** 2 / squares - minor) < 1e-30


def test_every_minor_of_the_manipulator_is_factored() -> None:
    _, forms = shipped("rapkm_2rrr_rr")
    for symbol, meaning in forms.forms["nullspace_projector"].intermediates:
        if symbol.name.startswith("Phi"):
            assert not isinstance(meaning, Add), symbol


def test_too_large_is_said_and_not_attempted() -> None:
    _, forms = shipped("rapkm_2rrr_rr")
    form = forms.forms["nullspace_projector_dot"]
    assert form.matrix is None
    assert "not written out" in form.note


def test_ten_times_the_kernel_is_the_limit() -> None:
    model = load_model(MODELS / "rapkm_two_drives.yaml")
    small = derive_closed_forms(model, {"nullspace_projector": 100}).forms["nullspace_projector"]
    assert "above ten times the 100 operations of the kernel" in small.note
    assert small.intermediates


STRUCTURES = {
    "skate": (3, 2, 2, "non-redundantly full-actuated"),
    "front_car": (4, 2, 2, "non-redundantly full-actuated"),
    "rapkm_2rrr_rr": (2, 2, 2, "redundantly full-actuated"),
    "slider_crank": (1, 1, 1, "non-redundantly full-actuated"),
    "double_pendulum": (2, 2, 2, "non-redundantly full-actuated"),
}


@pytest.mark.parametrize("name", sorted(STRUCTURES))
def test_degrees_of_freedom(name: str) -> None:
    structure = shipped(name)[1].structure
    numbers = (
        structure.local_freedom,
        structure.differential_freedom,
        structure.degree_of_actuation,
        structure.actuation,
    )
    assert numbers == STRUCTURES[name]


def test_singular_sets_of_the_rear_car() -> None:
    _, forms = shipped("rear_car")
    by_kind = {s.kind: s.vanishing for s in forms.singular_sets}
    assert by_kind["constraint"] == ()
    assert by_kind["input"] == (cos(Symbol("phi")),)
    assert by_kind["parameter"] == (cos(Symbol("phi")) * cos(Symbol("theta")),)


def test_singular_sets_of_what_is_measured_and_of_a_task() -> None:
    """A five-bar's task fails where a leg is stretched, its encoders where both distal links are in line."""
    _, forms = derive(
        """
model: five_bar
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, e: {unit: rad}}
kinetic_energy: (a_dot**2 + b_dot**2 + c_dot**2 + e_dot**2)/2
constraints:
  geometric:
    close_x: cos(a) + 2*cos(b) - 3 - cos(c) - 2*cos(e)
    close_y: sin(a) + 2*sin(b) - sin(c) - 2*sin(e)
measured: [a, c]
task: {x: cos(a) + 2*cos(b), y: sin(a) + 2*sin(b)}
configuration: {a: 2.2, b: 0.9, c: 1, e: 2.2}
"""
    )
    a, b, c, e = map(Symbol, "abce")
    by_kind = {s.kind: s for s in forms.singular_sets}
    (measured,), (task,) = by_kind["measured"].vanishing, by_kind["task"].vanishing
    assert by_kind["measured"].decided
    assert simplify(measured**2 - sin(b - e) ** 2) == 0
    assert simplify(task**2 - (sin(a - b) * sin(c - e)) ** 2) == 0


def test_a_task_that_leaves_directions_open_fails_where_it_loses_rank() -> None:
    _, forms = derive("model: m\ncoordinates: {x: {}, y: {}}\nkinetic_energy: x_dot**2 + y_dot**2\ntask: {area: x*y}\n")
    (lost,) = forms.singular_sets
    assert lost.kind == "open_task"
    assert set(lost.vanishing) == {Symbol("x"), Symbol("y")}


def test_beside_rows_an_open_task_fails_with_the_minors_of_both() -> None:
    """A bead on a circle and a second one on a line: their distance along the line."""
    _, forms = derive(
        """
model: beads
coordinates: {x: {}, y: {}, s: {}}
kinetic_energy: x_dot**2 + y_dot**2 + s_dot**2
constraints: {geometric: {circle: x**2 + y**2 - 1}}
task: {apart: (x - s)**2}
configuration: {x: 1, y: 0, s: 3}
"""
    )
    (lost,) = (s for s in forms.singular_sets if s.kind == "open_task")
    x, y, s = map(Symbol, "xys")
    places = [{x: 1, y: 0, s: 1}, {x: 0, y: 1, s: 0}, {x: 0, y: 1, s: 3}, {x: 1, y: 0, s: 3}]
    fails = [all(value.subs(place) == 0 for value in lost.vanishing) for place in places]
    assert fails == [True, True, False, False]


UNDERACTUATED = """
model: three_carts
coordinates: {x: {}, y: {}, z: {}, w: {}}
parameters: {m: 2, k: 3}
kinetic_energy: m/2*(x_dot**2 + y_dot**2 + z_dot**2 + w_dot**2)
potential_energy: k/2*(x - y)**2
constraints: {nonholonomic: {row: x*w_dot - z_dot}}
inputs:
  f: {acts_on: {x: 1, y: x}}
  g: {acts_on: {x: 2, y: 2*x}}
"""


def test_underactuated_with_a_control_matrix_of_rank_one() -> None:
    model, forms = derive(UNDERACTUATED)
    structure = forms.structure
    assert (structure.differential_freedom, structure.degree_of_actuation) == (3, 1)
    assert structure.actuation == "redundantly under-actuated"
    check_projections(model, forms)


def test_three_degrees_of_freedom_and_four_inputs() -> None:
    model, forms = derive(
        """
model: crowded
coordinates: {x: {}, y: {}, a: {unit: rad}, b: {unit: rad}}
kinetic_energy: (x_dot**2 + 2*y_dot**2 + a_dot**2 + 3*b_dot**2)/2
potential_energy: 0
constraints: {nonholonomic: {row: sin(a)*x_dot - cos(a)*y_dot + tan(b)*a_dot}}
inputs:
  f: {acts_on: {x: 1}}
  g: {acts_on: {y: 1, a: 1/(2 + x**2)}}
  h: {acts_on: {a: 1, b: cos(b)}}
  i: {acts_on: {b: 1}}
"""
    )
    assert (forms.structure.differential_freedom, forms.structure.degree_of_actuation) == (3, 3)
    check_projections(model, forms)


def test_dependent_constraints_use_all_choices_of_rows() -> None:
    model, forms = derive(
        """
model: three_cranks
coordinates: {x: {}, y: {}, p: {unit: rad}, q: {unit: rad}}
parameters: {l: 1}
kinetic_energy: (x_dot**2 + y_dot**2 + p_dot**2 + q_dot**2)/2
potential_energy: 0
constraints:
  geometric:
    first_x: x - l*cos(p)
    first_y: y - l*sin(p)
    second_x: x - l*cos(q)
    second_y: y - l*sin(q)
inputs: {f: {acts_on: {p: 1}}}
configuration: {x: 0.8, y: 0.6, p: 0.6435, q: 0.6435}
"""
    )
    assert forms.structure.constraint_rank in (3, 4)
    check_projections(model, forms)


INTEGRABLE = """
model: rows
coordinates: {x: {}, y: {}, z: {}, a: {unit: rad}}
kinetic_energy: (x_dot**2 + y_dot**2 + z_dot**2 + a_dot**2)/2
potential_energy: 0
constraints:
  nonholonomic:
"""


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ({"circle": "x*x_dot + y*y_dot"}, ["integrable"]),
        ({"edge": "sin(a)*x_dot - cos(a)*y_dot"}, ["not integrable"]),
        ({"scaled": "exp(x)*(x*x_dot + y*y_dot)"}, ["integrable"]),
        ({"lift": "z_dot - y*x_dot"}, ["not integrable"]),
        # alone not integrable, but y is constant
        ({"level": "y_dot", "lift": "z_dot - y*x_dot"}, ["integrable", "integrable"]),
        # on a circle y*dx is closed
        ({"lift": "z_dot - y*x_dot", "circle": "x*x_dot + y*y_dot"}, ["integrable", "integrable"]),
        ({"lift": "z_dot - y*x_dot", "turn": "a_dot - x*x_dot"}, ["not integrable", "integrable"]),
    ],
)
def test_integrable_rows_are_found(rows: dict[str, str], expected: list[str]) -> None:
    text = INTEGRABLE + "".join(f"    {name}: {row}\n" for name, row in rows.items())
    _, forms = derive(text)
    assert [row.verdict for row in forms.integrability] == expected


def test_the_order_of_hashes_does_not_matter() -> None:
    """Everything printed is a function of the model: a second derivation gives the same text."""
    model = load_model(MODELS / "front_car.yaml")
    first, second = derive_closed_forms(model), derive_closed_forms(model)
    assert str({k: (v.matrix, v.intermediates, v.note) for k, v in first.forms.items()}) == str(
        {k: (v.matrix, v.intermediates, v.note) for k, v in second.forms.items()}
    )


def test_symbols_are_named_as_in_the_model() -> None:
    _, forms = shipped("front_car")
    assert forms.symbol_table["theta_dot"] == r"\dot{\theta}"
    assert forms.symbol_table["m_1"] == "m_{1}"


def test_an_expression_of_mixed_parity_keeps_its_zeros() -> None:
    _, forms = derive(
        """
model: lever
coordinates: {a: {unit: rad}}
kinetic_energy: a_dot**2/2
potential_energy: 0
inputs: {f: {acts_on: {a: 1 + cos(a)}}}
"""
    )
    (singular_set,) = forms.singular_sets
    assert singular_set.vanishing == (cos(Symbol("a")) + 1,)
    assert (
        forms.forms["projected_control_pseudoinverse"].matrix == Matrix([[1 / (cos(Symbol("a")) + 1)]]).as_immutable()
    )


def chain(links: int) -> str:
    """A chain of links in relative angles: T expands to more terms than anyone wants to read."""
    size = range(1, links + 1)
    definitions = []
    for i in size:
        angle = " + ".join(f"q_{k}" for k in range(1, i + 1))
        rate = " + ".join(f"q_{k}_dot" for k in range(1, i + 1))
        before = (f"vx_{i - 1}", f"vy_{i - 1}") if i > 1 else ("0", "0")
        definitions += [f"w_{i}: {rate}", f"vx_{i}: {before[0]} - l_{i}*sin({angle})*w_{i}"]
        definitions += [f"vy_{i}: {before[1]} + l_{i}*cos({angle})*w_{i}"]
    energy = " + ".join(f"m_{i}/2*(vx_{i}**2 + vy_{i}**2)" for i in size)
    return "\n".join(
        [
            "model: chain",
            "coordinates: {" + ", ".join(f"q_{i}: {{unit: rad}}" for i in size) + "}",
            "parameters: {" + ", ".join(f"l_{i}: 0.3, m_{i}: 1" for i in size) + "}",
            "definitions:",
            *(f"  {definition}" for definition in definitions),
            f"kinetic_energy: {energy}",
            "potential_energy: 0",
            "inputs: {drive: {acts_on: {q_1: 1}}}",
        ]
    )


def test_a_long_chain_is_refused_by_counting_not_by_waiting() -> None:
    _, forms = derive(chain(9))
    assert forms.forms["coriolis_matrix"].matrix is None
    assert "products of terms" in forms.forms["coriolis_matrix"].note
    assert forms.forms["inverse_dynamics"].matrix is None
    assert forms.forms["projected_control_pseudoinverse"].matrix is not None
    assert forms.structure.differential_freedom == 9


def test_a_short_chain_is_written_in_absolute_angles() -> None:
    _, forms = derive(chain(3))
    matrix = forms.forms["mass_matrix"].matrix
    assert matrix is not None
    assert matrix[2, 2] == Symbol("l_3") ** 2 * Symbol("m_3")
    assert matrix[2, 0].atoms(sin, cos) == {cos(Symbol("q_3")), cos(Symbol("q_2") + Symbol("q_3"))}
