"""Mechanisms whose constraints fail or depend on each other."""

from __future__ import annotations

from pathlib import Path

from symgen.model.load import load_text
from symgen.stress.determinants import choices, common_troubles
from symgen.stress.families import _extremes, _family, _kind
from symgen.stress.kernels import Kernels
from symgen.stress.series import SYMGEN
from symgen.stress.sweep import Sweeper
from symgen.stress.zeros import places
from symgen.verify.reference import Reference

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
# Two equal cranks hold a beam that already has a third: five of the six rows are independent.
CRANKS = """
model: cranks
coordinates: {a: {unit: rad}, b: {unit: rad}, d: {unit: rad}, x: {unit: m}, y: {unit: m}, p: {unit: rad}}
parameters: {l: 1, w: 1.5}
kinetic_energy: (a_dot**2 + b_dot**2 + d_dot**2)/20 + 3*(x_dot**2 + y_dot**2)/2 + w**2/2*p_dot**2
constraints:
  geometric:
    a_x: l*cos(a) - w - x + w*cos(p)
    a_y: l*sin(a) - y + w*sin(p)
    b_x: l*cos(b) - x
    b_y: l*sin(b) - y
    d_x: l*cos(d) + w - x - w*cos(p)
    d_y: l*sin(d) - y - w*sin(p)
inputs: {T_1: {acts_on: {a: 1}}, T_2: {acts_on: {b: 1}}}
configuration: {a: 0.9, b: 0.9, d: 0.9, x: 0.62, y: 0.78, p: 0}
"""


def test_a_four_bar_at_its_change_point(tmp_path: Path) -> None:
    reference = Reference(load_text(FOUR_BAR, "parallelogram.yaml"))
    (trouble,) = [t for kind, t in common_troubles(choices(reference)) if kind == "constraint"]
    found = places(reference, trouble, 1)
    assert [_kind(reference, place) for place in found] == ["constraint"]
    names = ("inverse_dynamics", "forward_dynamics", "nullspace_projector")
    family = _family(reference, "constraint", trouble, found)
    sweeper = Sweeper(reference, Kernels(reference.model, tmp_path, names), [family])
    sweeper.family(0)
    result = sweeper.result()
    assert result.failures == ()
    for count in result.statuses:
        # rounding to float32 may leave the angles a little beside the lower threshold
        assert count.singular > 0 or count.scalar == "float32"
        assert count.refused > 0
        assert count.regular > 5
        assert count.singular_passed == count.regular_refused == 0


def test_drift_of_dependent_rows_costs_no_more_than_itself(tmp_path: Path) -> None:
    reference = Reference(load_text(CRANKS, "cranks.yaml"))
    assert reference.ranks.constraints == 5
    (family,) = [family for family in _extremes(reference) if family.kind == "near-redundant"]
    sweeper = Sweeper(reference, Kernels(reference.model, tmp_path, ("inverse_dynamics",)), [family])
    sweeper.family(0)
    result = sweeper.result()
    assert result.failures == ()
    (series,) = [s for s in result.series if s.scalar == "float64" and s.form == SYMGEN]
    # off the constraints by 1e-3 the error is of that size, and it goes away with the drift
    at = {round(e.distance, 14): e.relative for e in series.errors}
    assert 1e-6 < at[0.01] < 1e-1
    assert at[1e-12] < 1e-11
