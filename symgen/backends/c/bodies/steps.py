"""Kernels that work with pairs of numbers, in C: tables of steps, and a function that runs through them.

An operation on pairs is some thirty of the processor's.  Written out as calls, a kernel of ten thousand takes compilers
a minute and two gigabytes, and a microcontroller five times the flash; a step of a table is 14 bytes.  Values lie in an
array, where one takes the place of another that is not read any more.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from heapq import heappop, heappush

from symgen.backends.c.statements import CStatements, c_helper, c_literal
from symgen.backends.scalars import C_TYPE
from symgen.ir.kernel import Kernel, Literal, Operand, OperationName, Program, Scalar
from symgen.ir.pairs.wide_functions import is_wide_operation, wide_function, works_with_pairs
from symgen.ir.split import names_in, names_of_check
from symgen.records import dataclass

# Of a step: what it sets and what it reads at most.
_SET, _READ = 2, 4
_VALUES = "v"
TABLE = _STEP = "step"  # the name of a table inside of a function


@dataclass(frozen=True, slots=True)
class WideFunction:
    """A function of pairs of numbers: its name, parameters, body, and what stands in its result."""

    name: str
    parameters: tuple[str, ...]
    body: tuple[str, ...]
    value: str
    rest: str


@dataclass(frozen=True, slots=True)
class StepCase:
    """What a step of an operation does."""

    number: int
    operation: str
    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class StepsView:
    """What stands in a file before its kernels: the types of pairs and steps, and what runs steps."""

    pair: str
    step: str
    run: str
    functions: tuple[WideFunction, ...]
    sines: bool
    cases: tuple[StepCase, ...]


@dataclass(frozen=True, slots=True)
class StepTable:
    """The steps of a kernel, rows of the number of an operation and of places; `parts` are those of each block.

    `constants` are the first of the `size` values, `spelled` is where each local is while it is needed.
    """

    scalar: Scalar
    rows: tuple[tuple[int, ...], ...]
    parts: tuple[range, ...]
    constants: tuple[str, ...]
    spelled: Mapping[str, str]
    size: int

    def lines(self, kind: str) -> Iterator[str]:
        """Their declarations, up to the constants in their places; `kind` is the type of a step.

        Constants are set one by one: copied from a table, compilers would call memcpy, and kernels call no library.
        """
        scalar = C_TYPE[self.scalar]
        if self.rows:
            yield f"static const {kind} {_STEP}[{len(self.rows)}] = {{"
            for number, *places in self.rows:
                parts = (", ".join(map(str, part)) for part in (places[:_SET], places[_SET:]))
                yield f"    {{{number}, {', '.join(f'{{{part}}}' for part in parts)}}},"
            yield "};"
        yield f"{scalar} {_VALUES}[{max(1, self.size)}];"
        yield from (f"{_VALUES}[{place}] = {text};" for place, text in enumerate(self.constants))


def steps_view(name: str, suffix: str, program: Program) -> StepsView | None:
    """What a file needs whose names begin with `name`; None where no kernel works with pairs of numbers."""
    used = _operations(program)
    if not used:
        return None
    pair = f"{name}_wide{suffix}"
    printer = CStatements(program.scalar, {}, frozenset())
    sines = None if program.sincos is None else f"{name}_sincos{suffix}"
    return StepsView(
        pair=pair,
        step=f"{name}_step{suffix}",
        run=f"{name}_steps{suffix}",
        functions=tuple(_function(one, program.scalar, pair) for one in used if is_wide_operation(one)),
        sines="sincos" in used,
        cases=tuple(StepCase(k, one, tuple(_case(one, printer, pair, sines))) for k, one in enumerate(used)),
    )


def step_names(name: str, suffix: str) -> set[str]:
    """Every name that `steps_view` may give to a file."""
    tails = ("wide", "step", "steps", *(f"wide{suffix}_{tail}" for tail in _TAILS))
    return {f"{name}_{tail}{suffix if tail in tails[:3] else ''}" for tail in tails}


def local_names(program: Program) -> set[str]:
    """Names that tables need inside of functions."""
    needed = any(map(works_with_pairs, program.kernels))
    return {_VALUES, _STEP, "pair"} if needed else set()


def table(kernel: Kernel, program: Program) -> StepTable:
    """The steps of a kernel of a program."""
    numbers = {operation: number for number, operation in enumerate(_operations(program))}
    statements = kernel.statements
    constants = [o for s in statements for o in s.operands if isinstance(o, Literal)]
    places = _Places(kernel, tuple(dict.fromkeys(constants)))
    rows: list[tuple[int, ...]] = []
    parts = []
    for block in kernel.blocks:
        start = len(rows)
        for statement in block.statements:
            read = [places.read(operand, len(rows)) for operand in statement.operands]
            written = [places.put(target, len(rows)) for target in statement.targets]
            row = (*written, *[0] * (_SET - len(written)), *read, *[0] * (_READ - len(read)))
            rows.append((numbers[statement.operation], *row))
        parts.append(range(start, len(rows)))
    texts = tuple(c_literal(program.scalar, one.value).strip("()") for one in places.constants)
    spelled = {name: f"{_VALUES}[{place}]" for name, place in places.of.items()}
    return StepTable(program.scalar, tuple(rows), tuple(parts), texts, spelled, places.size)


class _Places:
    """Places in the array of values; one is free after what lies there was read for the last time."""

    def __init__(self, kernel: Kernel, constants: tuple[Literal, ...]) -> None:
        self.constants = constants
        self.size = len(constants)
        self.of: dict[str, int] = {}
        self._fixed = {literal: place for place, literal in enumerate(constants)}
        self._last = _last_uses(kernel)
        self._free: list[int] = []
        self._ending: list[tuple[int, int]] = []
        for load in kernel.loads:
            self.put(load.local, -1)

    def read(self, operand: Operand, now: int) -> int:
        """Where an operand is."""
        self._release(now)
        return self._fixed[operand] if isinstance(operand, Literal) else self.of[operand.name]

    def put(self, name: str, now: int) -> int:
        """Where a value is put that is known from now on."""
        self._release(now)
        if self._free:
            place = heappop(self._free)
        else:
            place = self.size
            self.size += 1
        self.of[name] = place
        heappush(self._ending, (max(self._last.get(name, now), now), place))
        return place

    def _release(self, now: int) -> None:
        while self._ending and self._ending[0][0] < now:
            heappush(self._free, heappop(self._ending)[1])


def _last_uses(kernel: Kernel) -> dict[str, int]:
    """The number of the statement that reads a local last, or behind which the last check does."""
    last: dict[str, int] = {}
    count = 0
    for block in kernel.blocks:
        for statement in block.statements:
            last |= dict.fromkeys(names_in(statement.operands), count)
            count += 1
        for check in block.checks:
            last |= dict.fromkeys(names_of_check(check), count)
    return last | dict.fromkeys(names_in(kernel.outputs), count)


def _operations(program: Program) -> tuple[OperationName, ...]:
    kernels = [kernel for kernel in program.kernels if works_with_pairs(kernel)]
    return tuple(sorted({statement.operation for kernel in kernels for statement in kernel.statements}))


def _case(operation: OperationName, printer: CStatements, pair: str, sines: str | None) -> Iterator[str]:
    read = [f"{_VALUES}[of[{k}]]" for k in range(_READ)]
    first, second = (f"{_VALUES}[to[{k}]]" for k in range(_SET))
    if is_wide_operation(operation):
        given = read[: len(wide_function(operation).parameters)]
        yield f"pair = {_wide_name(pair, operation)}({', '.join(given)});"
        yield f"{first} = pair.value;"
        yield f"{second} = pair.rest;"
    elif operation != "sincos":
        yield f"{first} = {printer.expression(operation, read[:_ARITIES.get(operation, 1)])};"
    elif sines is not None:
        yield f"{sines}({read[0]}, &sine, &cosine);"
        yield f"{first} = sine;"
        yield f"{second} = cosine;"
    else:
        yield f"sine = {printer.function('sin')}({read[0]});"
        yield f"cosine = {printer.function('cos')}({read[0]});"
        yield f"{first} = sine;"
        yield f"{second} = cosine;"


_TAILS = ("add", "sub", "mul", "div", "ratio_or_zero", "sqrt")
_ARITIES: dict[OperationName, int] = dict.fromkeys(
    ("add", "sub", "mul", "div", "copysign", "ratio_or_zero", "min", "max", "atan2", "pow"), 2
)


def _wide_name(pair: str, operation: OperationName) -> str:
    return pair + operation.removeprefix("wide")


def _function(operation: OperationName, scalar: Scalar, pair: str) -> WideFunction:
    made = c_helper(scalar, wide_function(operation, scalar), {"pair"})
    parameters = tuple(f"const {C_TYPE[scalar]} {one}" for one in made.parameters)
    return WideFunction(_wide_name(pair, operation), parameters, made.body, *made.results)
