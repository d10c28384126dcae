"""Only methods that divide by nothing that vanishes at a regular state are chosen, the same ones everywhere."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest
from shipped import NAMES, model

from symgen.mechanics.genericity import Genericity, genericity
from symgen.mechanics.never_zero import Definite
from symgen.mechanics.system import System
from symgen.methods.admission import validity_of
from symgen.methods.comparisons.printed import printed_candidate
from symgen.methods.method import INPUTS, Candidate
from symgen.methods.selection import Methods
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace
from symgen.runtime.effort import done
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.validity import search as search_module
from symgen.validity.precise import PreciseEvaluator, UndefinedError, precise, precision
from symgen.validity.proof import Proof
from symgen.validity.search import ZeroSearch

ROOT = Path(__file__).resolve().parents[2]


@cache
def generic(name: str) -> Genericity:
    return genericity(System(model(name)))


def fresh(name: str) -> MethodInput:
    return MethodInput.fresh(model(name), generic(name))


def measures(name: str) -> list[Scalar]:
    return Workspace(model(name), generic(name)).minor_measures


@pytest.mark.parametrize("drives", [(0, 1), (0, 2), (1, 2)])
def test_a_fixed_partition_of_the_rapkm_is_rejected(drives: tuple[int, int]) -> None:
    """Sampled states would not tell: it looks perfect on half of all batches of 64."""
    system = fresh("rapkm_2rrr_rr")
    made = printed_candidate(system, drives)
    assert isinstance(made, Candidate)
    # N_B is divided by B B^T only, the first pivots
    of_inputs = tuple(divisor for divisor in made.divisors if divisor.size > 10_000)
    assert len(of_inputs) >= 2
    validity = validity_of(replace(made, divisors=of_inputs), measures("rapkm_2rrr_rr"), first_only=True)
    assert not validity.admitted
    # at the state found (28)'s determinant has vanished while the ranks of B and M~ are beyond doubt
    third = ({0, 1, 2} - set(drives)).pop()
    state = dict(validity.singular[0].state)
    one, two = (f"{state[f'a_{k + 1}'] + state[f'b_{k + 1}']:.9f}" for k in drives)
    bent = abs(Evaluator([Graph().trig("sin", Graph().symbol("x"))])({"x": state[f"b_{third + 1}"]})[0])
    parallel = abs(Evaluator([Graph().trig("sin", Graph().symbol("x"))])({"x": float(one) - float(two)})[0])
    assert min(bent, parallel) < 1e-3


@pytest.mark.parametrize("name", [name for name in NAMES if model(name).inputs])
def test_the_method_chosen_is_admitted_and_the_cheapest_of_those(name: str) -> None:
    decision = Methods(model(name), generic(name)).choose(INPUTS)
    assert not isinstance(decision, str)
    chosen, choice = decision
    assert choice.validity.admitted
    assert choice.validity.searched == 0  # proofs are enough for the shipped models
    # the methods on whole matrices count more, so that leaving them out of the choice costs nothing
    methods = Methods(model(name), generic(name))
    for other in ("printed", "weighted", "kkt"):
        slow = methods.candidate(INPUTS, other)
        assert isinstance(slow, Candidate)
        assert slow.weight >= chosen.weight


def test_a_null_space_basis_of_the_rapkm_is_offered_with_its_singular_set() -> None:
    decision = Methods(model("rapkm_2rrr_rr"), generic("rapkm_2rrr_rr")).choose(INPUTS, "nullspace")
    assert not isinstance(decision, str)
    _, choice = decision
    assert not choice.validity.admitted
    assert choice.validity.explanation.startswith("this method is singular where")
    assert any("sin(" in entry.where_zero for entry in choice.validity.singular)


def test_a_method_that_does_not_apply_says_why() -> None:
    reason = Methods(model("double_pendulum"), generic("double_pendulum")).choose(INPUTS, "householder")
    assert reason == "there are no constraints"


def test_a_cheaper_method_with_a_pole_is_not_chosen() -> None:
    """A method that divides by cos(theta) besides is what sampling lets through; its cost would make it win."""
    methods = Methods(model("front_car"), generic("front_car"))
    made = methods.candidate(INPUTS, "nullspace")
    assert isinstance(made, Candidate)
    graph = made.system.mechanics.graph
    pole = graph.trig("cos", graph.symbol("theta"))
    spoiled = replace(made, divisors=(*made.divisors, pole))
    validity = methods.validity(spoiled)
    assert not validity.admitted
    assert validity.singular[0].where_zero == "cos(theta)"
    assert methods.validity(made).admitted


def test_rules_of_proof() -> None:
    system = fresh("rapkm_2rrr_rr")
    graph = system.mechanics.graph
    x, l1, x1 = graph.symbol("b_1"), graph.symbol("l_1"), graph.symbol("x_1")
    y = graph.symbol("b_2")
    sine, other = graph.trig("sin", x), graph.trig("sin", y)
    measure = graph.trig("sin", x - y) * graph.symbol("a_1")
    proof = Proof(system.definite, [p.name for p in model("rapkm_2rrr_rr").parameters], [measure])
    assert proof.shown(l1 * l1)
    assert not proof.shown(x1)  # its range holds 0
    assert not proof.shown(sine)
    assert proof.shown(-(l1 * measure) / 3)
    assert not proof.shown(x1 * measure)
    assert proof.shown(1 + sine * sine)
    assert proof.shown(sine * sine + other * other)  # both sines are 0, so is that of the difference
    assert not proof.shown(sine * sine + graph.trig("cos", y) * graph.trig("cos", y))


def test_intervals_hold_what_parameters_can_be() -> None:
    definite = Definite(System(model("rapkm_2rrr_rr")))
    m = definite.parameter
    assert definite.holds(m("l_1") + m("l_2"))
    assert not definite.holds(m("l_1") - m("l_2"))
    assert definite.holds(m("l_1") * m("l_1") + m("m_payload"))
    assert not definite.holds(m("a_1"))


def test_precise_slopes_agree_with_difference_quotients() -> None:
    graph = Graph()
    a, b = graph.symbol("a"), graph.symbol("b")
    root = graph.function("sqrt", (a * a + 2,))
    value = graph.trig("sin", a * 1 + b) * root / (b * b + 1) - graph.function("exp", (a,))
    evaluator = PreciseEvaluator([value])
    point = {"a": precise(Fraction(7, 10)), "b": precise(Fraction(-3, 10))}
    _, ((slope_a, slope_b),) = evaluator.gradients(point, ("a", "b"))
    step = precise(Fraction(1, 10**12))
    with precision():
        for name, slope in (("a", slope_a), ("b", slope_b)):
            ahead = evaluator.values({**point, name: point[name] + step})[0]
            behind = evaluator.values({**point, name: point[name] - step})[0]
            assert abs((ahead - behind) / (2 * step) - slope) < 1e-20


def test_what_has_no_value_is_undefined() -> None:
    graph = Graph()
    a = graph.symbol("a")
    for value in (graph.function("sqrt", (a,)), graph.function("log", (a,)), 1 / (a + 1)):
        with pytest.raises(UndefinedError):
            PreciseEvaluator([value]).values({"a": precise(-1.0)})


def test_the_search_ends_without_a_zero_where_there_is_none() -> None:
    system = fresh("front_car")
    graph = system.mechanics.graph
    positive = 2 + graph.trig("cos", graph.symbol("theta"))
    search = ZeroSearch(system.mechanics, system.generic)
    assert search.zero_of(positive) is None
    zero = search.zero_of(1 + graph.trig("cos", graph.symbol("theta")))
    assert zero is not None
    assert abs(float(dict(zero.point)["theta"]) % 6.283185307179586 - 3.141592653589793) < 1e-5


def test_ways_that_come_no_closer_are_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    system = fresh("rapkm_2rrr_rr")
    graph = system.mechanics.graph
    angle = graph.trig("cos", graph.symbol(system.mechanics.model.coordinates[0].name))

    def work(scalar: Scalar) -> tuple[bool, int]:
        before = done()
        zero = ZeroSearch(system.mechanics, system.generic).zero_of(scalar)
        return zero is not None, done() - before

    hopeless, far = 2 + angle, work(2 + angle)
    monkeypatch.setattr(search_module, "STALLED_STEPS", search_module.SEARCH_STEPS)
    assert far[0] is work(hopeless)[0] is False
    assert far[1] < 0.6 * work(hopeless)[1]


SCRIPT = """
from pathlib import Path
from symgen.mechanics.genericity import genericity
from symgen.methods.selection import Methods
from symgen.mechanics.system import System
from symgen.model.load import load_model
for name in ("front_car", "rapkm_2rrr_rr", "slider_crank"):
    model = load_model(Path("models") / (name + ".yaml"))
    methods = Methods(model, genericity(System(model)))
    print(methods.choose("inverse_dynamics")[1])
    print(methods.choose("inverse_dynamics", "nullspace")[1])
"""


@pytest.mark.slow
def test_choice_and_singular_states_do_not_depend_on_the_hash_seed() -> None:
    def printed(seed: str) -> str:
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)}
        command = [sys.executable, "-c", SCRIPT]
        return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True).stdout

    first = printed("0")
    assert "singular where" in first
    assert printed("20120731") == first
