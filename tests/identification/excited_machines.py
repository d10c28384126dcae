"""Machines whose motion is designed: with limits of all kinds, with loops, with a task; and designs made once."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from identified_machines import ARM_WITH_FRICTION, FOUR_BAR_WITH_NAMES

from symgen.generation.results import Options
from symgen.identification import machine_functions
from symgen.identification.excitation import design
from symgen.identification.excitation.excitation import Excitation, ExcitationRequest, excitation

# The arm with ranges of all that moves, and drives that are weak.
ARM_WITH_LIMITS = ARM_WITH_FRICTION + (
    """
allocation: {limits: {u_a: [-16, 16], u_b: [-4, 4]}}
ranges:
  a: [-1.2, 1.4]
  b: [-1.0, 2.0]
  a_dot: [-4, 4]
  b_dot: [-5, 5]
  a_ddot: [-30, 30]
  b_ddot: [-40, 40]
configuration: {a: -0.6, b: 0.4}
"""
)
# Vertical in the plane: a crank that swings, with rates alone limited.
SWINGING_FOUR_BAR = FOUR_BAR_WITH_NAMES + "ranges: {a_dot: [-4, 4], b_dot: [-6, 6], c_dot: [-4, 4]}\n"
USUAL_REQUEST = ExcitationRequest(period=4.0, distance=None, seed=0)


@contextmanager
def short_designs() -> Iterator[None]:
    """Functions verified at few states, motions improved by few steps: of the same kind, not as good."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(machine_functions, "Options", partial(Options, states=8))
        patch.setattr(design, "DRAWN_MOTIONS", 5)
        patch.setattr(design, "IMPROVED", 1)
        patch.setattr(design, "MOST_IMPROVING_STEPS", 20)
        yield


@cache
def designed_once(text: str, request: ExcitationRequest = USUAL_REQUEST) -> Excitation:
    """A short design for a model in a text."""
    with TemporaryDirectory() as folder, short_designs():
        path = Path(folder) / "machine.yaml"
        path.write_text(text, encoding="utf-8")
        return excitation(path, request, lambda _: None)
