"""Fixed choices lose digits like eps/d near their singularities; the generated kernels stay at the floor."""

from __future__ import annotations

from dataclasses import replace
from math import log10
from pathlib import Path

import pytest
from shipped import model
from test_families import families_of, known, reference

from symgen.generation.runnable import PIECES, Outcome, RunnableKernels
from symgen.ir.kernel import Scalar
from symgen.laboratory.stress.families import Family, _family
from symgen.laboratory.stress.series import FIXED, PARTITION, SWITCHING, SYMGEN, Series
from symgen.laboratory.stress.sweep import Sweeper
from symgen.laboratory.stress.zeros import places
from symgen.verify.reference.reference import State


def swept(name: str, family: Family, folder: Path, quantities: tuple[str, ...]) -> tuple[dict[str, Series], Sweeper]:
    sweeper = Sweeper(reference(name), RunnableKernels(model(name), folder, quantities), [family])
    sweeper.family(0)
    series = {f"{s.quantity} {s.method} {s.scalar}": s for s in sweeper.result().series}
    return series, sweeper


def slope(series: Series, low: float, high: float) -> float:
    """Least-squares exponent p of error ~ d^-p between two distances."""
    points = [(-log10(e.distance), log10(max(e.relative, 1e-18))) for e in series.errors if low <= e.distance <= high]
    x0, y0 = (sum(column) / len(points) for column in zip(*points, strict=True))
    return sum((x - x0) * (y - y0) for x, y in points) / sum((x - x0) ** 2 for x, _ in points)


def test_pairs_of_drives_lose_digits_that_the_generated_kernel_keeps(tmp_path: Path) -> None:
    (trouble,) = [t for t in known("rapkm_2rrr_rr").troubles if t.label == "sin(a₁ − a₂ + b₁ − b₂)"]
    family = _family(reference("rapkm_2rrr_rr"), "parameter", trouble, places(reference("rapkm_2rrr_rr"), trouble, 1))
    series, sweeper = swept("rapkm_2rrr_rr", family, tmp_path, (*PIECES, "inverse_dynamics", "nullspace_projector"))
    u = {method: series[f"inverse_dynamics {method} float64"] for method in (PARTITION, FIXED, SWITCHING, SYMGEN)}
    for method in (PARTITION, FIXED):
        assert slope(u[method], 1e-7, 1e-2) > 0.7
        assert max(e.relative for e in u[method].errors) > 1e-3
        assert u[method].breaks is not None
    for method in (SWITCHING, SYMGEN):
        assert max(e.relative for e in u[method].errors) < 1e-12
    for one in series.values():
        if one.method == SYMGEN:
            assert one.breaks is None
    assert sweeper.result().failures == ()


@pytest.mark.parametrize("name", ["rear_car"])
def test_statuses_come_from_both_sides_of_an_input_singularity(name: str, tmp_path: Path) -> None:
    (family,) = [family for family in families_of(name).families if family.kind == "input"]
    _, sweeper = swept(name, family, tmp_path, ("inverse_dynamics", "forward_dynamics", "nullspace_projector"))
    result = sweeper.result()
    assert result.failures == ()
    for count in result.statuses:
        assert count.regular > 10
        assert count.regular_refused == count.singular_passed == 0
        assert (count.singular > 0) == (count.quantity == "inverse_dynamics")
        assert (count.refused >= count.singular > 0) or count.quantity != "inverse_dynamics"


def test_a_wrong_kernel_is_found_out(tmp_path: Path) -> None:
    """The sweep fails when results carry an error, and when a refusal is missing."""
    (family,) = [family for family in families_of("rear_car").families if family.kind == "input"]
    kernels = RunnableKernels(model("rear_car"), tmp_path, ("inverse_dynamics",))

    class Spoiled:
        names = kernels.names

        @staticmethod
        def run(name: str, state: State, scalar: Scalar) -> Outcome:
            outcome = kernels.run(name, state, scalar)
            return replace(outcome, status=0, entries=tuple(x * (1 + 1e-5) if x == x else 0.0 for x in outcome.entries))

    sweeper = Sweeper(reference("rear_car"), Spoiled(), [family])
    sweeper.family(0)
    failures = "\n".join(sweeper.result().failures)
    assert "beyond the tolerance" in failures
    assert "status 0 at measures" in failures
