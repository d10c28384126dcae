"""The regressor as a quantity: against u of kernels and reference, of changed machines, and against base parameters."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import shipped
from generated_python import load_generated
from numpy.typing import NDArray
from regressor_machines import FOUR_BAR, MACHINES
from sympy import lambdify

from symgen.closedform.forms import derive_closed_forms
from symgen.generation.results import Options, Result
from symgen.mechanics.genericity import parameter_values
from symgen.mechanics.system import System
from symgen.methods.quantity import scalars
from symgen.model.combinations.base_parameters import base_parameters
from symgen.model.expressions.expression import Binary, Expression, Name, Negation, Number
from symgen.model.expressions.walk import evaluate
from symgen.model.inertial_parameters import inertial_parameters, values
from symgen.model.load import load_text
from symgen.model.mechanism import INERTIA_ELEMENTS, Body, Inertia
from symgen.model.model import Model
from symgen.pipeline import generate
from symgen.quantities.select import Selection, derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.traverse import reached
from symgen.verify.reference.arithmetic.linear import column, norm
from symgen.verify.reference.arithmetic.tape import ball, precision
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.states import sample_states
from symgen.witness.casadi_derivation import witness_functions

Array = NDArray[np.float64]
BOTH = ("inverse_dynamics", "regressor")
STATES = 8
BITS = 256
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")


@cache
def machine(name: str) -> Model:
    return load_text(MACHINES[name], f"{name}.yaml")


@cache
def reference(name: str) -> Reference:
    return Reference(machine(name))


@cache
def states(name: str) -> tuple[State, ...]:
    """On the constraints and beside them, parameters within their ranges."""
    samples = sample_states(reference(name), BOTH, STATES, seed=4)
    return tuple(sample.state for sample in samples)


@cache
def selection(name: str) -> Selection:
    return derive_quantities(machine(name), BOTH)


def inertial_values(model: Model, given: Mapping[str, float]) -> Array:
    """pi, as the file has it with these parameters."""
    return np.array(values(model.mechanism, lambda expression: evaluate(expression, given)))


def named(model: Model, state: State) -> dict[str, float]:
    """The numbers of a state by their names."""
    made = {p.name: float(x) for p, x in zip(model.parameters, state.parameters, strict=True)}
    for c, *numbers in zip(model.coordinates, state.q, state.qd, state.qdd, strict=True):
        made |= dict(zip((c.name, c.rate, c.acceleration), map(float, numbers), strict=True))
    return made


@pytest.mark.parametrize("name", MACHINES)
def test_u_is_the_regressor_times_the_parameters(name: str) -> None:
    """u comes of Newton and Euler's recursion and of a method of its own."""
    model, derived = machine(name), selection(name)
    known = parameter_values(derived.mechanics)
    for state in states(name):
        at = named(model, state)
        by_name = {
            one.name: np.array(Evaluator(one.outputs)({**known, **at})).reshape(one.shape) for one in derived.quantities
        }
        u = by_name["inverse_dynamics"]
        assert np.abs(by_name["regressor"] @ inertial_values(model, at) - u).max() < 1e-11 * np.abs(u).max()


@pytest.mark.parametrize("name", MACHINES)
def test_the_kernel_is_the_reference_and_the_witness(name: str) -> None:
    model, derived = machine(name), selection(name)
    known = parameter_values(derived.mechanics)
    (regressor,) = (one for one in derived.quantities if one.name == "regressor")
    kernel, witness = Evaluator(regressor.outputs), witness_functions(model)["regressor"]
    for state in states(name)[:3]:
        exact = np.array([float(x) for x in reference(name).evaluate(state, ["regressor"])["regressor"]])
        exact = exact.reshape(regressor.shape)
        own = np.array(kernel({**known, **named(model, state)})).reshape(regressor.shape)
        motion = [list(map(float, part)) for part in (state.q, state.qd, state.qdd, state.parameters)]
        assert np.abs(own - exact).max() < 1e-12 * np.abs(exact).max()
        assert np.abs(witness(*motion).full() - exact).max() < 1e-11 * np.abs(exact).max()


CHANGE = Fraction(3, 7)


