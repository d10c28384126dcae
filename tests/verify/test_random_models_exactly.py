"""Every quantity of random models with every operation and odd constants is the reference's, in exact arithmetic."""

from __future__ import annotations

import random

import pytest

from symgen.lowering.schedule import schedule
from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities
from symgen.verify.exactness import ExactStates
from symgen.verify.expected import Expected

# constants of which angles, roots and multiples of pi are known in part only
NUMBERS = ("6/pi", "pi**2", "sqrt(pi)", "pi/7", "1e-31", "sqrt(2)", "atan2(1, 3)", "cos(pi/5)", "22/7", "0.1", "1.7")


def expression(dice: random.Random, names: list[str], depth: int) -> str:
    """A value that is defined everywhere, as text."""
    if depth == 0 or dice.random() < 0.15:
        return dice.choice(names) if dice.random() < 0.75 else f"({dice.choice(NUMBERS)})"
    one, other = (expression(dice, names, depth - 1) for _ in range(2))
    return dice.choice(
        (
            f"({one} {dice.choice('+-')} {other})",
            f"({one})*({other})",
            f"({one})/(2 + cos({other}))",
            f"{dice.choice(('sin', 'cos', 'atan', 'tanh'))}({one})",
            f"sqrt(1 + ({one})**2)",
            f"atan2({one}, 2 + sin({other}))",
            f"{dice.choice(('asin', 'acos'))}(0.7*sin({one}))",
            f"log(2 + sin({one}))",
            f"exp(-({one})**2/9)",
            f"(2 + sin({one}))**({dice.choice(('1/3', '-1/2', '5/3'))})",
        )
    )


def random_model(seed: int) -> str:
    """Two or three coordinates, a row that can be closed, inputs and forces that depend on everything."""
    dice = random.Random(seed)
    q = [f"q_{k}" for k in range(dice.randint(2, 3))]
    names = [*q, "p", "k", "d"]
    energy = [f"(1.5 + ({expression(dice, names, 2)})**2)*{x}_dot**2" for x in q]
    coupling = f"cos({expression(dice, names, 2)})*q_0_dot*q_1_dot/2"
    return f"""
model: random_{seed}
coordinates: {{{", ".join(f"{x}: {{}}" for x in q)}}}
parameters:
  p: {{value: 0.7, range: [0.4, 1.1]}}
  k: {{value: "{dice.choice(("p*sin(2)", "sqrt(p)/3", "p + pi/7"))}"}}
  s: {{value: 1}}
definitions: {{d: "{expression(dice, [*q, "p", "k"], 2)}"}}
kinetic_energy: "{" + ".join((*energy, coupling))}"
potential_energy: "{expression(dice, names, 4)}"
constraints: {{geometric: {{row: "tanh({expression(dice, names, 1)}) + 3*q_0 - sin(q_1)"}}}}
inputs:
  u: {{acts_on: {{q_1: "2 + sin({expression(dice, names, 2)})", q_0: "{expression(dice, names, 1)}"}}}}
applied_forces: {{q_0: "{expression(dice, [*names, "q_0_dot"], 2)}"}}
"""


@pytest.mark.parametrize("seed", range(5))
def test_kernels_are_the_functions_that_are_meant(seed: int) -> None:
    model = load_text(random_model(seed), f"random_{seed}.yaml")
    derivations = derive_quantities(model, ("all",))
    kernels = schedule(derivations.mechanics, derivations.quantities, ("float64",))["float64"].kernels
    assert len(kernels) > 20
    expected = Expected(model, tuple(kernel.name for kernel in kernels), 8, lambda _: None)
    wrong = {kernel.name: difference for kernel in kernels if (difference := ExactStates(expected).difference(kernel))}
    assert wrong == {}
