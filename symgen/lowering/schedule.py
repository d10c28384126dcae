"""From scalars of a graph to a straight-line kernel: order, names, thresholds.

Statements come depth first, operands just before the operation that needs them; see `order` for where that is too much.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from symgen.ir.constants import with_constants_evaluated
from symgen.ir.kernel import (
    UNIT_ROUNDOFF,
    Argument,
    Block,
    Check,
    Kernel,
    Literal,
    Local,
    Operand,
    Program,
    Scalar,
    Statement,
    Status,
)
from symgen.ir.lifted import Kind, Lifted, Meant, same_kernel
from symgen.ir.order import REGISTERS, relaxed, waits
from symgen.ir.sincos import angle_limit, sincos
from symgen.linear_algebra.guards import Guard, lost_only_at_zero, magnitude, where_negligible
from symgen.lowering.writer import ANGLE, ScalarWriter, Test, angles_among, angles_of
from symgen.mechanics.system import System
from symgen.methods.quantity import Quantity
from symgen.model.quantities import ROWS
from symgen.runtime.activity import each
from symgen.symbolic.angles.sharing import share_angles
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar as Node
from symgen.symbolic.traverse import topological

# The order in which statuses are reported (interface, section 4).
ORDER = (
    Status.ANGLE_RANGE,
    Status.CONSTRAINT_RANK,
    Status.MASS_RANK,
    Status.ACTUATION_RANK,
    Status.MEASURED_RANK,
    Status.TASK_RANK,
    Status.BRANCH,
    Status.NOT_CLOSED,
    Status.LIMITS,
    Status.FRICTION_LOCK,
)


def schedule(mechanics: System, quantities: Sequence[Quantity], scalars: Sequence[Scalar]) -> dict[Scalar, Program]:
    """All quantities as kernels, for each scalar type.

    The order of statements is worked out once; the thresholds, which differ, are filled in last.
    """
    limits = _GuardTests(mechanics)
    named = each("statements", quantities, lambda one: one.name)
    kernels = tuple(_ordered_kernel(mechanics, derived, limits) for derived in named)
    programs: dict[Scalar, Program] = {}
    for scalar in scalars:
        filler = _Filler(limits.values(scalar))
        programs[scalar] = Program(scalar, sincos(scalar, limits.wide), tuple(map(filler.kernel, kernels)))
    return programs


class _GuardTests:
    """The tests of guards, each made once, with named thresholds in place of numbers."""

    def __init__(self, mechanics: System) -> None:
        self.wide = mechanics.model.trig_range == "wide"
        self._mechanics = mechanics
        self._known: dict[Guard, Test] = {}
        self._thresholds: dict[str, tuple[Guard, Fraction]] = {}

    def values(self, scalar: Scalar) -> dict[str, Literal]:
        """The numbers behind the names for one scalar type."""
        thresholds = {
            name: Literal(_threshold(self._mechanics, guard, scalar) * factor)
            for name, (guard, factor) in self._thresholds.items()
        }
        return {ANGLE: Literal(angle_limit(scalar, self.wide)), **thresholds}

    def tests(self, guards: Sequence[Guard]) -> list[Test]:
        """The tests in the order in which statuses are reported, but each behind those of what it divides by."""
        ordered = sorted(guards, key=_place)
        needed = self._needed(ordered)
        placed: dict[Guard, Test] = {}
        stack = list(reversed(ordered))
        while stack:
            guard = stack.pop()
            if guard in placed:
                continue
            if before := needed.pop(guard, ()):
                stack += [guard, *reversed(before)]
            else:
                placed[guard] = self._test(guard)
        return list(placed.values())

    def _needed(self, ordered: Sequence[Guard]) -> dict[Guard, list[Guard]]:
        """By guard, the first one of each denominator that it divides by where no guard before it does."""
        of_denominators = {guard.denominator: guard for guard in reversed(ordered)}
        needed: dict[Guard, list[Guard]] = {}
        known: set[Node] = set()
        for guard in ordered:
            test = self._test(guard)
            nodes = topological((test.size, test.limit), known)
            known.update(nodes)
            divided = (of_denominators.get(node.args[1]) for node in nodes if node.op in ("div", "ratio_or_zero"))
            needed[guard] = [one for one in divided if one is not None]
        return needed

    def _test(self, guard: Guard) -> Test:
        if guard not in self._known:
            graph = self._mechanics.graph
            signed = guard.degree == 1 and not guard.positive
            size = graph.function("abs", (guard.denominator,)) if signed else guard.denominator
            if guard.small:
                self._known[guard] = Test(guard.status, self._limit(guard), size, (), vanishes=False)
                return self._known[guard]
            first = tuple(self.tests(guard.first))
            if all(cause.status is guard.status and not cause.first for cause in first):
                first = ()  # nothing to tell apart
            # what is its own scale, such as a length or a product of masses, is negligible only where it is 0
            whole = guard.scale is size or lost_only_at_zero(guard)
            limit = graph.zero if whole else self._limit(guard)
            # a model's own tolerance may be far above rounding
            vanishes = guard.degree == 2 and _own_tolerance(self._mechanics, guard) is None
            self._known[guard] = Test(guard.status, size, limit, first, vanishes)
        return self._known[guard]

    def _limit(self, guard: Guard) -> Node:
        scale = magnitude(self._mechanics.graph, [guard.denominator])[0] if guard.scale is None else guard.scale
        number = scale.args[0].constant if scale.op == "mul" else None
        if number is not None:
            scale = scale.args[1]
        constant = scale.constant if number is None else number
        factor = Fraction(1) if constant is None else constant
        # guards of equal thresholds share them, and what is computed from them
        both = [_threshold(self._mechanics, guard, scalar) for scalar in UNIT_ROUNDOFF]
        name = f"threshold {both} {factor}"
        self._thresholds[name] = guard, factor
        threshold = self._mechanics.graph.symbol(name)
        return threshold if scale.constant is not None else threshold * scale


def _place(guard: Guard) -> int:
    """The place of a guard in `ORDER`: that of the earliest status it can lead to."""
    return min(ORDER.index(guard.status), *map(_place, guard.first)) if guard.first else ORDER.index(guard.status)


def _threshold(mechanics: System, guard: Guard, scalar: Scalar) -> Fraction:
    """What rounding leaves of it; the model's own tolerance where it is larger."""
    value = guard.threshold(mechanics.n, UNIT_ROUNDOFF[scalar])
    own = _own_tolerance(mechanics, guard)
    return max(value, own) if own is not None else value


