"""What the user should know of the files of a run: what is missing, rejected, long or not verified."""

from __future__ import annotations

from collections.abc import Container, Iterator
from math import inf
from typing import TYPE_CHECKING

from symgen.backends.backend import backend
from symgen.backends.defaults import default_values
from symgen.backends.operations import count_operations
from symgen.diagnostics import Notice
from symgen.generation.dense_motion import dense_motions
from symgen.generation.draft import Draft
from symgen.generation.files import asked_for
from symgen.generation.results import Options
from symgen.ir.kernel import Kernel
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.model.model import Model
from symgen.model.open_task import left_open, norm_of_motions
from symgen.model.quantities import ROWS, TASK_PLACES, TASK_RATES
from symgen.quantities.everything import OF_ALL
from symgen.quantities.finish import short_of_inputs
from symgen.registered import BACKENDS

if TYPE_CHECKING:
    from symgen.verify.certificate import Certificate

# Measured on a chain of 16 links: 6336 operations in 45.6 kB with the single precision of a Cortex-M4, gcc -O2.
BYTES_AN_OPERATION = 7
# What a step of `backends/c/bodies/steps.py` takes in its table.
BYTES_A_STEP = 14
# How far from its value a bound of a parameter goes without saying.
CLOSE_BY = 100
# Bytes of machine code beyond which a notice tells of them.
LARGEST_CODE = 64_000


def notices(draft: Draft, options: Options, certificate: Certificate | None) -> tuple[Notice, ...]:
    """What is missing of what was asked for, takes another method or is long, and what could not be verified."""
    asked = options.outputs or draft.model.outputs
    left_out = {one.quantity for one in draft.left_out}
    known = [(n, why) for n, why in draft.derivations.absent if n in asked and n not in left_out]
    absent = [Notice(f"{n} is not generated: {why}") for n, why in known]
    of_all = ((n, why) for n, why in draft.derivations.absent if why.startswith(OF_ALL))
    absent += [Notice(f"{n}: {why}") for n, why in of_all]
    kernels = {kernel.name for kernel in draft.program.kernels}
    unmade = ((n, name) for n, name in options.methods.items() if n not in kernels)
    idle = [Notice(f"--method {n}={name}: {n} is not generated") for n, name in unmade]
    unverified = () if certificate is None else certificate.notes
    said = (*replaced(draft), *_short(draft), *_left_open(draft))
    others = (*said, *_near_bounds(draft), *_out_of_ranges(draft), *dense_motions(draft, options))
    recorded = draft.notes if options.as_recorded else ()
    of_kernels = (*absent, *others, *_size(draft, options), *idle, *map(Notice, (*unverified, *recorded)))
    return (*_renamed(draft.model), *_friction(draft), *of_kernels, *_apart(draft, options), *_lacking(draft, options))


def _apart(draft: Draft, options: Options) -> Iterator[Notice]:
    """Which results have no function in common, because one of them is not made."""
    for group in draft.model.together if "c" in asked_for(options) else ():
        for scalar in options.scalars:
            made = {kernel.name for kernel in draft.programs[scalar].kernels}
            if missing := [name for name in group if name not in made]:
                yield Notice(f"no function has {' and '.join(group)} in {scalar}: {missing[0]} is not generated")


def _lacking(draft: Draft, options: Options) -> Iterator[Notice]:
    """What files for other tools cannot do without quantities that are not made."""
    made = frozenset(kernel.name for kernel in draft.program.kernels)
    for name in BACKENDS:
        lacks = backend(name).lacks if name in asked_for(options) else None
        if lacks is not None:
            yield from (Notice(f"{name}: {what}") for what in lacks(draft.model, made))


def _friction(draft: Draft) -> Iterator[Notice]:
    """How friction of reactions is worked out in the kernels that hold it."""
    both = (("inverse_dynamics", draft.model.friction_steps), ("forward_dynamics", draft.model.motion_steps))
    made = {kernel.name for kernel in draft.program.kernels}
    for quantity, steps in both:
        if draft.model.rough and steps is not None and quantity in made:
            how = "is explicit" if steps.explicit else f"takes {steps.steps} steps"
            share = f"it returns {steps.kappa:.2g} of the reactions at most, at {steps.points} configurations"
            yield Notice(f"{quantity}: friction of reactions {how}; {share} over the ranges")


def _renamed(model: Model) -> tuple[Notice, ...]:
    """That files and functions are not called as the model."""
    if model.c_name == model.name:
        return ()
    why = f"`{model.name}` clashes with a header, a library, a macro or what another model's files are called"
    return (Notice(f"its files and functions are called {model.c_name}: {why}"),)


