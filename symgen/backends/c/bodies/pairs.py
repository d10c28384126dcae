"""The portable sine and cosine in C: one angle at a time, or all angles of a kernel in the lanes of a vector.

A loop of constant count over local arrays is what gcc -O2 and clang turn into vector code; every lane performs the same
operations as the function of one angle, so the bits are the same on processors with and without vectors.
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.backends.c.statements import c_helper
from symgen.backends.scalars import C_TYPE
from symgen.ir.kernel import Block, Function, Kernel, Program, Scalar, Statement
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.naming import macro_name
from symgen.records import dataclass

# Values in a vector of 16 bytes, which every 64-bit processor has.
LANES: dict[Scalar, int] = {"float64": 2, "float32": 4}
# From so many angles on, vectors take fewer instructions than one angle after the other.
SMALLEST_GROUP = 2
GROUP_NAMES = ("angle", "sine", "cosine")


@dataclass(frozen=True, slots=True)
class PairsView:
    """What the template of the source file prints: the body of the pair, and which functions call it.

    `single` and `group` name the functions of one and of several angles, empty where no kernel calls them; `pair` is
    the inlined body with parameter `angle`.  `kind` and `unroll` name macros that say how the group is compiled.
    """

    pair: str
    angle: str
    body: tuple[str, ...]
    single: str
    group: str
    inline: str
    lanes: str
    kind: str
    unroll: str
    count: int


def pairs_view(name: str, suffix: str, program: Program) -> PairsView | None:
    """The functions of a file whose names begin with `name`; None where no kernel has a portable pair."""
    if program.sincos is None:
        return None
    blocks = [block for kernel in program.kernels for block in kernel.blocks]
    groups = [group for kernel in program.kernels if (group := leading_group(kernel))]
    grouped = {id(statement) for group in groups for statement in group}
    single = any(_has_single(block, grouped) for block in blocks)
    if not single and not groups:
        return None
    pair = f"{name}_pair{suffix}"
    angle, body = pair_body(program.scalar, program.sincos, pair)
    return PairsView(
        pair=pair,
        angle=angle,
        body=body,
        single=f"{name}_sincos{suffix}" if single else "",
        group=f"{name}_sincos_group{suffix}" if groups else "",
        inline=macro_name(name) + f"_inline{suffix}".upper(),
        lanes=macro_name(name) + f"_lanes{suffix}".upper(),
        kind=macro_name(name) + f"_group{suffix}".upper(),
        unroll=macro_name(name) + f"_unroll{suffix}".upper(),
        count=LANES[program.scalar],
    )


def pair_names(name: str, suffix: str) -> set[str]:
    """Every name that `pairs_view` may give to a file."""
    functions = {f"{name}_{tail}{suffix}" for tail in ("pair", "sincos", "sincos_group")}
    macros = (f"_{tail}{suffix}".upper() for tail in ("inline", "lanes", "group", "unroll"))
    return functions | {macro_name(name) + macro for macro in macros}


def pair_body(scalar: Scalar, function: Function, name: str) -> tuple[str, tuple[str, ...]]:
    """Parameter and lines of the function `name` that sets `*sine` and `*cosine`."""
    made = c_helper(scalar, function, {"sine", "cosine", name})
    sine, cosine = made.results
    return made.parameters[0], (*made.body, f"*sine = {sine};", f"*cosine = {cosine};")


def leading_group(kernel: Kernel) -> tuple[Statement, ...]:
    """The pairs that stand side by side before anything needs one of them; empty if too few."""
    if works_with_pairs(kernel):
        return ()
    for block in kernel.blocks:
        for place, statement in enumerate(block.statements):
            if statement.operation == "sincos":
                group = _run(block.statements[place:])
                return group if len(group) >= SMALLEST_GROUP else ()
    return ()


def group_lines(scalar: Scalar, function: str, angles: Sequence[str]) -> tuple[str, ...]:
    """The call for several angles; the last angle fills the last vector, so that no new value enters."""
    kind, lanes = C_TYPE[scalar], LANES[scalar]
    filled = [*angles, *[angles[-1]] * (-len(angles) % lanes)]
    values, sines, cosines = GROUP_NAMES
    return (
        f"const {kind} {values}[{len(filled)}] = {{{', '.join(filled)}}};",
        f"{kind} {sines}[{len(filled)}];",
        f"{kind} {cosines}[{len(filled)}];",
        f"{function}({len(angles)}, {values}, {sines}, {cosines});",
    )


def _run(statements: Sequence[Statement]) -> tuple[Statement, ...]:
    run: list[Statement] = []
    for statement in statements:
        if statement.operation != "sincos":
            break
        run.append(statement)
    return tuple(run)


def _has_single(block: Block, grouped: set[int]) -> bool:
    inner = [check.first for check in block.checks if check.first is not None]
    own = any(s.operation == "sincos" and id(s) not in grouped for s in block.statements)
    return own or any(_has_single(first, grouped) for first in inner)