def _own_tolerance(mechanics: System, guard: Guard) -> Fraction | None:
    """What the model itself sets for the status of a guard."""
    model = mechanics.model
    return {
        Status.CONSTRAINT_RANK: model.constraint_rank_tolerance,
        Status.ACTUATION_RANK: model.actuation_rank_tolerance,
    }.get(guard.status)


class _Filler:
    """Puts numbers in the place of named thresholds."""

    def __init__(self, values: Mapping[str, Literal]) -> None:
        self._values = values

    def kernel(self, kernel: Kernel) -> Kernel:
        """The kernel for one scalar type."""
        return replace(kernel, blocks=tuple(map(self._block, kernel.blocks)))

    def _block(self, block: Block) -> Block:
        return Block(tuple(map(self._statement, block.statements)), tuple(map(self._check, block.checks)))

    def _statement(self, statement: Statement) -> Statement:
        if not any(type(o) is Local and o.name in self._values for o in statement.operands):
            return statement
        return replace(statement, operands=tuple(map(self._operand, statement.operands)))

    def _check(self, check: Check) -> Check:
        first = None if check.first is None else self._block(check.first)
        return replace(check, value=self._operand(check.value), limit=self._operand(check.limit), first=first)

    def _operand(self, operand: Operand) -> Operand:
        return self._values.get(operand.name, operand) if isinstance(operand, Local) else operand


