"""A fuzz target for all kernels of a model: raw bits go in, and what comes out is held against six rules.

Forms with prepared parameters, or with sines and cosines from the caller, are kernels like the others.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from symgen.backends.c.endings import PREPARED, SINES_GIVEN
from symgen.backends.c.names import c_members
from symgen.backends.literals import decimal_text
from symgen.backends.locals import array_arguments
from symgen.backends.quantities import IN_FORMS
from symgen.backends.render import render
from symgen.backends.scalars import C_TYPE, SUFFIX, file_stem
from symgen.ir.given_trig import GivenTrig, given_trig
from symgen.ir.kernel import Kernel, Program
from symgen.ir.prepare import prepare
from symgen.model.model import Model, Range
from symgen.model.quantities import MEASURED_ARGUMENTS
from symgen.proof.box import box

ARRAYS = ("q", "qd", "qdd", "u")
# Kernels of a control loop: their float32 result is held against float64 at every state, however odd.
HELD = ("inverse_dynamics", "forward_dynamics")
BITS = {"float64": 64, "float32": 32}



@dataclass(frozen=True, slots=True)
class FuzzedFunctionView:
    """One function: the places of its arguments among q, qd, qdd, u, and the length of its result.

    `name` is the quantity with the ending of its variant; `same` names the function that must return the same bits.
    """

    name: str
    prepared: bool
    given: bool
    arguments: tuple[int, ...]
    size: int
    held: bool
    same: str


@dataclass(frozen=True, slots=True)
class FuzzView:
    """Everything the template of the fuzz target prints.

    `types` are the scalar types with their bits and suffixes, `units` the files without extension, of both types.
    `given` are members of the structs of sines and cosines, each with whether it is a sine, its place in q, and the
    suffixes of the scalar types whose struct has it.
    """

    stem: str
    model: str
    types: tuple[tuple[str, int, str], ...]
    units: tuple[str, ...]
    names: str
    sizes: tuple[tuple[str, int], ...]
    longest: int
    largest_result: int
    members: tuple[str, ...]
    given: tuple[tuple[str, bool, int, tuple[str, ...]], ...]
    ranges: tuple[tuple[str, str, str], ...]
    kernels: tuple[FuzzedFunctionView, ...]
    held: tuple[str, ...]


def emit_fuzz(model: Model, programs: Sequence[Program]) -> dict[str, str]:
    """`proof/<model>_fuzz.c`, which needs the C of both scalar types; `programs` are float64 and float32."""
    program = programs[0]
    ranges = box(model)
    ready, (given, trig) = _prepared(programs), _given(model, programs)
    named_members = c_members(model, program)
    members = tuple(named_members[parameter.name] for parameter in model.parameters)
    arrays = _arrays(model, program)
    sizes = (*((name, len(ranges[name])) for name in arrays), ("sc", len(trig)))
    named = [(f"{name}[{index}]", pair) for name in (*arrays, "p") for index, pair in enumerate(ranges[name])]
    variants = {"": program.kernels, PREPARED: ready, SINES_GIVEN: given}
    units = [ending for ending, kernels in variants.items() if kernels]
    stem = model.c_name
    view = FuzzView(
        stem=stem,
        model=model.c_name,
        types=tuple((C_TYPE[one.scalar], BITS[one.scalar], SUFFIX[one.scalar]) for one in programs),
        units=tuple(file_stem(stem, one.scalar, ending) for ending in units for one in programs),
        names=", ".join(arrays),
        sizes=sizes,
        longest=max(1, *(size for _, size in sizes)),
        largest_result=max((len(kernel.outputs) for kernel in program.kernels), default=1),
        members=members,
        given=trig,
        ranges=tuple((place, *_bounds(pair)) for place, pair in named),
        kernels=tuple(_kernel(kernel, ending, arrays) for ending, kernels in variants.items() for kernel in kernels),
        held=tuple(kernel.name for kernel in program.kernels if kernel.name in HELD),
    )
    return {f"proof/{view.stem}_fuzz.c": render("proof/fuzz.c.jinja", view)} if view.kernels else {}


def _prepared(programs: Sequence[Program]) -> tuple[Kernel, ...]:
    """The kernels with prepared parameters that both scalar types have."""
    made = [prepared.kernels if (prepared := prepare(p, IN_FORMS)) else () for p in programs]
    common = set.intersection(*({kernel.name for kernel in kernels} for kernels in made))
    return tuple(kernel for kernel in made[0] if kernel.name in common)


def _given(
    model: Model, programs: Sequence[Program]
) -> tuple[tuple[Kernel, ...], tuple[tuple[str, bool, int, tuple[str, ...]], ...]]:
    """The kernels that take sines and cosines in both scalar types, and the members of the structs of these."""
    made = [tuple(_with_trig(program)) for program in programs]
    common = set.intersection(*({one.kernel.name for one in kernels} for kernels in made))
    places = {SUFFIX[p.scalar]: {load.index for one in kernels for load in one.coordinates}
              for p, kernels in zip(programs, made, strict=True)}
    members = [
        (f"{half}_{model.coordinates[index].name}", half == "sin", index,
         tuple(suffix for suffix, known in places.items() if index in known))
        for index in sorted(set.union(*places.values()))
        for half in ("sin", "cos")
    ]
    return tuple(one.kernel for one in made[0] if one.kernel.name in common), tuple(members) if common else ()


def _with_trig(program: Program) -> Iterator[GivenTrig]:
    variants = (given_trig(kernel) for kernel in program.kernels if kernel.name in IN_FORMS)
    return (one for one in variants if one is not None)


def _kernel(kernel: Kernel, ending: str, arrays: Sequence[str]) -> FuzzedFunctionView:
    places = tuple(arrays.index(argument.name) for argument in array_arguments(kernel))
    prepared, name = ending == PREPARED, kernel.name
    same = name if prepared else ""
    return FuzzedFunctionView(
        name + ending, prepared, ending == SINES_GIVEN, places, len(kernel.outputs), name in HELD, same
    )


def _arrays(model: Model, program: Program) -> tuple[str, ...]:
    """The array arguments that kernels of a model may have, and further ones where any has them."""
    taken = {argument.name for kernel in program.kernels for argument in array_arguments(kernel)}
    measured = MEASURED_ARGUMENTS if model.measured else ()
    further = (one.name for one in model.further_arguments if one.name in taken or one.name in measured)
    return (*ARRAYS, *further)


def _bounds(pair: Range) -> tuple[str, str]:
    low, high = (decimal_text("float32", bound) + "f" for bound in pair)
    return low, high