def changed_bodies(body: Body) -> dict[str, Body]:
    """A body with one number of the file changed, by what is changed."""

    def more(expression: Expression) -> Expression:
        return Binary("+", expression, Number(CHANGE))

    x, y, z = body.com
    made = {
        "mass": replace(body, mass=more(body.mass)),
        "x": replace(body, com=(more(x), y, z)),
        "y": replace(body, com=(x, more(y), z)),
        "z": replace(body, com=(x, y, more(z))),
    }
    for element in INERTIA_ELEMENTS:
        inertia = {one: getattr(body.inertia, one) for one in INERTIA_ELEMENTS}
        made[element] = replace(body, inertia=Inertia(**{**inertia, element: more(inertia[element])}))
    return made


def exact_values(model: Model, state: State) -> list[Fraction]:
    """pi, exactly."""
    known = {p.name: Fraction(x) for p, x in zip(model.parameters, state.parameters, strict=True)}

    def value(expression: Expression) -> Fraction:
        match expression:
            case Number(number):
                return number
            case Name(name):
                return known[name]
            case Binary("+", left, right):
                return value(left) + value(right)
            case Binary("*", left, right):
                return value(left) * value(right)
            case Negation(operand):
                return -value(operand)
        raise AssertionError(expression)

    return [Fraction(x) for x in values(model.mechanism, value)]  # type: ignore[arg-type]


@pytest.mark.parametrize(("name", "changing"), [("arm", "upper"), ("four_bar", "coupler"), ("rolling", "rod")])
def test_a_changed_body_changes_u_by_its_columns_to_fifty_digits(name: str, changing: str) -> None:
    """The reference of u has bodies with mass, centre and tensor, that of the regressor has point masses."""
    model, exact, state = machine(name), reference(name), states(name)[1]
    before, columns = (exact.precise(state, [quantity])[quantity] for quantity in BOTH)
    body = next(one for one in model.mechanism.bodies if one.name == changing)
    for what, other in changed_bodies(body).items():
        bodies = tuple(other if one is body else one for one in model.mechanism.bodies)
        heavier = replace(model, mechanism=replace(model.mechanism, bodies=bodies))
        after = Reference(heavier, exact.ranks).precise(state, ["inverse_dynamics"])["inverse_dynamics"]
        given = zip(exact_values(heavier, state), exact_values(model, state), strict=True)
        with precision(BITS):
            step = column([ball(one - other) for one, other in given])
            assert any(step.entries()), what
            assert norm(after - before - columns * step) < 1e-48 * norm(before), what


def test_a_rotor_is_a_column_of_its_own() -> None:
    model, exact, state = machine("four_bar"), reference("four_bar"), states("four_bar")[1]
    (rotor,) = model.mechanism.rotor_inertias
    heavy = replace(rotor, inertia=Binary("+", rotor.inertia, Number(CHANGE)))
    heavier = replace(model, mechanism=replace(model.mechanism, rotor_inertias=(heavy,)))
    before, columns = (exact.precise(state, [quantity])[quantity] for quantity in BOTH)
    after = Reference(heavier, exact.ranks).precise(state, ["inverse_dynamics"])["inverse_dynamics"]
    last = len(inertial_parameters(model.mechanism)) - 1
    with precision(BITS):
        of_rotor = column([columns[i, last] for i in range(model.m)])
        assert norm(of_rotor) > 1e-3
        assert norm(after - before - of_rotor * ball(CHANGE)) < 1e-48 * norm(before)


@pytest.mark.parametrize("name", ["four_bar", "rolling"])
def test_as_many_columns_count_as_base_parameters(name: str) -> None:
    """And those without an effect are zero at every admissible motion."""
    model, exact = machine(name), reference(name)
    shown = base_parameters(model)
    samples = sample_states(exact, BOTH, 60, seed=9)
    admissible = [one.state for one in samples if one.admissible]
    rows = [np.array([float(x) for x in exact.evaluate(one, ["regressor"])["regressor"]]) for one in admissible]
    stacked = np.vstack([row.reshape(model.m, -1) for row in rows])
    sizes = np.linalg.norm(stacked, axis=0)
    names = [one.name for one in inertial_parameters(model.mechanism)]
    idle = {one for one, size in zip(names, sizes, strict=True) if size < 1e-12}
    assert idle == {one.name for one in shown.without_effect}
    counting = stacked[:, sizes > 1e-12] / sizes[sizes > 1e-12]
    spread = np.linalg.svd(counting, compute_uv=False)
    spread = spread[spread > 1e-9 * spread[0]]
    assert len(spread) == len(shown.base)


