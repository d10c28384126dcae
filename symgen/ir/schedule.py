"""From scalars of a graph to a straight-line kernel: order, names, thresholds.

Statements come depth first, operands just before the operation that needs them; see `order` for where that is too much.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from symgen.diagnostics import SymgenBug
from symgen.dynamics.catalogue import Derived
from symgen.dynamics.guards import Guard, magnitude, where_negligible
from symgen.dynamics.mechanics import Mechanics
from symgen.graph.angles import share_angles
from symgen.graph.scalar import Graph
from symgen.graph.scalar import Scalar as Node
from symgen.graph.traverse import topological
from symgen.ir.kernel import (
    UNIT_ROUNDOFF,
    Argument,
    Block,
    Check,
    Kernel,
    Literal,
    Load,
    Local,
    Operand,
    Program,
    Scalar,
    Statement,
    Status,
)
from symgen.ir.order import REGISTERS, relaxed, waits
from symgen.ir.sincos import angle_limit, sincos
from symgen.model.quantities import QUANTITIES
from symgen.records import dataclass

# The order in which statuses are reported (interface, section 4).
ORDER = (Status.ANGLE_RANGE, Status.CONSTRAINT_RANK, Status.MASS_RANK, Status.ACTUATION_RANK)
# Stands for the range of the sine and cosine until the scalar type is known; no name of a model has a blank.
ANGLE = "angle limit"
ARGUMENTS = {quantity.name: quantity.arguments for quantity in QUANTITIES}


def schedule(mechanics: Mechanics, quantities: Sequence[Derived], scalars: Sequence[Scalar]) -> dict[Scalar, Program]:
    """All quantities as kernels, for each scalar type.

    The order of statements is worked out once; the thresholds, which differ, are filled in last.
    """
    limits = _Limits(mechanics)
    kernels = [_ordered_kernel(mechanics, derived, limits) for derived in quantities]
    programs: dict[Scalar, Program] = {}
    for scalar in scalars:
        filler = _Filler(limits.values(scalar))
        filled = tuple(filler.kernel(kernel) for kernel in kernels)
        programs[scalar] = Program(scalar, sincos(scalar, limits.wide), filled)
    return programs


@dataclass(frozen=True, slots=True)
class _Test:
    """A guard with its limit as a scalar: passes where denominator > limit (or < -limit, hence `size`).

    `vanishes`: where it fails, the terms of `size` are 0 to rounding.
    """

    status: Status
    size: Node
    limit: Node
    first: tuple[_Test, ...]
    vanishes: bool


class _Limits:
    """The tests of guards, each made once, with named thresholds in place of numbers."""

    def __init__(self, mechanics: Mechanics) -> None:
        self.wide = mechanics.model.trig_range == "wide"
        self._mechanics = mechanics
        self._known: dict[Guard, _Test] = {}
        self._thresholds: dict[str, tuple[Guard, Fraction]] = {}

    def values(self, scalar: Scalar) -> dict[str, Literal]:
        """The numbers behind the names for one scalar type."""
        found = {
            name: Literal(_threshold(self._mechanics, guard, scalar) * factor)
            for name, (guard, factor) in self._thresholds.items()
        }
        return {ANGLE: Literal(angle_limit(scalar, self.wide)), **found}

    def tests(self, guards: Sequence[Guard]) -> list[_Test]:
        """The tests in the order in which statuses are reported."""
        return [self._test(guard) for guard in sorted(guards, key=_place)]

    def _test(self, guard: Guard) -> _Test:
        if guard not in self._known:
            graph = self._mechanics.graph
            scale = magnitude(graph, [guard.denominator])[0] if guard.scale is None else guard.scale
            size = guard.denominator if guard.degree == 2 else graph.function("abs", (guard.denominator,))
            first = tuple(self.tests(guard.first))
            if all(cause.status is guard.status and not cause.first for cause in first):
                first = ()  # nothing to tell apart
            # a denominator that is its own scale, such as a length, is negligible only where it is 0
            limit = graph.zero if scale is size else self._limit(guard, scale)
            # a model's own tolerance may be far above rounding
            vanishes = guard.degree == 2 and _own_tolerance(self._mechanics, guard) is None
            self._known[guard] = _Test(guard.status, size, limit, first, vanishes)
        return self._known[guard]

    def _limit(self, guard: Guard, scale: Node) -> Node:
        number = scale.args[0].constant if scale.op == "mul" else None
        if number is not None:
            scale = scale.args[1]
        constant = scale.constant if number is None else number
        factor = Fraction(1) if constant is None else constant
        # statuses of equal tolerance share a threshold, and with it what is computed from it
        name = f"threshold {_own_tolerance(self._mechanics, guard)} {guard.degree} {factor}"
        self._thresholds[name] = guard, factor
        threshold = self._mechanics.graph.symbol(name)
        return threshold if scale.constant is not None else threshold * scale


def _place(guard: Guard) -> int:
    """The place of a guard in `ORDER`: that of the earliest status it can lead to."""
    return min(ORDER.index(guard.status), *map(_place, guard.first)) if guard.first else ORDER.index(guard.status)


def _threshold(mechanics: Mechanics, guard: Guard, scalar: Scalar) -> Fraction:
    """8 n eps, squared for sums of squares; the model's own tolerance where it is larger."""
    value = (8 * mechanics.n * UNIT_ROUNDOFF[scalar]) ** guard.degree
    own = _own_tolerance(mechanics, guard)
    return max(value, own) if own is not None else value


