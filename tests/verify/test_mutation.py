"""Verification sees faults: random changes of IR statements that change the function are rejected, all of them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property

import pytest
import shipped
from flint import arb_mat
from mutation import Mutant, exact_outputs, mutations

from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Kernel
from symgen.verify.comparison import compare
from symgen.verify.given import arrays
from symgen.verify.reference.arithmetic.linear import norm
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.quantities import ITERATED
from symgen.verify.reference.reference import Reference, State
from symgen.verify.running.compile import Outcome
from symgen.verify.sampling.states import Sample, sample_states
from symgen.verify.tolerance import FACTOR, Expectation, expectations

COUNT = 200
STATES = 64
DECIDING_STATES = 3
DECIDING_FACTOR = 8 * FACTOR


class Trial:
    """One model under test: verification states, and other states that decide whether a change is one."""

    def __init__(self, name: str) -> None:
        self.name = name
        program = shipped.programs(name)["float64"]
        # Newton's method mends what is wrong in one of its steps
        kernels = tuple(kernel for kernel in program.kernels if kernel.name not in ITERATED)
        self.program = replace(program, kernels=kernels)
        self.reference = Reference(shipped.model(name))
        self.quantities = tuple(kernel.name for kernel in self.program.kernels)
        self.interpreter = Interpreter(self.program.sincos, "float64")
        self._expected: dict[tuple[int, bool], dict[str, Expectation]] = {}

    @cached_property
    def samples(self) -> tuple[Sample, ...]:
        return sample_states(self.reference, self.quantities, STATES)

    @cached_property
    def deciding(self) -> tuple[Sample, ...]:
        return sample_states(self.reference, self.quantities, 8, seed=1)[-DECIDING_STATES:]

    def expected(self, index: int, deciding: bool = False) -> dict[str, Expectation]:
        key = (index, deciding)
        if key not in self._expected:
            sample = (self.deciding if deciding else self.samples)[index]
            self._expected[key] = expectations(self.reference, sample.state, self.quantities, "float64", str(key))
        return self._expected[key]

    def changes_the_function(self, mutant: Mutant) -> bool:
        name = mutant.original.name
        for index, sample in enumerate(self.deciding):
            with precision(160):
                try:
                    changed = exact_outputs(mutant.kernel, self.arguments(sample.state), sample.state.parameters)
                except ZeroDivisionError:
                    return True
                original = exact_outputs(mutant.original, self.arguments(sample.state), sample.state.parameters)
                distance = norm(arb_mat(1, len(changed), [a - b for a, b in zip(changed, original, strict=True)]))
            if not distance <= DECIDING_FACTOR * self.expected(index, deciding=True)[name].unit:
                return True
        return False

    def arguments(self, state: State) -> dict[str, Sequence[float]]:
        return arrays(state, self.program.kernels)

    def rejects(self, kernel: Kernel) -> bool:
        """Whether the comparison that verification makes finds a fault at some state."""
        return any(self._faults(kernel))

    def _faults(self, kernel: Kernel) -> Iterator[bool]:
        for index, sample in enumerate(self.samples):
            given = self.arguments(sample.state)
            status, entries = self.interpreter.run(kernel, given, sample.state.parameters)
            outcome = Outcome(int(status), tuple(entries) or (math.nan,))
            record = compare(kernel.name, "interpreter", [self.expected(index)[kernel.name]], [outcome])
            yield record.refused > 0 or not record.largest <= FACTOR


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.campaign if name == "rapkm_2rrr_rr" else ()) for name in shipped.SWEPT],
)
def test_every_change_of_the_function_is_rejected(name: str) -> None:
    trial = Trial(name)
    mutants = mutations(trial.program, COUNT, seed=2)
    changing = [mutant for mutant in mutants if trial.changes_the_function(mutant)]
    missed = [mutant.change for mutant in changing if not trial.rejects(mutant.kernel)]
    assert missed == []
    assert len(changing) > COUNT // 2


def test_the_kernels_themselves_are_accepted() -> None:
    trial = Trial("slider_crank")
    assert [kernel.name for kernel in trial.program.kernels if trial.rejects(kernel)] == []