def test_it_holds_no_inertial_parameter() -> None:
    """Only the geometry of the arm, and gravity."""
    (regressor,) = (one for one in selection("arm").quantities if one.name == "regressor")
    parameters = {p.name for p in machine("arm").parameters}
    assert {str(x.payload) for x in reached(scalars(regressor)) if x.op == "symbol"} & parameters == {"l", "g"}


def test_columns_out_of_the_plane_are_zero_and_cost_nothing() -> None:
    """Of a machine in the plane x-y: its kernel is that of four columns a body."""
    derived = selection("four_bar")
    (regressor,) = (one for one in derived.quantities if one.name == "regressor")
    rows, columns = regressor.shape
    zero = {
        one.name
        for k, one in enumerate(inertial_parameters(machine("four_bar").mechanism))
        if all(regressor.outputs[i * columns + k].is_zero for i in range(rows))
    }
    outside = {"mz", "Ixx", "Iyy", "Ixy", "Ixz", "Iyz"}
    # the crank and the rocker turn about fixed places
    wanted = {f"{body}.{element}" for body in ("crank", "coupler", "rocker") for element in outside}
    assert zero == wanted | {"crank.m", "rocker.m"}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    """The redundant loop as its user makes it, verified."""
    folder = tmp_path_factory.mktemp("four_bar")
    path = folder / "four_bar.yaml"
    path.write_text(FOUR_BAR, encoding="utf-8")
    result = generate(path, Options(parts=("c", "python"), states=16), lambda _: None)
    for name, text in result.files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(str(text), encoding="utf-8")
    return folder, result


@pytest.mark.slow
def test_both_types_and_python_are_verified(run: tuple[Path, Result]) -> None:
    _, result = run
    assert not result.failures
    assert not result.left_out
    assert result.certificate is not None
    targets = {one["target"] for one in result.certificate["errors"] if one["quantity"] == "regressor"}
    assert targets == {"C float64", "C float32", "Python float64"}


@pytest.mark.slow
def test_a_program_asks_the_header_for_columns(
    run: tuple[Path, Result], tool: Callable[[str], str], tmp_path: Path
) -> None:
    """With both headers; and the module in Python has the same names, and the same numbers."""
    folder, _ = run
    program = """
#include "four_bar_f.h"
#include "four_bar.h"
#include <stdio.h>
int main(void) {
    const double q[3] = {1.1, -0.9, 1.3}, qd[3] = {0.5, -0.2, 0.4}, qdd[3] = {1.0, 2.0, -3.0};
    const four_bar_params p = four_bar_default_params();
    double Y[FOUR_BAR_SIZE_U * FOUR_BAR_SIZE_PI];
    if (four_bar_regressor(q, qd, qdd, &p, Y) != FOUR_BAR_OK) return 1;
    printf("%d %d %.17g\\n", FOUR_BAR_SIZE_PI, FOUR_BAR_PI_C_IR, Y[FOUR_BAR_SIZE_PI + FOUR_BAR_PI_COUPLER_MX]);
    return 0;
}
"""
    (tmp_path / "main.c").write_text(program)
    sources = [tmp_path / "main.c", folder / "c/four_bar.c"]
    command = [tool("gcc"), "-std=c99", *STRICT, f"-I{folder / 'c'}", "-o", tmp_path / "main", *sources, "-lm"]
    subprocess.run(command, check=True)
    size, last, entry = subprocess.run([tmp_path / "main"], check=True, capture_output=True, text=True).stdout.split()
    module = load_generated(folder / "python/four_bar.py")
    names = [one.name for one in inertial_parameters(machine("four_bar").mechanism)]
    assert list(module.INERTIAL_PARAMETERS) == names
    assert (int(size), int(last)) == (len(names), names.index("c.Ir"))
    made = module.regressor([1.1, -0.9, 1.3], [0.5, -0.2, 0.4], [1.0, 2.0, -3.0])
    assert made.shape == (2, len(names))
    assert float(entry) == made[1, names.index("coupler.mx")]


