"""The test driver: a C program that runs every kernel on every state, and the files it reads and writes."""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from symgen.backends.c.names import global_name
from symgen.backends.render import render
from symgen.backends.scalars import C_TYPE, file_stem
from symgen.ir.kernel import Argument, Scalar
from symgen.laboratory.target.entries import Entries, Entry
from symgen.model.model import Model
from symgen.verify.given import entries
from symgen.verify.reference.reference import State

FORMAT: dict[Scalar, str] = {"float64": "d", "float32": "f"}
SIZE: dict[Scalar, int] = {"float64": 8, "float32": 4}


@dataclass(frozen=True, slots=True)
class RunRecord:
    """What one kernel made of one state: status and the bytes of its outputs (the driver's filling if untouched)."""

    status: int
    outputs: bytes


@dataclass(frozen=True, slots=True)
class Results:
    """Records by entry, in the order of the states, and the deepest painted stack of each in bytes."""

    records: Mapping[str, tuple[RunRecord, ...]]
    stack: Mapping[str, int]


@dataclass(frozen=True, slots=True)
class DriverCallView:
    """How the driver calls one function."""

    caller: str
    call: str
    size: int


@dataclass(frozen=True, slots=True)
class GroupView:
    """The functions of one scalar type; `given` names members of the struct of sines and cosines by place in a row."""

    headers: tuple[str, ...]
    type: str
    params: str
    defaults: str
    prepared: str
    prepare: str
    trig: str
    given: tuple[tuple[str, int], ...]
    states_file: str
    results_file: str
    arrays: tuple[Argument | OwnArray, ...]
    parameters: int
    widest: int
    kernels: tuple[DriverCallView, ...]


@dataclass(frozen=True, slots=True)
class OwnArray:
    """What a row holds beside the arguments: parameters, sines and cosines."""

    name: str
    length: int


@dataclass(frozen=True, slots=True)
class TargetDriverView:
    """What the driver's template prints."""

    groups: tuple[GroupView, ...]


def states_file(scalar: Scalar) -> str:
    """The file of states of one scalar type."""
    return f"states_{scalar}.bin"


def results_file(scalar: Scalar) -> str:
    """The file of results of one scalar type."""
    return f"results_{scalar}.bin"


def driver_source(model: Model, entries: Mapping[Scalar, Entries]) -> str:
    """The driver for the functions of all scalar types."""
    return render("target/driver.c.jinja", TargetDriverView(tuple(_group(model, e) for e in entries.values())))


def pack_states(states: Sequence[State], scalar: Scalar, model: Model) -> bytes:
    """States as the driver reads them: their number, then rows; little-endian.

    A row is q, qd, qdd, u, the further arguments of the model, parameters, and the sine and cosine of every coordinate
    for those who take them.
    """
    further = _further(model)
    rows = [_row(s, further) for s in states]
    return struct.pack("<I", len(rows)) + b"".join(struct.pack(f"<{len(r)}{FORMAT[scalar]}", *r) for r in rows)


def _further(model: Model) -> list[Argument]:
    return [Argument(one.name, len(one.places), one.places) for one in model.further_arguments]


def _row(state: State, further: Sequence[Argument]) -> tuple[Any, ...]:
    values = [x for argument in further for x in entries(state, argument)]
    return (*state.q, *state.qd, *state.qdd, *state.u, *values, *state.parameters, *_given(state.q))


def unpack_results(data: bytes, entries: Entries, states: int) -> Results:
    """The driver's results; raises ValueError when the file is not of the expected length."""
    sizes = {entry.name: entry.size * SIZE[entries.scalar] for entry in entries.functions}
    expected = states * sum(4 + size for size in sizes.values()) + 4 * len(sizes)
    if len(data) != expected:
        raise ValueError(f"{len(data)} bytes of results instead of {expected}")
    records: dict[str, list[RunRecord]] = {name: [] for name in sizes}
    place = 0
    for _ in range(states):
        for name, size in sizes.items():
            (status,) = struct.unpack_from("<I", data, place)
            records[name].append(RunRecord(status, data[place + 4 : place + 4 + size]))
            place += 4 + size
    stack = struct.unpack_from(f"<{len(sizes)}I", data, place)
    return Results({name: tuple(r) for name, r in records.items()}, dict(zip(sizes, stack, strict=True)))


def _given(q: Sequence[Any]) -> list[float]:
    return [half(x) if math.isfinite(x) else math.nan for x in q for half in (math.sin, math.cos)]


def _group(model: Model, entries: Entries) -> GroupView:
    kind = C_TYPE[entries.scalar]

    def named(what: str) -> str:
        return global_name(model.c_name, entries.scalar, what)

    arrays: tuple[Argument | OwnArray, ...] = (
        Argument("q", model.n), Argument("qd", model.n), Argument("qdd", model.n), Argument("u", model.m),
        *_further(model),
        OwnArray("p", len(model.parameters)), OwnArray("sc", 2 * model.n),
    )
    units = dict.fromkeys([file_stem(model.c_name, entries.scalar), *(entry.unit for entry in entries.functions)])
    return GroupView(
        headers=tuple(f"{unit}.h" for unit in units),
        type=kind,
        params=named("params"),
        defaults=named("default_params"),
        prepared=named("prepared") if entries.prepared else "",
        prepare=named("prepare"),
        trig=named("trig") if entries.given else "",
        given=tuple(
            (f"{half}_{model.coordinates[index].name}", 2 * index + place)
            for index in entries.given
            for place, half in enumerate(("sin", "cos"))
        ),
        states_file=states_file(entries.scalar),
        results_file=results_file(entries.scalar),
        arrays=tuple(array for array in arrays if array.length),
        parameters=len(model.parameters),
        widest=max((entry.size for entry in entries.functions), default=1),
        kernels=tuple(_kernel(kind, entry, k) for k, entry in enumerate(entries.functions)),
    )


def _kernel(kind: str, entry: Entry, place: int) -> DriverCallView:
    return DriverCallView(f"call_{kind}_{place}", entry.call, entry.size)
