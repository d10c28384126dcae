"""A fuzz target for all kernels of a model: raw bits go in, and what comes out is held against four rules."""

from __future__ import annotations

from dataclasses import dataclass

from symgen.emit.c import c_names
from symgen.emit.literals import decimal_text
from symgen.emit.locals import array_arguments
from symgen.emit.render import render
from symgen.ir.kernel import Kernel, Program
from symgen.model.model import Model, Range
from symgen.naming import file_stem
from symgen.proof.box import box

ARRAYS = ("q", "qd", "qdd", "u")
# Kernels of a control loop: their float32 result is held against float64 at every state, however odd.
HELD = ("inverse_dynamics", "forward_dynamics")


@dataclass(frozen=True, slots=True)
class KernelView:
    """One kernel: the places of its arguments among q, qd, qdd, u, and the length of its result."""

    name: str
    arguments: tuple[int, ...]
    size: int
    held: bool


@dataclass(frozen=True, slots=True)
class FuzzView:
    """Everything the template of the fuzz target prints."""

    stem: str
    model: str
    sizes: tuple[tuple[str, int], ...]
    longest: int
    largest_result: int
    members: tuple[str, ...]
    ranges: tuple[tuple[str, str, str], ...]
    kernels: tuple[KernelView, ...]
    held: tuple[str, ...]


def emit_fuzz(model: Model, program: Program) -> dict[str, str]:
    """`proof/<model>_fuzz.c`, which needs the C of both scalar types."""
    ranges = box(model)
    sizes = tuple((name, len(ranges[name])) for name in ARRAYS)
    named = [(f"{name}[{index}]", pair) for name in (*ARRAYS, "p") for index, pair in enumerate(ranges[name])]
    members = tuple(c_names(model, program).members[parameter.name] for parameter in model.parameters)
    view = FuzzView(
        stem=file_stem(model.name),
        model=model.name,
        sizes=sizes,
        longest=max(1, *(size for _, size in sizes)),
        largest_result=max((len(kernel.outputs) for kernel in program.kernels), default=1),
        members=members,
        ranges=tuple((place, *_bounds(pair)) for place, pair in named),
        kernels=tuple(map(_kernel, program.kernels)),
        held=tuple(kernel.name for kernel in program.kernels if kernel.name in HELD),
    )
    return {f"proof/{view.stem}_fuzz.c": render("proof/fuzz.c.jinja", view)} if view.kernels else {}


def _kernel(kernel: Kernel) -> KernelView:
    places = tuple(ARRAYS.index(argument.name) for argument in array_arguments(kernel))
    return KernelView(kernel.name, places, len(kernel.outputs), kernel.name in HELD)


def _bounds(pair: Range) -> tuple[str, str]:
    low, high = (decimal_text("float32", bound) + "f" for bound in pair)
    return low, high
