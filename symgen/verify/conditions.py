"""Condition numbers that the certificate reports: of B with rows of norm 1, and of F'M with F orthonormal."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median
from typing import Any

from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.plain_values import SAMPLING_BITS
from symgen.verify.sampling.states import Sample


def condition_numbers(reference: Reference, samples: Sequence[Sample]) -> list[tuple[str, float, float]]:
    """Name, median and largest condition number over the samples, at the known ranks.

    The singular values of F'M are those of M~ = N_B M.
    """
    import numpy as np

    wanted = []
    if reference.model.r and reference.ranks.constraints:
        wanted.append(("constraint Jacobian, rows of norm 1", "constraint_jacobian", reference.ranks.constraints))
    if reference.model.m and reference.ranks.actuation:
        wanted.append(("F'M, F orthonormal", "projected_control_matrix", reference.ranks.actuation))
    by_label: dict[str, list[float]] = {label: [] for label, _, _ in wanted}
    for sample in samples:
        matrices = reference.matrices(sample.state, [name for _, name, _ in wanted], SAMPLING_BITS)
        for label, name, rank in wanted:
            matrix = _floats(matrices[name])
            if name == "constraint_jacobian":
                sizes = np.linalg.norm(matrix, axis=1, keepdims=True)
                matrix = matrix / np.where(sizes > 0, sizes, 1.0)
            values = np.linalg.svd(matrix, compute_uv=False)
            by_label[label].append(float(values[0] / values[rank - 1]))
    return [(label, median(values), max(values)) for label, values in by_label.items()]


def _floats(matrix: Any) -> Any:
    import numpy as np

    return np.array([float(x) for x in matrix.entries()]).reshape(matrix.nrows(), matrix.ncols())
