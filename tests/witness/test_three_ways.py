"""CasADi, SymPy and the kernels of the scalar graph derive the same quantities: they witness each other."""

from __future__ import annotations

from typing import Any

import casadi
import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray
from shipped import NAMES, ROOT
from sympy import lambdify
from witness_models import EXTRA

from symgen.closedform.forms import ClosedForm, ClosedForms, derive_closed_forms
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Status
from symgen.lowering.schedule import schedule
from symgen.model.load import load_model, load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities, requested
from symgen.witness.casadi_derivation import witness_functions
from symgen.witness.configurations import configurations
from symgen.witness.lagrange import differentiate
from symgen.witness.translate import default_parameters

SHIPPED = {name: ROOT / "models" / f"{name}.yaml" for name in NAMES}
ALL_THREE = {
    "mass_matrix",
    "coriolis_matrix",
    "constraint_jacobian",
    "nullspace_projector",
    "nullspace_projector_dot",
    "projected_control_pseudoinverse",
    "inverse_dynamics",
}
# A loop, rows of rates, inputs that fall short, a task that leaves directions open.
FEW = ("slider_crank", "skate", "ruler", "under_actuated")
STATES = 2
TOLERANCE = 1e-9
REGULAR = 1e-3  # of both measures of `singularity`: rounding is not what these tests are about
State = dict[str, NDArray[np.float64]]


def _task(model: Model, state: State) -> State:
    """Where the task is a moment later, along rates as they are."""
    if not model.task:
        return {}
    lagrange, moved = differentiate(model), state["q"] + 1e-3 * state["qd"]
    aim = casadi.Function("aim", [lagrange.q, lagrange.p], [lagrange.task])(moved, state["p"])
    places = [k % model.n for k in range(len(model.task))]
    return {"x_t": aim.full().ravel(), "xd_t": state["qd"][places], "xdd_t": state["qdd"][places]}


def states(model: Model, singularity: Any) -> list[State]:
    """Regular configurations with arbitrary rates, at the default parameters and at others within their ranges."""
    generator = np.random.default_rng(11)
    lagrange, default = differentiate(model), default_parameters(model).full().ravel()
    regular_states: list[State] = []
    for k in range(STATES):
        p = default.copy()
        for i, parameter in enumerate(model.parameters):
            if k and parameter.range is not None:
                low, high = (float(bound) for bound in parameter.range)
                p[i] += 0.2 * generator.uniform(low - p[i], high - p[i])
        candidates = configurations(model, lagrange, p, seed=k, trials=40)
        q = next(q for q in candidates if np.min(singularity(q, p).full()) > REGULAR)
        rates = {name: generator.normal(size=model.n) for name in ("qd", "qdd")}
        state = {"q": q, **rates, "u": generator.normal(size=model.m), "p": p}
        places = list(model.measured_places)
        moved = q[places] + generator.uniform(-1e-3, 1e-3, len(places))
        measured = {"q_m": moved, "qd_m": state["qd"][places], "qdd_m": state["qdd"][places]}
        given = {"w_u": state["u"], "w_qdd": state["qdd"], "v_x": generator.normal(size=3 * model.n)}
        regular_states.append(state | measured | _task(model, state) | given)
    return regular_states