def _own_tolerance(mechanics: Mechanics, guard: Guard) -> Fraction | None:
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


def _ordered_kernel(mechanics: Mechanics, derived: Derived, limits: _Limits) -> Kernel:
    """The kernel in which fewest values wait; what only a failure needs is computed there if registers run out."""
    kernel = relaxed(_kernel(mechanics, derived, limits))
    waiting = waits(kernel)
    if waiting < REGISTERS or not any(check.first for block in kernel.blocks for check in block.checks):
        return kernel
    apart = relaxed(_kernel(mechanics, derived, limits, apart=True))
    return apart if waits(apart) < waiting else kernel


def _kernel(mechanics: Mechanics, derived: Derived, limits: _Limits, apart: bool = False) -> Kernel:
    tests = limits.tests(derived.guards)
    roots = [node for test in tests for node in (test.size, test.limit)]
    regular = share_angles(mechanics.graph, [*derived.outputs, *roots])
    outputs = regular[: len(derived.outputs)]
    image = dict(zip(roots, regular[len(outputs) :], strict=True))
    writer = _Writer(mechanics, ARGUMENTS[derived.name], apart)
    order = topological(regular)
    arguments = _angles_among(order)
    # what only a failure looks at must not decide which angles a regular state evaluates
    causes = list(_causes(tests))
    image |= zip(causes, share_angles(mechanics.graph, causes, arguments), strict=True)
    tests = [_told(mechanics.graph, test, image) for test in tests]
    computed = [argument for argument in arguments if _angles([argument])]
    plain = [argument for argument in arguments if argument not in computed]
    blocks = [writer.angle_block(plain), Block(tuple(writer.pairs(plain, order)), ())]
    for test in tests:
        # a test stands before what needs it to pass: nothing is divided by a denominator that may be 0
        blocks += writer.late_angles([image[test.size], image[test.limit]], computed)
        statements = writer.write([image[test.size], image[test.limit]])
        blocks.append(Block(tuple(statements), (writer.check(test, image),)))
    blocks += writer.late_angles(outputs, computed)
    blocks.append(Block(tuple(writer.write(outputs)), ()))
    sizes = {"q": mechanics.n, "qd": mechanics.n, "qdd": mechanics.n, "u": mechanics.m}
    return Kernel(
        name=derived.name,
        arguments=tuple(Argument(name, sizes[name]) for name in ARGUMENTS[derived.name] if sizes[name]),
        loads=writer.loads(),
        blocks=tuple(blocks),
        outputs=tuple(writer.operand(node) for node in outputs),
        shape=derived.shape,
        remark=derived.remark,
    )