def replaced(draft: Draft, quantities: Container[str] | None = None) -> tuple[Notice, ...]:
    """The quantities (None: all) that take another method than the cheapest, because verification rejected that."""
    replacements = []
    left_out = {one.quantity for one in draft.left_out}
    for choice in draft.derivations.choices:
        if choice.quantity in left_out or (quantities is not None and choice.quantity not in quantities):
            continue
        tried = [f"{r.method} ({r.why})" for r in draft.derivations.rejected if r.quantity == choice.quantity]
        if tried:
            others = ", ".join(tried)
            taken = choice.title + choice.digits
            replacements.append(Notice(f"{choice.quantity} takes {taken}: verification speaks against {others}"))
    return tuple(replacements)


def _short(draft: Draft) -> tuple[Notice, ...]:
    """That u cannot produce every motion."""
    generic = draft.derivations.generic
    asked = any(kernel.name == "inverse_dynamics" for kernel in draft.program.kernels)
    return (Notice(f"inverse_dynamics: {short_of_inputs(generic)}"),) if asked and not generic.full_actuation else ()


def _left_open(draft: Draft) -> Iterator[Notice]:
    """That a task does not determine the motion, and which one is taken."""
    names = [kernel.name for kernel in draft.program.kernels if ROWS[kernel.name].needs in (TASK_PLACES, TASK_RATES)]
    if names and draft.model.task_leaves.rates:
        norm = norm_of_motions(draft.model)
        yield Notice(f"{', '.join(names)}: {left_open(draft.model)}; of all motions the least is taken, {norm}")


def _size(draft: Draft, options: Options) -> tuple[Notice, ...]:
    """How much machine code the C takes, where small targets do not hold it: all but steps of tables is written out."""
    sizes = {kernel.name: _bytes(kernel) for kernel in draft.program.kernels}
    size = sum(sizes.values())
    if size <= LARGEST_CODE or "c" not in asked_for(options):
        return ()
    each = ", ".join(f"{name} {round(count / 1000)} kB" for name, count in sizes.items())
    return (
        Notice(
            f"the C takes about {round(size / 1000)} kB of machine code on a Cortex-M4 ({each}); where that is too "
            "much, name fewer with --outputs"
        ),
    )


def _near_bounds(draft: Draft) -> Iterator[Notice]:
    """That parameters may not be far from their values, where they may hardly be further than usual."""
    values = {name: abs(float(value)) for name, value in default_values(draft.model).items()}
    for quantity in (kernel.name for kernel in draft.program.kernels):
        below: dict[str, float] = {}
        above: dict[str, float] = {}
        # of both types the nearer bound is told
        for bound in (bound for every in draft.bounds.values() for bound in every.get(quantity, ())):
            name, size = bound.parameter, values[bound.parameter]
            if bound.low and bound.low * CLOSE_BY > size:
                below[name] = max(float(bound.low), below.get(name, 0.0))
            if bound.high and bound.high < size * CLOSE_BY:
                above[name] = min(float(bound.high), above.get(name, inf))
        sides = [("below", below), ("above", above)]
        beyond = ", ".join(f"{name} {side} {value:g}" for side, bounds in sides for name, value in bounds.items())
        if beyond:
            yield Notice(f"{quantity} refuses {beyond}: it would lose digits; a `range` has it verified further")


def _out_of_ranges(draft: Draft) -> Iterator[Notice]:
    """Where kernels refuse coordinates out of the ranges that the file states."""
    for quantity in (kernel.name for kernel in draft.program.kernels):
        ends: dict[tuple[str, str], float] = {}
        for bound in (bound for every in draft.coordinate_bounds.values() for bound in every.get(quantity, ())):
            if bound.low is not None:
                side = bound.coordinate, "below"
                ends[side] = max(float(bound.low), ends.get(side, -inf))
            if bound.high is not None:
                side = bound.coordinate, "above"
                ends[side] = min(float(bound.high), ends.get(side, inf))
        if ends:
            beyond = ", ".join(f"{name} {side} {value:g}" for (name, side), value in ends.items())
            why = "out of the range it would lose digits; a wider one has it verified further"
            yield Notice(f"{quantity} refuses {beyond}: {why}")


def _bytes(kernel: Kernel) -> int:
    if works_with_pairs(kernel):
        return BYTES_A_STEP * len(kernel.statements)
    return BYTES_AN_OPERATION * count_operations(kernel.statements).total