class SympyWitness:
    """The printed closed forms, named intermediates included, evaluated at 50 digits."""

    def __init__(self, model: Model, closed: ClosedForms) -> None:
        self.forms: dict[str, ClosedForm] = {
            name: form for name, form in closed.forms.items() if form.matrix is not None
        }
        self.compiled: dict[Any, Any] = {}
        coordinates = model.coordinates
        self.names = {
            "q": [c.name for c in coordinates],
            "qd": [c.rate for c in coordinates],
            "qdd": [c.acceleration for c in coordinates],
            "p": [parameter.name for parameter in model.parameters],
        }
        self.known = {name for names in self.names.values() for name in names}

    def has(self, quantity: str) -> bool:
        return quantity in self.forms or (quantity == "nullspace_projector_dot" and "nullspace_projector" in self.forms)

    def __call__(self, quantity: str, state: State) -> NDArray[np.float64]:
        with mpmath.workdps(50):
            values = {
                name: mpmath.mpf(float(value))
                for argument, names in self.names.items()
                for name, value in zip(names, state[argument], strict=True)
            }
            if quantity in self.forms:
                return self._numbers(self._evaluate(quantity, values))
            return self._numbers(self._projector_rate(values))

    def _evaluate(self, quantity: str, values: dict[str, Any]) -> Any:
        form, values = self.forms[quantity], dict(values)
        for symbol, meaning in form.intermediates:
            values[symbol.name] = self._value(meaning, values)
        assert form.matrix is not None
        return mpmath.matrix(self._value(form.matrix, values))

    def _value(self, expression: Any, values: dict[str, Any]) -> Any:
        symbols = sorted(expression.free_symbols, key=lambda symbol: symbol.name)
        if expression not in self.compiled:
            self.compiled[expression] = lambdify(symbols, expression, modules="mpmath", docstring_limit=0)
        return self.compiled[expression](*(values[symbol.name] for symbol in symbols))

    def _projector_rate(self, values: dict[str, Any]) -> Any:
        """Where Ṅ is too long to print: the closed form of N, differentiated along q̇ at 50 digits."""
        step = mpmath.mpf(10) ** -15

        def moved(sign: int) -> Any:
            pairs = zip(self.names["q"], self.names["qd"], strict=True)
            return self._evaluate(
                "nullspace_projector", values | {q: values[q] + sign * step * values[v] for q, v in pairs}
            )

        return (moved(1) - moved(-1)) / (2 * step)

    def _numbers(self, matrix: Any) -> NDArray[np.float64]:
        return np.array([[float(entry) for entry in row] for row in matrix.tolist()])


@pytest.mark.parametrize(
    "name", [name if name in FEW else pytest.param(name, marks=pytest.mark.campaign) for name in (*SHIPPED, *EXTRA)]
)
def test_three_derivations_agree(name: str) -> None:
    model = load_model(SHIPPED[name]) if name in SHIPPED else load_text(EXTRA[name], name)
    witness = witness_functions(model)
    sympy = SympyWitness(model, derive_closed_forms(model))
    # by name: of `all` together the longest are left out
    derivations = derive_quantities(model, tuple(witness))
    present, _ = requested(model, derivations.generic, ("all",))
    assert set(present) <= set(witness)
    program = schedule(derivations.mechanics, derivations.quantities, ("float64",))["float64"]
    interpreter = Interpreter(program.sincos)
    kernels = {kernel.name: kernel for kernel in program.kernels}

    assert set(kernels) == set(witness)
    if name in SHIPPED:  # SymPy need not write out what a mechanism with dependent constraints would take
        assert {quantity for quantity in witness if quantity in ALL_THREE and not sympy.has(quantity)} == set()
    for state in states(model, witness["singularity"]):
        load = float(np.linalg.norm(witness["mass_matrix"](state["q"], state["p"]).full() @ state["qdd"]))
        for quantity, function in witness.items():
            arguments = [argument for argument in function.name_in() if argument != "p"]
            expected = function(*(state[argument] for argument in [*arguments, "p"])).full()
            given = {argument: list(state[argument]) for argument in arguments}
            status, entries = interpreter.run(kernels[quantity], given, list(state["p"]))
            assert status is Status.OK, quantity
            others = {"kernel": np.array(entries).reshape(expected.shape)}
            if sympy.has(quantity):
                others["SymPy"] = sympy(quantity, state).reshape(expected.shape)
            size = float(np.linalg.norm(expected)) + (load if quantity == "inverse_dynamics_residual" else 0.0)
            for other, value in others.items():
                error = float(np.linalg.norm(value - expected))
                assert error <= TOLERANCE * size + 1e-12, f"{other} differs from CasADi in {quantity} by {error:.1e}"
