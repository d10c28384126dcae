"""Motion of a plant under constant inputs: an explicit Runge-Kutta method of order 8, drift projected at each frame."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from symgen.simulate.plant import Plant, PlantError

# Errors that a step of the integrator may make: of the size of its numbers, and in their units.
RELATIVE_ERROR, ABSOLUTE_ERROR = 1e-10, 1e-12
# Accelerations worked out for one frame at most: where a motion runs into a singularity, or springs and friction
# are stiff, steps become so short that it would never end.
MOST_EVALUATIONS = 50_000
# Times that a start is projected onto the constraints, by two Newton steps each.
NEWTON_ROUNDS = 25
TOO_SHORT = "a singular configuration is near, or forces change within less than a step"
# What is left of the constraints of a start that satisfies them.
CLOSED_START = 1e-12


@dataclass(frozen=True, slots=True)
class SimulatedMotion:
    """Frames of a motion: times (s), q, q_dot, (T, U), largest constraint violation; why it stopped early, if so."""

    times: tuple[float, ...]
    q: tuple[tuple[float, ...], ...]
    qd: tuple[tuple[float, ...], ...]
    energy: tuple[tuple[float, float], ...]
    residual: tuple[float, ...]
    stopped: str | None


def consistent_start(plant: Plant, q: Sequence[float], qd: Sequence[float]) -> tuple[list[float], list[float]]:
    """The start brought onto the constraints; raises PlantError where Newton's method does not arrive."""
    here = list(q)
    for _ in range(NEWTON_ROUNDS):
        if plant.residual(here) <= CLOSED_START:
            return here, list(plant.admissible(here, qd))
        here = list(plant.projected(here))
    raise PlantError(
        f"the constraints are violated by {plant.residual(here):.3g} after {2 * NEWTON_ROUNDS} Newton steps; "
        "give a `configuration:` near one that closes them"
    )


def integrate(
    plant: Plant,
    start: tuple[Sequence[float], Sequence[float]],
    u: Sequence[float],
    times: Sequence[float],
    progress: Callable[[float], None],
) -> SimulatedMotion:
    """The motion at `times`; where a kernel has no result any more it ends there."""
    n = plant.model.n
    evaluations = 0

    def derivative(time: float, state: np.ndarray) -> np.ndarray:
        nonlocal evaluations
        evaluations += 1
        if evaluations > MOST_EVALUATIONS:
            raise PlantError(f"{MOST_EVALUATIONS} steps lead no further than t = {time:.9g} s: {TOO_SHORT}")
        q, qd = state[:n].tolist(), state[n:].tolist()
        return np.array([*qd, *plant.accelerations(q, qd, u)])

    q, qd = list(start[0]), list(start[1])
    frames = [(times[0], tuple(q), tuple(qd))]
    stopped = None
    step: float | None = None
    for begin, end in pairwise(times):
        evaluations = 0
        first = None if step is None else min(step, end - begin)
        try:
            solved = solve_ivp(
                derivative,
                (begin, end),
                [*q, *qd],
                "DOP853",
                rtol=RELATIVE_ERROR,
                atol=ABSOLUTE_ERROR,
                first_step=first,
            )
            if not solved.success:
                raise PlantError(str(solved.message))
            q = list(plant.projected(solved.y[:n, -1].tolist()))
            qd = list(plant.admissible(q, solved.y[n:, -1].tolist()))
        except PlantError as fault:
            stopped = f"at t = {begin:.6g} s: {fault}"
            break
        # the next frame begins with the longest step of this one
        step = float(max(np.diff(solved.t)))
        frames.append((end, tuple(q), tuple(qd)))
        progress(end)
    return SimulatedMotion(
        times=tuple(frame[0] for frame in frames),
        q=tuple(frame[1] for frame in frames),
        qd=tuple(frame[2] for frame in frames),
        energy=tuple(plant.energy(q, qd) for _, q, qd in frames),
        residual=tuple(plant.residual(q) for _, q, _ in frames),
        stopped=stopped,
    )