@pytest.mark.slow
def test_it_is_refused_where_u_is(run: tuple[Path, Result]) -> None:
    """All bars in one line: the rows lose rank."""
    folder, _ = run
    module = load_generated(folder / "python/four_bar.py")
    flat = module.Parameters(l_0=0.6, l_1=0.4, l_2=0.9, l_3=0.7)
    for quantity in BOTH:
        with pytest.raises(module.StateError) as refused:
            getattr(module, quantity)([0.0, 0.0, 0.0], [0.1, 0.2, 0.3], [1.0, 2.0, 3.0], flat)
        assert refused.value.status.name == "CONSTRAINT_RANK"


def test_its_closed_form_is_the_kernel() -> None:
    """The car's, by SymPy from energies that are linear in the parameters."""
    model = replace(shipped.model("front_car_bodies"), outputs=("regressor",))
    form = derive_closed_forms(model).forms["regressor"]
    assert form.matrix is not None
    (derived,) = derive_quantities(model, ["regressor"]).quantities
    source = np.random.default_rng(2)
    names = [name for c in model.coordinates for name in (c.name, c.rate, c.acceleration)]
    at = {"L": 2.3, **dict(zip(names, source.normal(size=len(names)), strict=True))}
    symbols = sorted(form.matrix.free_symbols, key=str)
    printed = lambdify(symbols, form.matrix)(*(at[str(symbol)] for symbol in symbols))
    known = parameter_values(System(model)) | at
    kernel = np.array(Evaluator(derived.outputs)(known)).reshape(derived.shape)
    assert np.abs(printed - kernel).max() < 1e-13 * np.abs(kernel).max()
    assert np.abs(kernel[:, -1]).max() == pytest.approx(abs(at["phi_ddot"]))


def test_a_long_closed_form_is_left_to_its_formula() -> None:
    model = replace(shipped.model("rapkm_bodies"), outputs=("regressor",))
    form = derive_closed_forms(model).forms["regressor"]
    assert form.matrix is None
    assert form.note.endswith("; the pseudoinverse of N_B M times the columns of tau")


def test_the_report_says_what_columns_are() -> None:
    made = generate(
        shipped.ROOT / "models/front_car_bodies.yaml",
        Options(outputs=BOTH, parts=("report",), verify=False),
        lambda _: None,
    )
    text = str(made.files["report/front_car_bodies.html"])
    assert "m, mx, my, mz, Ixx, Iyy, Izz, Ixy, Ixz, Iyz of chassis, of wheels; Ir of phi" in text


def test_all_leaves_it_to_those_who_name_it() -> None:
    assert "regressor" not in {one.name for one in derive_quantities(machine("arm"), ["all"]).quantities}
    assert "regressor" in {one.name for one in derive_quantities(machine("arm"), ["all", "regressor"]).quantities}


def test_a_model_of_energies_has_none() -> None:
    derived = derive_quantities(shipped.model("front_car"), BOTH)
    assert dict(derived.absent) == {"regressor": "the model has no bodies and no rotor inertias"}


def test_allocation_does_not_change_it() -> None:
    """It is M~+ of the columns however inputs share the work, and says so."""
    text = FOUR_BAR + "\nallocation: {weights: {u: 1, w: 3}}\n"
    shared = derive_quantities(load_text(text, "shared.yaml"), BOTH)
    (one,) = (one for one in shared.quantities if one.name == "regressor")
    (plain,) = (one for one in selection("four_bar").quantities if one.name == "regressor")
    at = parameter_values(shared.mechanics) | named(machine("four_bar"), states("four_bar")[0])
    assert Evaluator(one.outputs)(at) == pytest.approx(Evaluator(plain.outputs)(at), rel=1e-12)
    assert one.remark.startswith("the least whatever `allocation` says; columns m, mx, my, mz, Ixx")
    assert one.remark.endswith("of crank, of coupler, of rocker; Ir of c")
