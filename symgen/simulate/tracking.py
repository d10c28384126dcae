"""A model that follows a path under a sampled controller: encoders, delay, limits of drives, parameters in doubt."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from symgen.model.input_limits import input_limits
from symgen.simulate.controllers import Array, Controller, ModelKernels, Planned
from symgen.simulate.drive_log import DriveLog, drive_log
from symgen.simulate.integrate import SimulatedMotion
from symgen.simulate.plant import Plant, PlantError

# Seconds that a step of the machine takes at most.
MACHINE_STEP = 1e-3
# Of what encoders say beside what is: the same at each run.
NOISE_SEED = 1


@dataclass(frozen=True, slots=True)
class ControlLoop:
    """How a path is followed.

    `sample` and `delay` in s; `resolution` of encoders and standard deviation of `noise` in units of coordinates;
    `bandwidth` in rad/s; `weights` of states and inputs for a regulator; `machine` are parameters of the machine that
    the controller does not know; `input_noise` is the standard deviation of inputs in its log, in their units.
    """

    path: str
    controller: str
    bandwidth: float
    weights: tuple[float, float]
    sample: float
    delay: float
    resolution: float
    noise: float
    machine: Mapping[str, float]
    input_noise: float


@dataclass(frozen=True, slots=True)
class TrackedMotion:
    """A motion with what was planned and put in at each frame, and the `log` of all samples.

    `largest` are the largest errors of coordinates (n) at any sample; `held` counts samples at which the controller had
    no result and the inputs stayed, `saturated` those at which a drive was at its limit.
    """

    motion: SimulatedMotion
    planned: tuple[tuple[float, ...], ...]
    inputs: tuple[tuple[float, ...], ...]
    largest: tuple[float, ...]
    log: DriveLog
    samples: int
    held: int
    saturated: int


class Encoders:
    """What a controller sees: measured coordinates, quantised and noisy, from them the rest; rates by differences."""

    def __init__(self, kernels: ModelKernels, loop: ControlLoop, q: Array) -> None:
        self._kernels, self._loop = kernels, loop
        model = kernels.model
        self._places = list(model.measured_places) if model.measured else list(range(model.n))
        self._noise = np.random.default_rng(NOISE_SEED)
        self._reconstructs = bool(model.measured) and len(self._places) < model.n
        self._q = q
        self._before: Array | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Of the coordinates that are measured."""
        return tuple(self._kernels.model.coordinates[k].name for k in self._places)

    @property
    def said(self) -> Array:
        """What they said last, before anything was made of it."""
        assert self._before is not None
        return self._before

    def read(self, q: Array, qd: Array) -> tuple[Array, Array]:
        """q and q_dot as the controller knows them; the first rates are those of the machine."""
        loop = self._loop
        seen = q[self._places] + loop.noise * self._noise.standard_normal(len(self._places))
        if loop.resolution:
            seen = loop.resolution * np.round(seen / loop.resolution)
        rates = qd[self._places] if self._before is None else (seen - self._before) / loop.sample
        self._before = seen
        if self._reconstructs:
            self._q = self._kernels("configuration_from_measured", q_m=seen, q=self._q)
            return self._q, self._kernels("velocity_from_measured", q=self._q, qd_m=rates)
        known = np.empty_like(q)
        known[self._places] = seen
        if self._kernels.model.r:
            rates = self._kernels("admissible_velocity", q=known, qd=rates)
        return known, rates


def tracked(
    plant: Plant,
    start: tuple[Sequence[float], Sequence[float]],
    planned: Callable[[float], Planned],
    controller: Controller,
    encoders: Encoders,
    loop: ControlLoop,
    times: Sequence[float],
    progress: Callable[[float], None],
) -> TrackedMotion:
    """The motion under sampled control; `times` are the frames.  Where the machine has no acceleration it ends."""
    names = (p.name for p in plant.model.parameters)
    limits = np.array(input_limits(plant.model, dict(zip(names, plant.parameters, strict=True)))).T
    q, qd = np.array(start[0]), np.array(start[1])
    frames: list[tuple[float, Array, Array, Array, Array]] = []
    applied: deque[Array] = deque()
    readings: list[tuple[float, Array, Array]] = []
    latency = round(loop.delay / loop.sample)
    count = max(1, round(times[-1] / loop.sample))
    shown = deque(times)
    largest = np.zeros(plant.model.n)
    held = saturated = 0
    u = np.zeros(plant.model.m)
    stopped = None
    for k in range(count + 1):
        time = k * loop.sample
        wanted = planned(min(time, times[-1]))
        largest = np.maximum(largest, np.abs(wanted.q - q))
        try:
            u = controller.inputs(wanted, *encoders.read(q, qd))
        except PlantError:
            held += 1
        allowed = np.clip(u, *limits)
        saturated += bool((allowed != u).any())
        applied.append(allowed)
        acting = applied.popleft() if len(applied) > latency else applied[0]
        readings.append((time, encoders.said, acting))
        if shown and time >= shown[0] - loop.sample / 2:
            shown.popleft()
            frames.append((time, wanted.q, q, qd, acting))
            progress(time)
        if k == count:
            break
        try:
            q, qd = _moved(plant, q, qd, acting, loop.sample)
        except PlantError as fault:
            stopped = f"at t = {time:.6g} s: {fault}"
            break
    return TrackedMotion(
        SimulatedMotion(
            times=tuple(frame[0] for frame in frames),
            q=tuple(tuple(frame[2].tolist()) for frame in frames),
            qd=tuple(tuple(frame[3].tolist()) for frame in frames),
            energy=tuple(plant.energy(frame[2].tolist(), frame[3].tolist()) for frame in frames),
            residual=tuple(plant.residual(frame[2].tolist()) for frame in frames),
            stopped=stopped,
        ),
        planned=tuple(tuple(frame[1].tolist()) for frame in frames),
        inputs=tuple(tuple(frame[4].tolist()) for frame in frames),
        largest=tuple(largest.tolist()),
        log=drive_log(encoders.names, readings, loop.input_noise, NOISE_SEED),
        samples=count + 1,
        held=held,
        saturated=saturated,
    )


def _moved(plant: Plant, q: Array, qd: Array, u: Array, duration: float) -> tuple[Array, Array]:
    """The state after `duration` under constant inputs: Runge and Kutta's method of order 4, then onto V."""
    steps = max(1, math.ceil(duration / MACHINE_STEP - 1e-9))
    h, n, inputs = duration / steps, len(q), u.tolist()

    def slope(x: Array) -> Array:
        return np.concatenate([x[n:], plant.accelerations(x[:n].tolist(), x[n:].tolist(), inputs)])

    x = np.concatenate([q, qd])
    for _ in range(steps):
        a = slope(x)
        b = slope(x + h / 2 * a)
        c = slope(x + h / 2 * b)
        d = slope(x + h * c)
        x = x + h / 6 * (a + 2 * b + 2 * c + d)
    there = plant.projected(x[:n].tolist())
    return np.array(there), np.array(plant.admissible(there, x[n:].tolist()))


