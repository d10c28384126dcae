"""Motions of a model, as arrays, chart and animation."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from pathlib import Path

import numpy as np

from symgen.notebook.results import unheard
from symgen.report.html import svg_element
from symgen.simulate.simulation import DURATION, FRAMES, Request, Simulation, simulated


class SimulatedModel:
    """A motion: `times` (s), `q` and `rates` (frames x n), `energy` (frames x 2: T, U), `residual` (the constraints').

    `stopped` says why it ended early, or is None.
    """

    def __init__(self, simulation: Simulation) -> None:
        motion = simulation.motion
        self._simulation = simulation
        self.names = tuple(coordinate.name for coordinate in simulation.model.coordinates)
        self.times: np.ndarray = np.array(motion.times)
        self.q: np.ndarray = np.array(motion.q)
        self.rates: np.ndarray = np.array(motion.qd)
        self.energy: np.ndarray = np.array(motion.energy)
        self.residual: np.ndarray = np.array(motion.residual)
        self.stopped = motion.stopped

    def __getitem__(self, coordinate: str) -> np.ndarray:
        """The course of a coordinate (frames)."""
        if coordinate not in self.names:
            raise KeyError(f"{coordinate!r} is none of {', '.join(self.names)}")
        course: np.ndarray = self.q[:, self.names.index(coordinate)]
        return course

    def chart(self) -> str:
        """SVG: coordinates by unit, energies, violation of the constraints."""
        return self._simulation.chart()

    def animation(self) -> str | None:
        """A page of HTML that plays the motion; None for a model without frames."""
        return self._simulation.animation()

    def __repr__(self) -> str:
        ended = f", stopped {self.stopped}" if self.stopped else ""
        return f"<motion of {self._simulation.model.name}: {self.times[-1]:g} s in {len(self.times)} frames{ended}>"

    def _repr_html_(self) -> str:
        page = self.animation()
        played = f'<iframe srcdoc="{escape(page, quote=True)}" width="100%" height="480"></iframe>' if page else ""
        return f"<div>{svg_element(self.chart())}{played}</div>"


def simulated_model(
    path: Path, duration: float | None, frames: int | None, start: Mapping[str, float], inputs: Mapping[str, float]
) -> SimulatedModel:
    """The motion of a model."""
    seconds = DURATION if duration is None else duration
    request = Request(seconds, FRAMES if frames is None else frames, dict(start), dict(inputs))
    return SimulatedModel(simulated(path, request, unheard))
