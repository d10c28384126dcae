"""The generated kernels of a model, ready to run: compiled C, or the interpreter where there is no compiler."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from symgen.backends.c.plain import emit_c
from symgen.generation.acceptance.recorded import as_recorded
from symgen.generation.results import Options
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.model.model import Model
from symgen.model.quantities import MAIN
from symgen.quantities.catalogue import CATALOGUE
from symgen.verify.given import arrays
from symgen.verify.reference.reference import State
from symgen.verify.running.compile import CFunction, Compilation, Outcome, c_array, find_compiler
from symgen.verify.running.sources import generated_sources
from symgen.verify.sampling.states import in_scalar

SCALARS: tuple[Scalar, ...] = ("float64", "float32")
# What the formulas of the paper are computed from.
PIECES = (
    "mass_matrix",
    "coriolis_matrix",
    "potential_force",
    "applied_force",
    "constraint_jacobian",
    "constraint_jacobian_dot",
    "control_matrix",
)
STRESSED = (*MAIN, "nullspace_projector")
DRIVEN = ("constraint_residual", "energy", "admissible_velocity", "projected_configuration")


class Runner:
    """Programs ready to run: compiled C (`files`, by path), or the interpreter where there is no compiler."""

    def __init__(self, model: Model, programs: Mapping[Scalar, Program], folder: Path) -> None:
        self._programs = programs
        self.files: dict[str, str] = {}
        for program in programs.values():
            self.files |= emit_c(model, program)
        everywhere = set.intersection(*({kernel.name for kernel in program.kernels} for program in programs.values()))
        self.names = tuple(kernel.name for kernel in programs["float64"].kernels if kernel.name in everywhere)
        self.compiler = find_compiler()
        self._kernels = {(s, k.name): k for s, program in programs.items() for k in program.kernels}
        self._functions: dict[tuple[Scalar, str], CFunction] = {}
        if self.compiler is None:
            self._interpreters = {s: Interpreter(program.sincos, s) for s, program in programs.items()}
            return
        sources, _ = generated_sources(model, dict(self.files))
        compilations = {s: Compilation(self.compiler, source, folder) for s, source in sources.items()}
        try:
            for scalar, compilation in compilations.items():
                library = compilation.library()
                for kernel in self._programs[scalar].kernels:
                    self._functions[scalar, kernel.name] = CFunction(library, model.c_name, kernel, scalar)
        finally:
            for compilation in compilations.values():
                compilation.cancel()

    def kernel(self, name: str, scalar: Scalar) -> Kernel:
        """The straight-line kernel of a quantity."""
        return self._kernels[scalar, name]

    def run(self, name: str, state: State, scalar: Scalar) -> Outcome:
        """One kernel at one state, whose numbers are of the scalar type already."""
        return self.run_given(name, arrays(state, [self._kernels[scalar, name]]), state.parameters, scalar)

    def run_given(
        self, name: str, parts: Mapping[str, Sequence[Any]], parameters: Sequence[Any], scalar: Scalar
    ) -> Outcome:
        """The same for array arguments by name."""
        kernel = self._kernels[scalar, name]
        if self._functions:
            given: dict[str, Any] = {part: c_array(scalar, values) for part, values in parts.items()}
            return self._functions[scalar, name](given, c_array(scalar, parameters))
        status, outputs = self._interpreters[scalar].run(kernel, parts, tuple(map(float, parameters)))
        return Outcome(int(status), tuple(outputs) or (math.nan,) * max(1, math.prod(kernel.shape)))


class RunnableKernels:
    """Kernels by quantity name and scalar type, and the C they are made of (`files`, by path).

    They are those of OUT/<model>, where a run has verified some; `notes` say what is to be told of that.
    """

    def __init__(
        self,
        model: Model,
        folder: Path,
        quantities: Sequence[str] = (*PIECES, *STRESSED, *DRIVEN),
        out: Path | None = None,
    ) -> None:
        self.model, self.out = model, out
        known = {entry.name for entry in CATALOGUE}
        wanted = tuple(name for name in quantities if name in known)
        draft = as_recorded(model, wanted, Options(scalars=SCALARS, measured=out))
        self.notes = draft.notes
        self.programs: Mapping[Scalar, Program] = draft.written
        self._methods = {choice.quantity: choice.title for choice in draft.derivations.choices}
        self.runner = Runner(model, self.programs, folder)
        self.files, self.names, self.compiler = self.runner.files, self.runner.names, self.runner.compiler

    @property
    def engine(self) -> str:
        """What runs the kernels."""
        return "interpreter" if self.compiler is None else "C"

    def method(self, quantity: str) -> str:
        """The method or null space by which a quantity is computed; empty for one the model does not have."""
        return self._methods.get(quantity, "")

    def kernel(self, name: str, scalar: Scalar) -> Kernel:
        """The straight-line kernel of a quantity."""
        return self.runner.kernel(name, scalar)

    def run(self, name: str, state: State, scalar: Scalar) -> Outcome:
        """One kernel at one state, whose numbers are of the scalar type already."""
        return self.runner.run(name, state, scalar)


def rounded_state(state: State, scalar: Scalar) -> State:
    """The state with every number rounded to the scalar type."""
    doubles = State(*(tuple(float(x) for x in part) for part in state.parts))
    return in_scalar(doubles, scalar)
