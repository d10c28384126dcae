"""Drivers for Frama-C Eva: every kernel over the whole box of the model file, the unmodified C included."""

from __future__ import annotations

from dataclasses import dataclass
from math import prod

from symgen.backends.c.names import c_members, status_name
from symgen.backends.literals import decimal_text
from symgen.backends.locals import array_arguments
from symgen.backends.render import render
from symgen.backends.scalars import C_TYPE, SUFFIX, file_stem
from symgen.ir.kernel import Kernel, Load, Local, Program, Scalar, Status
from symgen.model.model import Model, Range
from symgen.proof.box import box, loaded_angles
from symgen.proof.reach import reach
from symgen.proof.slices import slices

# Runs of a kernel in one analysis: a few seconds.
MOST_RUNS = 512


@dataclass(frozen=True, slots=True)
class SliceView:
    """A coordinate that is cut: its place in q and the bounds of its slices."""

    index: int
    lows: tuple[str, ...]
    highs: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class EntryView:
    """A value that ranges over an interval as a whole."""

    place: str
    low: str
    high: str


@dataclass(frozen=True, slots=True)
class EvaDriverView:
    """The entry function of one kernel."""

    name: str
    arrays: tuple[tuple[str, int], ...]
    entries: tuple[EntryView, ...]
    slices: tuple[SliceView, ...]
    size: int
    doubtful: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class EvaView:
    """Everything the template of a driver file prints; `tanh` is the library's function, empty where none is called."""

    stem: str
    model: str
    suffix: str
    scalar: str
    interval: str
    ok: str
    not_finite: str
    has_parameters: bool
    tanh: str
    drivers: tuple[EvaDriverView, ...]


def emit_eva(model: Model, program: Program) -> dict[str, str]:
    """`proof/<model>_eva.c` (float32: `_f_eva.c`) with one entry function for each kernel."""
    suffix = SUFFIX[program.scalar]
    stem = file_stem(model.c_name, program.scalar)
    kind = C_TYPE[program.scalar]
    members = c_members(model, program)
    view = EvaView(
        stem=stem,
        model=model.c_name,
        suffix=suffix,
        scalar=kind,
        interval=f"Frama_C_{kind}_interval",
        ok=status_name(model, Status.OK),
        not_finite=status_name(model, Status.NOT_FINITE),
        has_parameters=bool(model.parameters),
        tanh=_tanh(program),
        drivers=tuple(_driver(model, program, kernel, members) for kernel in program.kernels),
    )
    return {f"proof/{stem}_eva.c": render("proof/eva.c.jinja", view)}


def decisive_angles(kernel: Kernel) -> tuple[Load, ...]:
    """The coordinates that enter a denominator or a test through their sine or cosine."""
    quotients = [s.operands for s in kernel.statements if s.operation in ("div", "wide_div")]
    divisors = [operands[len(operands) // 2] for operands in quotients]
    needed = {operand.name for operand in divisors if isinstance(operand, Local)}
    for block in kernel.blocks[1:]:
        needed |= {o.name for check in block.checks for o in (check.value, check.limit) if isinstance(o, Local)}
    for statement in reversed(kernel.statements):
        if needed.intersection(statement.targets):
            needed |= {o.name for o in statement.operands if isinstance(o, Local)}
    return tuple(load for load in loaded_angles(kernel) if load.local in needed)


def cut_coordinates(model: Model, program: Program, kernel: Kernel) -> frozenset[int]:
    """The places in q of the coordinates that the kernel's driver cuts into slices."""
    return frozenset(view.index for view in _slices(program, kernel, box(model), model.trig_range == "wide"))


def _driver(model: Model, program: Program, kernel: Kernel, members: dict[str, str]) -> EvaDriverView:
    ranges = box(model)
    cut = _slices(program, kernel, ranges, model.trig_range == "wide")
    sliced = {view.index for view in cut}
    arrays = tuple((argument.name, argument.length) for argument in array_arguments(kernel))
    places = [(f"{name}[{i}]", ranges[name][i]) for name, size in arrays for i in range(size)]
    places = [(place, pair) for place, pair in places if place not in {f"q[{index}]" for index in sliced}]
    places += [(f"p.{members[p.name]}", pair) for p, pair in zip(model.parameters, ranges["p"], strict=True)]
    return EvaDriverView(
        name=kernel.name,
        arrays=arrays,
        entries=tuple(EntryView(place, *_texts(program.scalar, pair)) for place, pair in places),
        slices=cut,
        size=len(kernel.outputs),
        doubtful=reach(model, kernel).doubtful,
    )


def _slices(
    program: Program, kernel: Kernel, ranges: dict[str, tuple[Range, ...]], wide: bool
) -> tuple[SliceView, ...]:
    """The slices of the decisive angles, none where there would be too many to analyse."""
    by_index = {load.index: slices(program.scalar, ranges["q"][load.index], wide) for load in decisive_angles(kernel)}
    if program.sincos is None or prod(len(cuts) for cuts in by_index.values()) > MOST_RUNS:
        return ()
    return tuple(
        SliceView(
            index,
            tuple(_hexadecimal(program.scalar, cut.low) for cut in cuts),
            tuple(_hexadecimal(program.scalar, cut.high) for cut in cuts),
        )
        for index, cuts in by_index.items()
    )


def _tanh(program: Program) -> str:
    called = any(s.operation == "tanh" for kernel in program.kernels for s in kernel.statements)
    return ("tanh" if program.scalar == "float64" else "tanhf") if called else ""


def _texts(scalar: Scalar, pair: Range) -> tuple[str, str]:
    tail = "f" if scalar == "float32" else ""
    low, high = (decimal_text(scalar, bound) + tail for bound in pair)
    return low, high


def _hexadecimal(scalar: Scalar, value: float) -> str:
    return value.hex().replace("0000000p", "p") + ("f" if scalar == "float32" else "")
