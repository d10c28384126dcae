"""The test driver: a C program that runs every kernel on every state, and the files it reads and writes."""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from symgen.emit.render import render
from symgen.emit.scalars import C_TYPE, SUFFIX
from symgen.ir.kernel import Argument, Kernel, Program, Scalar
from symgen.model.model import Model
from symgen.naming import file_stem
from symgen.verify.reference import State

FORMAT: dict[Scalar, str] = {"float64": "d", "float32": "f"}
SIZE: dict[Scalar, int] = {"float64": 8, "float32": 4}


@dataclass(frozen=True, slots=True)
class Record:
    """What one kernel made of one state: status and the bytes of its outputs (the driver's filling if untouched)."""

    status: int
    outputs: bytes


@dataclass(frozen=True, slots=True)
class Results:
    """Records by kernel, in the order of the states, and the deepest painted stack of each kernel in bytes."""

    records: Mapping[str, tuple[Record, ...]]
    stack: Mapping[str, int]


@dataclass(frozen=True, slots=True)
class KernelView:
    """How the driver calls one kernel."""

    caller: str
    call: str
    size: int


@dataclass(frozen=True, slots=True)
class GroupView:
    """The kernels of one scalar type."""

    header: str
    type: str
    params: str
    defaults: str
    states_file: str
    results_file: str
    arrays: tuple[Argument | ParameterArray, ...]
    parameters: int
    widest: int
    kernels: tuple[KernelView, ...]


@dataclass(frozen=True, slots=True)
class ParameterArray:
    """The parameters at the end of a row."""

    length: int
    name: str = "p"


@dataclass(frozen=True, slots=True)
class DriverView:
    """What the driver's template prints."""

    groups: tuple[GroupView, ...]


def states_file(scalar: Scalar) -> str:
    """The file of states of one scalar type."""
    return f"states_{scalar}.bin"


def results_file(scalar: Scalar) -> str:
    """The file of results of one scalar type."""
    return f"results_{scalar}.bin"


def function_name(model: Model, kernel: Kernel, scalar: Scalar) -> str:
    """The C function of a kernel."""
    return f"{model.name}_{kernel.name}{SUFFIX[scalar]}"


def driver_source(model: Model, programs: Mapping[Scalar, Program]) -> str:
    """The driver for the kernels of all programs."""
    return render("target/driver.c.jinja", DriverView(tuple(_group(model, p) for p in programs.values())))


def pack_states(states: Sequence[State], scalar: Scalar) -> bytes:
    """States as the driver reads them: their number, then rows of q, qd, qdd, u and parameters; little-endian."""
    rows = [(*s.q, *s.qd, *s.qdd, *s.u, *s.parameters) for s in states]
    return struct.pack("<I", len(rows)) + b"".join(struct.pack(f"<{len(r)}{FORMAT[scalar]}", *r) for r in rows)


def unpack_results(data: bytes, program: Program, states: int) -> Results:
    """The driver's results; raises ValueError when the file is not of the expected length."""
    sizes = {kernel.name: max(1, math.prod(kernel.shape)) * SIZE[program.scalar] for kernel in program.kernels}
    expected = states * sum(4 + size for size in sizes.values()) + 4 * len(sizes)
    if len(data) != expected:
        raise ValueError(f"{len(data)} bytes of results instead of {expected}")
    records: dict[str, list[Record]] = {name: [] for name in sizes}
    place = 0
    for _ in range(states):
        for name, size in sizes.items():
            (status,) = struct.unpack_from("<I", data, place)
            records[name].append(Record(status, data[place + 4 : place + 4 + size]))
            place += 4 + size
    stack = struct.unpack_from(f"<{len(sizes)}I", data, place)
    return Results({name: tuple(r) for name, r in records.items()}, dict(zip(sizes, stack, strict=True)))


def _group(model: Model, program: Program) -> GroupView:
    suffix, kind = SUFFIX[program.scalar], C_TYPE[program.scalar]
    arrays = (
        Argument("q", model.n), Argument("qd", model.n), Argument("qdd", model.n), Argument("u", model.m),
        ParameterArray(len(model.parameters)),
    )
    return GroupView(
        header=f"{file_stem(model.name)}{suffix}.h",
        type=kind,
        params=f"{model.name}_params{suffix}",
        defaults=f"{model.name}_default_params{suffix}",
        states_file=states_file(program.scalar),
        results_file=results_file(program.scalar),
        arrays=tuple(array for array in arrays if array.length),
        parameters=len(model.parameters),
        widest=max(1, *(math.prod(kernel.shape) for kernel in program.kernels)),
        kernels=tuple(_kernel(model, program.scalar, kernel, k) for k, kernel in enumerate(program.kernels)),
    )


def _kernel(model: Model, scalar: Scalar, kernel: Kernel, place: int) -> KernelView:
    kind = C_TYPE[scalar]
    arguments = [f"row_{kind}.{argument.name}" for argument in kernel.arguments if argument.length]
    call = f"{function_name(model, kernel, scalar)}({', '.join([*arguments, f'&p_{kind}', f'y_{kind}'])})"
    return KernelView(f"call_{kind}_{place}", call, max(1, math.prod(kernel.shape)))
