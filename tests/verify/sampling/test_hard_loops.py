"""Loops that few starts close: most states come from steps along the manifold, inside the ranges and without hours."""

from __future__ import annotations

from typing import Any

import pytest

from symgen.model.load import load_text
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.reference import Reference
from symgen.verify.reference.system import ReferenceSystem
from symgen.verify.sampling.plain_values import SAMPLING_BITS
from symgen.verify.sampling.regular import FEWEST_STATES, RegularStateSearch

# Eight joints in space, held at a ball and at a pin, of which one may turn little; a ninth turns freely beside them.
ARM = """model: arm
parameters: {l: {value: 0.8, range: [0.56, 1.12]}, d: {value: 0.47, range: [0.329, 0.658]}}
frames:
  dock: {translation: [1.179897984553653, 1.1458779266915569, 0.9794306312297694]}
joints:
  j_1: {type: revolute, axis: [1, 0, -1], coordinate: a_1}
  j_2: {type: revolute, parent: j_1, at: [0, l, 0], axis: [1, 1, 0], coordinate: a_2}
  j_3: {type: revolute, parent: j_2, at: [0.3, 0, 0], axis: [0.3, -0.5, 0.8], coordinate: a_3}
  j_4: {type: revolute, parent: j_3, at: [0.25, 0, 0], axis: [1, 2, 3], coordinate: a_4}
  j_5: {type: revolute, parent: j_4, at: [1.2, 0, 0], axis: z, coordinate: a_5}
  j_6: {type: revolute, parent: j_5, at: [0, 1.2, 0.19], axis: [0, 1, 1], coordinate: a_6}
  j_7: {type: revolute, parent: j_1, at: [0, 0.8, 0], axis: [1, 0, -1], coordinate: a_7}
  j_8: {type: revolute, parent: j_4, at: [1.2, 0, 0], axis: [1, 2, 3], coordinate: a_8}
  j_9: {type: revolute, parent: j_8, at: [-0.11, 0, d], axis: [1, 1, 0], coordinate: a_9}
bodies:
  j_6: {mass: 7, com: [0, 0.4, 0], inertia: {xx: 0.04, yy: 0.02, zz: 0.04}}
  j_7: {mass: 2, com: [0.1, 0, 0], inertia: {xx: 0.04, yy: 0.02, zz: 0.04}}
  j_9: {mass: 6, com: [0, 0.3, 0], inertia: {xx: 0.07, yy: 0.08, zz: 0.08}}
points:
  tip_1: {frame: j_9, at: [0, 0.7, 0]}
  anchor_1: {at: [1.5187652972732741, 1.974632323257946, 1.045042975157219]}
  tip_2: {frame: j_6, at: [0, 0.94, 0]}
  anchor_2: {at: [0.4806794103942379, 2.158125548458802, 2.2604685454685063]}
loops:
  ball: {type: spherical, between: [j_8, dock]}
  rod: {type: distance, between: [tip_1, anchor_1], length: 0.5462818831502249}
  pin: {type: point, between: [tip_2, anchor_2]}
inputs: {u: {joint: a_9}}
configuration: {a_1: 0.4, a_2: 2.86, a_3: -0.86, a_4: 2, a_5: -2.72, a_6: -2.14, a_7: -2.15, a_8: 2.32, a_9: -0.96}
ranges: {a_4: [1.21, 2.37]}
"""


@pytest.mark.campaign
def test_states_are_found_from_those_that_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw 1116:175: every start that did not close was followed by eleven more, and fifty seconds went by."""
    reference = Reference(load_text(ARM, "arm.yaml"))
    calls, geometry = [0], ReferenceSystem.loop_geometry

    def counted(system: ReferenceSystem, *given: Any) -> Any:
        calls[0] += 1
        return geometry(system, *given)

    monkeypatch.setattr(ReferenceSystem, "loop_geometry", counted)
    with precision(SAMPLING_BITS):
        candidates = list(RegularStateSearch(reference, 64, 0).candidates())
    inside = [regular.state.q for regular, in_range in candidates if in_range]
    assert len(inside) >= FEWEST_STATES
    assert all(1.19 < q[3] < 2.39 for q in inside)
    assert len(set(inside)) == len(inside)
    assert calls[0] < 10_000