def _ordered_kernel(mechanics: System, derived: Quantity, limits: _GuardTests) -> Kernel:
    """The kernel in which fewest values wait; what only a failure needs is computed there if registers run out."""
    kernel = _kernel(mechanics, derived, limits)
    waiting = waits(kernel)
    if waiting < REGISTERS or not any(check.first for block in kernel.blocks for check in block.checks):
        return kernel
    apart = _kernel(mechanics, derived, limits, apart=True)
    return apart if waits(apart) < waiting else kernel


def _kernel(mechanics: System, derived: Quantity, limits: _GuardTests, apart: bool = False) -> Kernel:
    tests = limits.tests(derived.guards)
    roots = [node for test in tests for node in (test.size, test.limit)]
    regular = share_angles(mechanics.graph, [*derived.outputs, *roots])
    outputs = regular[: len(derived.outputs)]
    image = dict(zip(roots, regular[len(outputs) :], strict=True))
    writer = ScalarWriter(mechanics, ROWS[derived.name].arguments, apart)
    order = topological(regular)
    arguments = angles_among(order)
    # what only a failure looks at must not decide which angles a regular state evaluates
    causes = list(_causes(tests))
    image |= zip(causes, share_angles(mechanics.graph, causes, arguments), strict=True)
    tests = [_with_causes(mechanics.graph, test, image) for test in tests]
    computed = [argument for argument in arguments if angles_of([argument])]
    plain = [argument for argument in arguments if argument not in computed]
    blocks = [writer.angle_block(plain), Block(tuple(writer.pairs(plain, order)), ())]
    for test in tests:
        # a test stands before what needs it to pass: nothing is divided by a denominator that may be 0
        blocks += writer.late_angles([image[test.size], image[test.limit]], computed)
        statements = writer.write([image[test.size], image[test.limit]])
        blocks.append(Block(tuple(statements), (writer.check(test, image),)))
    blocks += writer.late_angles(outputs, computed)
    blocks.append(Block(tuple(writer.write(outputs)), ()))
    written = Kernel(
        name=derived.name,
        arguments=_arguments(mechanics, derived.name),
        loads=writer.loads(),
        blocks=tuple(blocks),
        outputs=tuple(writer.operand(node) for node in outputs),
        shape=derived.shape,
        remark=derived.remark,
    )
    kernel = relaxed(written)
    same_kernel(f"writing the statements of {derived.name}", _meant(outputs, tests, image), Lifted(kernel))
    return with_constants_evaluated(kernel)


def _meant(outputs: Sequence[Node], tests: Sequence[Test], image: Mapping[Node, Node]) -> Meant[Node]:
    """What a kernel is to compute and to test."""
    kinds: list[Kind] = []
    compared: list[Node] = []
    stack = [(test, 0) for test in reversed(tests)]
    while stack:
        test, depth = stack.pop()
        kinds.append((test.status, False, depth))
        compared += [image[test.size], image[test.limit]]
        stack += [(cause, depth + 1) for cause in reversed(test.first)]
    return Meant(tuple(outputs), tuple(kinds), tuple(compared))


def _arguments(mechanics: System, quantity: str) -> tuple[Argument, ...]:
    n, m = mechanics.n, mechanics.m
    sizes = Argument("q", n), Argument("qd", n), Argument("qdd", n), Argument("u", m)
    further = (Argument(one.name, len(one.places), one.places) for one in mechanics.model.further_arguments)
    every = {argument.name: argument for argument in (*sizes, *further)}
    return tuple(every[name] for name in ROWS[quantity].arguments if every[name].length)


def _causes(tests: Sequence[Test]) -> list[Node]:
    return [node for test in tests for cause in test.first for node in (cause.size, cause.limit, *_causes([cause]))]


def _with_causes(graph: Graph, test: Test, image: dict[Node, Node]) -> Test:
    """The test with causes as they are where it fails; what takes the place of a size is its own image."""
    if not test.vanishes or not test.first:
        return test
    sizes = where_negligible(graph, image[test.size], [image[cause.size] for cause in test.first])
    for size in sizes:
        image.setdefault(size, size)
    return replace(test, first=tuple(replace(c, size=size) for c, size in zip(test.first, sizes, strict=True)))
