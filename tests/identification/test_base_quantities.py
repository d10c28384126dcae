"""The base regressor and the base parameters as quantities: against Y pi, the reference, the witness, and refusals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import shipped
from generated_python import load_generated
from machines import planar_four_bar
from numpy.typing import NDArray
from regressor_machines import FOUR_BAR, MACHINES
from sympy import lambdify

from symgen.backends.operations import count_operations
from symgen.closedform.forms import derive_closed_forms
from symgen.generation.results import Options, Result
from symgen.lowering.schedule import schedule
from symgen.mechanics.genericity import parameter_values
from symgen.methods.method import Candidate
from symgen.methods.selection import Methods
from symgen.model.asked_base import with_inertial_base
from symgen.model.expressions.walk import evaluate
from symgen.model.inertial_base import InertialBase
from symgen.model.inertial_parameters import inertial_parameters, values
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.pipeline import generate
from symgen.quantities.select import Selection, derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.verify.reference.reference import Reference, ReferenceValueError, State
from symgen.verify.sampling.states import sample_states
from symgen.witness.casadi_derivation import witness_functions

Array = NDArray[np.float64]
QUANTITIES = ("inverse_dynamics", "regressor", "base_regressor", "base_parameters")
BASE = QUANTITIES[2:]
NAMED = "outputs: [base_regressor, base_parameters]\n"
# Lengths that verification changes; one that is 0, one that follows from another; cosines that are no short fractions.
RANGED = (
    """
model: ranged
parameters:
  l: {value: 0.4, range: [0.3, 0.5]}
  e: {value: 0, range: [-0.1, 0.1]}
  h: {value: 2*l, range: [0.5, 1]}
  m_2: {value: 1.7, range: [1, 2]}
gravity: [0, 0, -9.81]
joints:
  base: {type: revolute, axis: z, coordinate: a}
  upper: {type: revolute, parent: base, at: [e, 0, l], axis: x, coordinate: b}
  hand: {type: revolute, parent: upper, at: [0, h, 0], axis: x, coordinate: c}
frames:
  tool: {parent: hand, translation: [0, 0.1, 0], rotation: [[x, 0.3]]}
bodies:
  base: {mass: 2, com: [0.1, 0.2, 0.3], inertia: {xx: 0.3, yy: 0.4, zz: 0.5}}
  upper: {mass: m_2, com: [0.01, h/2, 0], inertia: {xx: 0.1, yy: 0.2, zz: 0.15}}
  hand: {mass: 0.4, com: [0.02, 0.1, 0.1], inertia: {xx: 0.01, yy: 0.012, zz: 0.004}}
  tool: {mass: 0.3, com: [0, 0.03, 0.02], inertia: {xx: 0.001, yy: 0.002, zz: 0.002}}
