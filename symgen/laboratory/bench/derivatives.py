"""J_u, the derivatives of u, beside CasADi's `jacobian` of u in any form, and Pinocchio's derivatives of arms.

States are drawn as for mechanisms: u and its derivatives by each number alone are defined off the manifold as well.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import symgen
from symgen.laboratory.bench.build import TIMED_STATES
from symgen.laboratory.bench.candidate import Task
from symgen.laboratory.bench.mechanisms import (
    MeasuredKernel,
    Progress,
    drawn_states,
    measurable,
    measured_draft,
    measured_kernels,
)
from symgen.laboratory.bench.peers.jacobian_peers import jacobian_peers
from symgen.laboratory.bench.symgen_kernels import symgen_candidates
from symgen.laboratory.bench.workload import Workload

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

    model = measurable(path)
    task = Task(JACOBIAN, "qdd", model.m * 3 * model.n)
    states = np.array(drawn_states(model, TIMED_STATES))
    nothing = np.zeros((len(states), task.size))
    progress("deriving J_u")
    draft = measured_draft(path, model, task, out)
    own = symgen_candidates(model, {draft.choice(JACOBIAN).title: draft.written}, "float64")
    progress("writing peers")
    peers, left_out = jacobian_peers(model, states)
    load = Workload("float64", states, nothing, nothing, [])
    kernels, _ = measured_kernels(model, task, [*own, *peers], load, progress)
    return DerivativeBenchmark(model.name, tuple(kernels), left_out, draft.notes)