def _angles(outputs: Sequence[Node]) -> list[Node]:
    return _angles_among(topological(outputs))


def _angles_among(nodes: Sequence[Node]) -> list[Node]:
    return list(dict.fromkeys(node.args[0] for node in nodes if node.op in ("sin", "cos")))


def _causes(tests: Sequence[_Test]) -> list[Node]:
    return [node for test in tests for cause in test.first for node in (cause.size, cause.limit, *_causes([cause]))]


def _told(graph: Graph, test: _Test, image: dict[Node, Node]) -> _Test:
    """The test with causes as they are where it fails; what takes the place of a size is its own image."""
    if not test.vanishes or not test.first:
        return test
    sizes = where_negligible(graph, image[test.size], [image[cause.size] for cause in test.first])
    for size in sizes:
        image.setdefault(size, size)
    return replace(test, first=tuple(replace(c, size=size) for c, size in zip(test.first, sizes, strict=True)))


class _Writer:
    """Turns scalars into statements, each once per kernel."""

    def __init__(self, mechanics: Mechanics, arguments: Sequence[str], apart: bool) -> None:
        self._graph: Graph = mechanics.graph
        self._arguments = arguments
        self._apart = apart
        self._written: dict[Node, Operand] = {}
        self._pairs: dict[Node, tuple[str, str]] = {}
        self._done: dict[tuple[str, tuple[Operand, ...]], Local] = {}
        self._loads: dict[str, Load] = {}
        self._tested: set[Node] = set()
        self._symbols = _symbol_loads(mechanics)
        self._labels = {node: name for name, node in mechanics.definitions.items()}
        taken = set(self._symbols) | set(mechanics.definitions)
        self._taken = taken
        self._count = 0

    def loads(self) -> tuple[Load, ...]:
        """The inputs used, arguments first, each in order of its index."""
        order = {"q": 0, "qd": 1, "qdd": 2, "u": 3, "p": 4}
        return tuple(sorted(self._loads.values(), key=lambda load: (order[load.argument], load.index)))

    def operand(self, node: Node) -> Operand:
        """The operand of a node that has been written, or of a constant or an input."""
        if (value := node.constant) is not None:
            return Literal(value)
        if node.op == "symbol":
            load = self._symbols.get(str(node.payload))
            if load is None:
                # a threshold, whose number is filled in for each scalar type
                return Local(str(node.payload))
            if load.argument != "p" and load.argument not in self._arguments:
                raise SymgenBug(f"schedule: {node.payload} is not an argument of this kernel")
            self._loads[load.local] = load
            return Local(load.local)
        return self._written[node]

    def angle_block(self, arguments: Sequence[Node]) -> Block:
        """The arguments of sines and cosines that need no other sine or cosine, and the tests of their range."""
        statements = self.write(arguments)
        tests, checks = self.range_checks(arguments)
        return Block((*statements, *tests), checks)

    def pairs(self, arguments: Sequence[Node], order: Sequence[Node]) -> list[Statement]:
        """The sine/cosine pairs of known arguments among nodes: calls come first, while few values are alive."""
        known = set(arguments)
        return self.write([n for n in order if n.op in ("sin", "cos") and n.args[0] in known])

    def range_checks(self, arguments: Sequence[Node]) -> tuple[tuple[Statement, ...], tuple[Check, ...]]:
        """The tests of the range of angles."""
        sizes = [self._graph.raw("abs", (argument,)) for argument in arguments]
        statements = self.write(sizes)
        checks = tuple(Check(Status.ANGLE_RANGE, Local(ANGLE), self.operand(size), inclusive=True) for size in sizes)
        return tuple(statements), checks

    def late_angles(self, outputs: Sequence[Node], computed: Sequence[Node]) -> list[Block]:
        """The blocks of those `computed` arguments that the outputs need and that no earlier block has tested."""
        needed = set(_angles(outputs)) if computed else ()
        blocks = []
        for argument in computed:
            if argument in needed and argument not in self._tested:
                self._tested.add(argument)
                tests, checks = self.range_checks([argument])
                blocks.append(Block(tests, checks))
        return blocks

    def check(self, test: _Test, image: Mapping[Node, Node]) -> Check:
        """The check of a test; what only a failure needs is written into its own block."""
        first = None
        if test.first:
            saved = dict(self._written), dict(self._pairs), dict(self._done), self._labels
            apart, self._apart = self._apart, False
            if apart:
                self._written = {n: value for n, value in self._written.items() if n.op in ("sin", "cos")}
                self._done, self._labels = {}, {}
            inner = [image[node] for t in test.first for node in (t.size, t.limit)]
            angles = [angle for angle in _angles(inner) if angle not in self._pairs]
            statements = self.write(inner)
            sizes, ranges = self.range_checks(angles)
            first = Block((*statements, *sizes), (*ranges, *(self.check(t, image) for t in test.first)))
            self._written, self._pairs, self._done, self._labels = saved
            self._apart = apart
        size, limit = self.operand(image[test.size]), self.operand(image[test.limit])
        return Check(test.status, size, limit, first=first, apart=self._apart and first is not None)

    def write(self, outputs: Sequence[Node]) -> list[Statement]:
        """The statements that are still missing for the outputs."""
        statements: list[Statement] = []
        for node in topological(outputs, self._written):
            if node in self._written or node.op in ("const", "symbol"):
                # a pair writes both its values, so the second one may be known by now
                continue
            if node.op in ("sin", "cos"):
                statements += self._pair(node)
            else:
                statements += self._plain(node)
        for output in outputs:
            self.operand(output)
        return statements

    def _plain(self, node: Node) -> list[Statement]:
        """The node's statement, or none where the same operation on the same operands stands already."""
        operands = tuple(self.operand(argument) for argument in node.args)
        if node.op == "pow":
            assert isinstance(node.payload, Fraction)
            operands = (*operands, Literal(node.payload))
        done = self._done.get((node.op, operands))
        if done is not None:
            self._written[node] = done
            return []
        target = self._name(node)
        self._written[node] = self._done[node.op, operands] = Local(target)
        return [Statement((target,), node.op, operands)]  # type: ignore[arg-type]

    def _pair(self, node: Node) -> list[Statement]:
        """The sine/cosine pair of an angle, once; its other value needs no statement."""
        (angle,) = node.args
        known = self._pairs.get(angle)
        if known is None:
            sine, cosine = (self._graph.trig(op, angle) for op in ("sin", "cos"))
            known = self._pairs[angle] = self._name(sine), self._name(cosine)
            self._written[node] = Local(known[node.op == "cos"])
            return [Statement(known, "sincos", (self.operand(angle),))]
        self._written[node] = Local(known[node.op == "cos"])
        return []

    def _name(self, node: Node) -> str:
        if (label := self._labels.get(node)) is not None:
            return label
        while True:
            self._count += 1
            name = f"t{self._count}"
            if name not in self._taken:
                return name


def _symbol_loads(mechanics: Mechanics) -> dict[str, Load]:
    model = mechanics.model
    loads: dict[str, Load] = {}
    for i, c in enumerate(model.coordinates):
        loads[c.name] = Load(c.name, "q", i)
        loads[c.rate] = Load(c.rate, "qd", i)
        loads[c.acceleration] = Load(c.acceleration, "qdd", i)
    for i, given in enumerate(model.inputs):
        loads[given.name] = Load(given.name, "u", i)
    for i, parameter in enumerate(model.parameters):
        loads[parameter.name] = Load(parameter.name, "p", i, parameter.name)
    return loads