inputs: {u_a: {joint: a}, u_b: {joint: b}, u_c: {joint: c}}
"""
    + NAMED
)
TEXTS = {**MACHINES, "ranged": RANGED}


@cache
def machine(name: str) -> Model:
    return with_inertial_base(load_text(TEXTS[name], f"{name}.yaml"), BASE)


@cache
def states(name: str) -> tuple[State, ...]:
    """Admissible ones, parameters within their ranges."""
    samples = sample_states(Reference(machine(name)), QUANTITIES[:2], 8, seed=4)
    return tuple(sample.state for sample in samples if sample.admissible)


@cache
def selection(name: str) -> Selection:
    return derive_quantities(machine(name), QUANTITIES)


def named(model: Model, state: State) -> dict[str, float]:
    """The numbers of a state by their names."""
    made = {p.name: float(x) for p, x in zip(model.parameters, state.parameters, strict=True)}
    for c, *numbers in zip(model.coordinates, state.q, state.qd, state.qdd, strict=True):
        made |= dict(zip((c.name, c.rate, c.acceleration), map(float, numbers), strict=True))
    return made


def evaluated(derived: Selection, at: Mapping[str, float]) -> dict[str, Array]:
    known = {**parameter_values(derived.mechanics), **at}
    return {one.name: np.array(Evaluator(one.outputs)(known)).reshape(one.shape) for one in derived.quantities}


@pytest.mark.parametrize("name", TEXTS)
def test_the_base_makes_up_for_all_parameters(name: str) -> None:
    """Y pi = Y_base beta on the constraints, lengths in their ranges."""
    model = machine(name)
    for state in states(name):
        at = named(model, state)
        made = evaluated(selection(name), at)
        pi = np.array(values(model.mechanism, lambda expression, at=at: evaluate(expression, at)))
        whole = made["regressor"] @ pi
        assert np.abs(made["base_regressor"] @ made["base_parameters"] - whole).max() < 1e-11 * np.abs(whole).max()


@pytest.mark.parametrize("name", TEXTS)
def test_kernels_are_the_reference_and_the_witness(name: str) -> None:
    model, exact = machine(name), Reference(machine(name))
    witness = witness_functions(model)["base_regressor"]
    for state in states(name)[:3]:
        made = evaluated(selection(name), named(model, state))
        for quantity in BASE:
            known = np.array([float(x) for x in exact.evaluate(state, [quantity])[quantity]])
            assert np.abs(made[quantity].reshape(-1) - known).max() < 1e-13 * np.abs(known).max()
        motion = [list(map(float, part)) for part in (state.q, state.qd, state.qdd, state.parameters)]
        size = np.abs(made["base_regressor"]).max()
        assert np.abs(witness(*motion).full() - made["base_regressor"]).max() < 1e-11 * size


def test_parameters_of_the_geometry_are_varied_one_by_one() -> None:
    """A length that is 0 in the file is in the forms, and one that follows from another has a value of its own."""
    model = machine("ranged")
    at = named(model, states("ranged")[0])
    before = evaluated(selection("ranged"), at)["base_parameters"]
    for name in ("e", "h", "l"):
        after = evaluated(selection("ranged"), {**at, name: at[name] + 0.01})["base_parameters"]
        # the height of the shoulder is of no effect
        assert (np.abs(after - before).max() > 1e-4) == (name != "l"), name


@pytest.mark.parametrize("name", ["four_bar", "rolling"])
def test_the_reference_sees_wrong_columns(name: str) -> None:
    """One column too few leaves something over; one too many, or one that follows from others, has no solution."""
    model, state = machine(name), states(name)[0]
    assert model.inertial_base is not None
    columns = model.inertial_base.columns
    others = [k for k in range(len(inertial_parameters(model.mechanism))) if k not in columns]
    for wrong in (columns[1:], columns[:-1], (*columns, others[0]), (*columns, others[-1])):
        seen = Reference(replace(model, inertial_base=InertialBase(wrong)))
        with pytest.raises(ReferenceValueError):
            seen.evaluate(state, ["base_parameters"])
    Reference(model).evaluate(state, ["base_parameters"])


def test_the_reference_has_the_same_at_every_state() -> None:
    """What q is does not matter, off the constraints neither."""
    model = machine("four_bar")
    shift = tuple(x + 1e-3 for x in states("four_bar")[0].q)
    known = [
        [float(x) for x in Reference(model).evaluate(state, ["base_parameters"])["base_parameters"]]
        for state in (*states("four_bar")[:2], replace(states("four_bar")[0], q=shift))
    ]
    assert np.ptp(known, axis=0).max() < 1e-15


PARALLELOGRAM = planar_four_bar("[0, -9.81, 0]", ("1", "0.4", "1", "0.4")).replace(
    "a: 1.1, b: -0.9, c: 1.3", "a: 1, b: -1, c: 1"
)
FIXED = PARALLELOGRAM.replace("[l_1, 0, 0]", "[0.4, 0, 0]").replace("[l_0, 0, 0]", "[1, 0, 0]").replace(
    "[l_2, 0, 0]", "[1, 0, 0]").replace("[l_3, 0, 0]", "[0.4, 0, 0]")  # fmt: skip


def test_a_special_geometry_has_parameters_where_it_is_made_of_numbers() -> None:
    """A parallelogram shows 3 combinations, other four-bars 8: run-time lengths may be those of either."""
    model = load_text(PARALLELOGRAM + NAMED, "parallelogram.yaml")
    (notice,) = (one for one in model.notices if "not made" in one.message)
    assert notice.message == (
        "`base_parameters` is not made: with the values of `l_0` .. `l_3` in the file 3 combinations of inertial "
        "parameters count, and 8 with others: write numbers in their place in frames, points, constraints and gravity"
    )
    assert notice.span is not None
    assert (PARALLELOGRAM + NAMED).splitlines()[notice.span.line - 1].startswith("outputs")
    derived = derive_quantities(model, BASE)
    assert {one.name: one.shape for one in derived.quantities} == {"base_regressor": (1, 3)}
    fixed = derive_quantities(load_text(FIXED + NAMED, "fixed.yaml"), BASE)
    assert {one.name: one.shape for one in fixed.quantities} == {"base_regressor": (1, 3), "base_parameters": (3,)}


def test_gravity_that_may_be_there_is_refused() -> None:
    text = planar_four_bar("[0, -g, 0]", ("1", "0.4", "0.9", "0.7"))
    text = text.replace("parameters:", "parameters:\n  g: {value: 0}") + NAMED
    derived = derive_quantities(load_text(text, "weightless.yaml"), BASE)
    assert "4 combinations of inertial parameters count, and 8 with others" in dict(derived.absent)["base_parameters"]


def test_a_length_without_a_short_form_is_refused_by_its_name() -> None:
    """The angle between the axes of two joints."""
    text = RANGED.replace("axis: x, coordinate: c", "rotation: [[y, tilt]], axis: x, coordinate: c")
    text = text.replace("m_2: {", "tilt: {value: 0.3}\n  m_2: {")
    derived = derive_quantities(load_text(text, "tilted.yaml"), BASE)
    why = dict(derived.absent)["base_parameters"]
    assert why.startswith("no short closed forms in `e`, `tilt`, `h` were found for its combinations: write numbers in")
    assert [one.name for one in derived.quantities] == ["base_regressor"]


def test_who_has_none() -> None:
    energies = derive_quantities(shipped.model("front_car"), BASE)
    assert dict(energies.absent) == dict.fromkeys(BASE, "the model has no bodies and no rotor inertias")
    inputs = "inputs: {u_a: {joint: a}, u_b: {joint: b}, u_c: {joint: c}}\n"
    asleep = load_text(RANGED.replace(inputs, ""), "asleep.yaml")
    assert dict(derive_quantities(asleep, BASE).absent) == {"base_regressor": "the model has no inputs"}
    still = "model: still\ncoordinates: {x: {}}\nbodies: {stand: {frame: world, mass: 2}}\n"
    with_energy = load_text(f"{still}kinetic_energy: x_dot**2/2\n{NAMED}", "still.yaml")
    assert dict(derive_quantities(with_energy, BASE).absent)["base_parameters"].startswith("no motion shows any")


def test_forms_are_looked_for_where_they_are_named() -> None:
    """The columns take the shorter time; named later, values are there."""
    model = load_text(RANGED.replace(NAMED, "outputs: [base_regressor]\n"), "ranged.yaml")
    base = model.inertial_base
    assert base is not None
    assert not base.values
    assert dict(derive_quantities(model, BASE).absent) == {"base_parameters": "it is made where `outputs` name it"}
    whole = with_inertial_base(model, BASE).inertial_base
    assert whole is not None
    assert len(whole.values) == len(whole.columns)
    assert whole.columns == base.columns


def test_all_leaves_them_to_those_who_name_them() -> None:
    made = {one.name for one in derive_quantities(machine("arm"), ["all"]).quantities}
    assert not made & {*BASE}
    assert machine("arm").inertial_base is not None
    assert load_text(MACHINES["arm"], "arm.yaml").inertial_base is None


@pytest.mark.parametrize("name", ["four_bar", "linkage", "arm"])
@pytest.mark.parametrize("quantity", ["regressor", "base_regressor"])
def test_elimination_has_the_columns_that_minors_have(name: str, quantity: str) -> None:
    model = machine(name)
    derived = selection(name)
    one = Methods(model, derived.generic).candidate(quantity, "elimination")
    assert isinstance(one, Candidate)
    known = parameter_values(one.system.mechanics)
    witness = witness_functions(model)[quantity]
    for state in states(name)[:3]:
        made = np.array(Evaluator(one.derived.outputs)({**known, **named(model, state)})).reshape(one.derived.shape)
        motion = [list(map(float, part)) for part in (state.q, state.qd, state.qdd, state.parameters)]
        assert np.abs(witness(*motion).full() - made).max() < 1e-11 * np.abs(made).max()


@pytest.mark.slow
@pytest.mark.parametrize(("name", "most"), [("arm7", 2.5), ("rapkm_bodies", 1.6), ("delta", 1.0)])
def test_operations_beside_those_of_u(name: str, most: float) -> None:
    model = with_inertial_base(shipped.model(name), BASE)
    derived = derive_quantities(model, ["inverse_dynamics", "base_regressor"])
    program = schedule(derived.mechanics, derived.quantities, ("float64",))["float64"]
    counts = {kernel.name: count_operations(kernel.statements).total for kernel in program.kernels}
    assert counts["base_regressor"] <= most * counts["inverse_dynamics"]


def test_closed_forms_are_the_kernels() -> None:
    model = with_inertial_base(replace(shipped.model("front_car_bodies"), outputs=BASE), BASE)
    forms, derived = derive_closed_forms(model).forms, derive_quantities(model, BASE)
    source = np.random.default_rng(2)
    names = [name for c in model.coordinates for name in (c.name, c.rate, c.acceleration)]
    at = parameter_values(derived.mechanics) | dict(zip(names, source.normal(size=len(names)), strict=True))
    made = evaluated(derived, at)
    for quantity in BASE:
        form = forms[quantity]
        assert form.matrix is not None
        symbols = sorted(form.matrix.free_symbols, key=str)
        printed = np.array(lambdify(symbols, form.matrix)(*(at[str(symbol)] for symbol in symbols)))
        own = made[quantity].reshape(printed.shape)
        assert np.abs(printed - own).max() < 1e-13 * np.abs(own).max()


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    """The redundant loop as its user makes it, verified."""
    folder = tmp_path_factory.mktemp("four_bar")
    path = folder / "four_bar.yaml"
    path.write_text(FOUR_BAR, encoding="utf-8")
    options = Options(outputs=QUANTITIES, parts=("c", "python"), states=16)
    result = generate(path, options, lambda _: None)
    for name, text in result.files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(str(text), encoding="utf-8")
    return folder, result


@pytest.mark.campaign
@pytest.mark.slow
def test_both_types_and_python_are_verified(run: tuple[Path, Result]) -> None:
    _, result = run
    assert not result.failures
    assert not result.left_out
    assert result.certificate is not None
    for quantity in BASE:
        targets = {one["target"] for one in result.certificate["errors"] if one["quantity"] == quantity}
        assert targets == {"C float64", "C float32", "Python float64"}


@pytest.mark.slow
def test_python_takes_arrays_and_says_which_columns(run: tuple[Path, Result]) -> None:
    folder, _ = run
    module = load_generated(folder / "python/four_bar.py")
    q, qd, qdd = (np.tile(x, (5, 1)) for x in ([1.1, -0.9, 1.3], [0.5, -0.2, 0.4], [1.0, 2.0, -3.0]))
    beta, columns = module.base_parameters(q), module.base_regressor(q, qd, qdd)
    assert columns.shape == (5, 2, beta.shape[1])
    described = " ".join(module.base_parameters.__doc__.split())
    names = described.split("in the order ")[1].split(": q (")[0].split(", ")
    stays = [module.INERTIAL_PARAMETERS.index(name) for name in names]
    assert np.allclose(module.regressor(q, qd, qdd)[..., stays], columns, rtol=1e-12, atol=1e-12)
    heavier = module.base_parameters(q[0], module.Parameters(l_1=0.5))
    assert np.abs(heavier - beta[0]).max() > 1e-2


def test_the_report_says_which_columns_stand_for_all() -> None:
    path = shipped.ROOT / "models/front_car_bodies.yaml"
    made = generate(path, Options(outputs=BASE, parts=("report",), verify=False), lambda _: None)
    text = str(made.files["report/front_car_bodies.html"])
    assert "chassis.m, chassis.my, chassis.Izz, wheels.mx, wheels.my, wheels.Izz, phi.Ir" in text
