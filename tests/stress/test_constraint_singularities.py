"""Mechanisms whose constraints fail or depend on each other."""

from __future__ import annotations

from pathlib import Path

from shipped import model

from symgen.generation.runnable import RunnableKernels
from symgen.laboratory.stress.determinants import choices, common_troubles
from symgen.laboratory.stress.families import _family, _kind, near_redundant
from symgen.laboratory.stress.series import SYMGEN
from symgen.laboratory.stress.sweep import Sweeper
from symgen.laboratory.stress.variants.redundant import with_redundant_row
from symgen.laboratory.stress.zeros import places
from symgen.model.load import load_text
from symgen.verify.reference.reference import Reference

FOUR_BAR = """
model: parallelogram
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}}
parameters: {l: 0.4, w: 0.7, slope: 0.5}
kinetic_energy: a_dot**2/2 + b_dot**2/3 + c_dot**2
constraints:
  geometric:
    loop_x: l*cos(a) + w*cos(b) - l*cos(c) - w*cos(slope)
    loop_y: l*sin(a) + w*sin(b) - l*sin(c) - w*sin(slope)
inputs: {T: {acts_on: {a: 1}}}
configuration: {a: 1.2, b: 0.5, c: 1.2}
"""


def test_a_four_bar_at_its_change_point(tmp_path: Path) -> None:
    reference = Reference(load_text(FOUR_BAR, "parallelogram.yaml"))
    (trouble,) = [t for kind, t in common_troubles(choices(reference)) if kind == "constraint"]
    singular_places = places(reference, trouble, 1)
    assert [_kind(reference, place) for place in singular_places] == ["constraint"]
    names = ("inverse_dynamics", "forward_dynamics", "nullspace_projector")
    family = _family(reference, "constraint", trouble, singular_places)
    sweeper = Sweeper(reference, RunnableKernels(reference.model, tmp_path, names), [family])
    sweeper.family(0)
    result = sweeper.result()
    assert result.failures == ()
    for count in result.statuses:
        # rounding to float32 may leave the angles a little beside the lower threshold
        assert count.singular > 0 or count.scalar == "float32"
        assert count.refused > 0
        assert count.regular > 5
        assert count.singular_passed == count.regular_refused == 0


def test_near_redundant_rows_cost_no_more_than_the_drift(tmp_path: Path) -> None:
    twin = with_redundant_row(model("slider_crank"))
    assert twin is not None
    reference = Reference(twin)
    assert (reference.ranks.constraints, twin.r) == (2, 3)
    sweeper = Sweeper(reference, RunnableKernels(twin, tmp_path, ("inverse_dynamics",)), [near_redundant(reference)])
    sweeper.family(0)
    result = sweeper.result()
    assert result.failures == ()
    (series,) = [s for s in result.series if s.scalar == "float64" and s.method == SYMGEN]
    # off the constraints by 1e-4 the error is of that size, and it goes away with the drift
    at = {round(e.distance, 14): e.relative for e in series.errors}
    assert 1e-6 < at[0.01] < 1e-1
    assert at[1e-12] < 1e-11


def test_a_model_without_geometric_constraints_has_no_redundant_twin() -> None:
    assert with_redundant_row(model("front_car")) is None
