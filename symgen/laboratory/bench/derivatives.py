"""J_u, the derivatives of u, beside CasADi's `jacobian` of u in any form, and Pinocchio's derivatives of arms.

States are drawn as for mechanisms: u and its derivatives by each number alone are defined off the manifold as well.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import symgen
from symgen.generation.results import WrongUseError
from symgen.laboratory.bench.build import TIMED_STATES, find_gcc
from symgen.laboratory.bench.candidate import Task
from symgen.laboratory.bench.mechanisms import MeasuredKernel, Progress, drawn_states, measured_kernels
from symgen.laboratory.bench.peers.jacobian_peers import jacobian_peers
from symgen.laboratory.bench.symgen_kernels import generated, symgen_candidates
from symgen.laboratory.bench.workload import Workload
from symgen.model.blocks.allocation import without_allocation
from symgen.model.load import load_model

JACOBIAN = "inverse_dynamics_jacobian"


@dataclass(frozen=True, slots=True)
class DerivativeBenchmark:
    """The kernels of J_u of one model, symgen's first, and (name, reason) of what was left out."""

    model: str
    kernels: tuple[MeasuredKernel, ...]
    left_out: tuple[tuple[str, str], ...]
    notes: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """A JSON-able form."""
        return {"symgen": symgen.__version__, **asdict(self)}


def derivative_benchmark(path: Path, progress: Progress, out: Path | None = None) -> DerivativeBenchmark:
    """Measure J_u of one model.

    symgen's kernel is that of OUT/<model>, where a run has verified one; without `out`, what derivation chooses.

    Raises ModelError for mistakes in the file, WrongUseError without gcc, or where there is no J_u.
    """
    import numpy as np

    if find_gcc() is None:
        raise WrongUseError("symgen bench compiles everything with gcc, and there is no gcc on this machine")
    model = without_allocation(load_model(path))
    if not model.m:
        raise WrongUseError(f"{path}: nothing to measure, the model has no inputs")
    task = Task(JACOBIAN, "qdd", model.m * 3 * model.n)
    states = np.array(drawn_states(model, TIMED_STATES))
    nothing = np.zeros((len(states), task.size))
    progress("deriving J_u")
    draft = generated(model, task, ("float64",), out)
    if draft.derivations.left_out:
        raise WrongUseError(f"{path}: nothing to measure: {'; '.join(draft.notes)}")
    own = symgen_candidates(model, {draft.choice(JACOBIAN).title: draft.written}, "float64")
    progress("writing peers")
    peers, left_out = jacobian_peers(model, states)
    load = Workload("float64", states, nothing, nothing, [])
    kernels, _ = measured_kernels(model, task, [*own, *peers], load, progress)
    return DerivativeBenchmark(model.name, tuple(kernels), left_out, draft.notes)
