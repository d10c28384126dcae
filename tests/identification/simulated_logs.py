"""Logs of machines whose parameters are known: a Fourier motion, inputs by generated kernels, and what sensors add."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

from symgen.identification.combinations import default_like
from symgen.identification.estimates.identification import Identification
from symgen.identification.estimates.identify import IdentifiableMachine, identifiable, identified_by
from symgen.identification.logs.filtering import filter_settings
from symgen.identification.logs.read_log import read_log
from symgen.identification.machine_functions import MachineFunctions
from symgen.model.load import load_text

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Motion:
    """Coordinates that lead, each about a middle with an amplitude, by a series of sines of one period."""

    leading: Mapping[str, tuple[float, float]]
    period: float = 5.0
    harmonics: int = 5


@dataclass(frozen=True)
class Sensors:
    """What a log adds: noise of inputs as a share of their rms, steps of encoders, preload, single wild samples."""

    noise: float = 0.02
    resolution: float = 2e-5
    preload: float = 0.0
    outliers: int = 0


@dataclass(frozen=True)
class SimulatedLog:
    """A log as text, and the motion behind it at its samples."""

    text: str
    q: Array
    qd: Array
    qdd: Array
    u: Array
    noise: Array

    def divided(self, factors: Mapping[str, float]) -> SimulatedLog:
        """The same text with some columns divided by factors."""
        names, *rows = (line.split(",") for line in self.text.splitlines())
        by = [factors.get(name, 1.0) for name in names]
        lines = [",".join(f"{float(x) / f:.9g}" for x, f in zip(row, by, strict=True)) for row in rows]
        return replace(self, text="\n".join([",".join(names), *lines]) + "\n")

    def write(self, folder: Path) -> Path:
        path = folder / "log.csv"
        path.write_text(self.text, encoding="utf-8")
        return path


@cache
def machine_of(text: str, measured: tuple[str, ...]) -> IdentifiableMachine:
    """A model in a text, made and verified once for all logs with these measured coordinates."""
    return identifiable(Path("machine.yaml"), load_text(text, "machine.yaml"), measured, lambda _: None)


def of_file(path: Path, text: str, measured: tuple[str, ...]) -> Identification:
    """What a log says; the machine is made once for all of its logs."""
    machine = machine_of(text, measured)
    log = read_log(path, machine.base.model)
    return identified_by(machine, log, filter_settings(log, None), lambda _: None)


def functions_of(text: str, leading: tuple[str, ...]) -> MachineFunctions:
    """The generated functions of a model in a text."""
    return machine_of(text, leading).functions


def simulated_log(
    text: str,
    motion: Motion,
    measured: Sequence[str],
    truth: Mapping[str, float],
    sensors: Sensors,
    seed: int = 0,
    seconds: float = 10.0,
    rate: float = 500.0,
) -> SimulatedLog:
    """A log of the machine whose parameters are those of the text but for the truth."""
    generator = np.random.default_rng(seed)
    functions = functions_of(text, tuple(name for name in _order(text) if name in motion.leading))
    t = np.arange(round(seconds * rate)) / rate
    places, rates, accelerations = _fourier(functions, motion, t, generator)
    q = _closed(functions, places)
    qd, qdd = functions.motion(q, rates, accelerations)
    changed = default_like(functions.model, functions.parameters, truth)
    u = functions.inputs((q, qd, qdd), changed)
    size = np.sqrt(np.mean(u**2, axis=0))
    noise = sensors.noise * size
    seen = u + noise * generator.standard_normal(u.shape)
    if sensors.preload:
        against = np.ones(u.shape) * sensors.preload * size
        seen = seen + against - functions.least(q, against)
    wild = generator.integers(0, len(t), sensors.outliers)
    seen[wild] += 20 * size * generator.standard_normal((sensors.outliers, len(size)))
    names = [c.name for c in functions.model.coordinates]
    columns = {"t": t}
    for name in measured:
        values = q[:, names.index(name)]
        columns[name] = np.round(values / sensors.resolution) * sensors.resolution if sensors.resolution else values
    columns |= {one.name: seen[:, k] for k, one in enumerate(functions.model.inputs)}
    lines = [",".join(columns)]
    lines += [",".join(f"{x:.9g}" for x in row) for row in zip(*columns.values(), strict=True)]
    return SimulatedLog("\n".join(lines) + "\n", q, qd, qdd, u, noise)


def _order(text: str) -> list[str]:
    return [c.name for c in load_text(text, "machine.yaml").coordinates]


def _fourier(
    functions: MachineFunctions, motion: Motion, t: Array, generator: np.random.Generator
) -> tuple[Array, Array, Array]:
    made = []
    for k in functions.model.measured_places:
        middle, amplitude = motion.leading[functions.model.coordinates[k].name]
        shares = generator.standard_normal((motion.harmonics, 2)) / np.arange(1, motion.harmonics + 1)[:, None]
        w = 2 * np.pi / motion.period * np.arange(1, motion.harmonics + 1)[:, None]
        waves = [shares[:, :1] * np.sin(w * t) + shares[:, 1:] * np.cos(w * t)]
        waves += [w * (shares[:, :1] * np.cos(w * t) - shares[:, 1:] * np.sin(w * t)), -(w**2) * waves[0]]
        series = [wave.sum(axis=0) for wave in waves]
        scale = amplitude / np.max(np.abs(series[0]))
        made.append([middle + scale * series[0], scale * series[1], scale * series[2]])
    stacked = np.array(made)
    return stacked[:, 0].T, stacked[:, 1].T, stacked[:, 2].T


def _closed(functions: MachineFunctions, places: Array) -> Array:
    if not functions.closes_loops:
        return places
    assert functions.model.assembly is not None
    near = np.array(functions.model.assembly.places[0].q)
    chosen = list(functions.model.measured_places)
    for share in np.linspace(0, 1, 101)[1:]:
        near, why = functions.one_configuration(near[chosen] + share * (places[0] - near[chosen]), near)
        assert not why, why
    q = np.empty((len(places), functions.model.n))
    for k, place in enumerate(places):
        near, why = functions.one_configuration(place, near)
        assert not why, why
        q[k] = near
    return q
