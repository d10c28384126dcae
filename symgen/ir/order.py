"""The order of statements, so that few values wait.

Operands just before the operation that needs them, tests first: so the schedule writes a kernel, and so compilers put
it, for between two tests they move what has one use to its user.  A value that waits across a test stays where it was
written, in a register while there are some, else on the stack.  Where more values wait than there are registers, this
module looks for a better order: from the last step to the first, always the step that makes the fewest values wait
(list scheduling; Muchnick, Advanced Compiler Design and Implementation, chapter 17).  A step is a test, or an
expression of which no part has another use.  A test may stand anywhere before what it protects: what is divided by its
denominator, or what the schedule put behind it for another reason (a root, a library function, a denominator of
states that is not tested).

The operations are the same, on the same operands: results have the same bits, and statuses the same order.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from symgen.ir.kernel import Block, Check, Kernel, Local, Statement
from symgen.ir.split import names_in, names_of_check

# Registers of a scalar each in x86-64; 32-bit ARM has as many of float64.  One is needed to compute in.
REGISTERS = 16
# Statements beyond which a kernel keeps its order: looking for another takes longer than it saves.
LONGEST_REORDERED = 1000
# The blocks of angles and of their pairs, which stay at the head.
_HEAD = 2
_ANYWHERE = frozenset({"add", "sub", "mul", "neg", "abs", "copysign", "min", "max", "ratio_or_zero"})


def relaxed(kernel: Kernel) -> Kernel:
    """The kernel in an order in which fewer values wait, where they do not fit into registers; else itself."""
    if not _is_ordered(kernel):
        return kernel
    body = _TestedSteps(kernel)
    waiting = body.waiting(body.written)
    if waiting < REGISTERS:
        return kernel
    order = body.backwards()
    return body.kernel(order) if body.waiting(order) < waiting else kernel


def waits(kernel: Kernel) -> int:
    """How many values wait at once in a kernel whose order is looked at; 0 for others."""
    if not _is_ordered(kernel):
        return 0
    body = _TestedSteps(kernel)
    return body.waiting(body.written)


def _is_ordered(kernel: Kernel) -> bool:
    late = any(s.operation == "sincos" for block in kernel.blocks[_HEAD:] for s in block.statements)
    # without tests nothing waits across one: compilers find orders of their own, and from the written one better ones
    tested = any(block.checks for block in kernel.blocks[_HEAD:])
    return tested and not late and REGISTERS < len(kernel.statements) <= LONGEST_REORDERED


class _TestedSteps:
    """What follows the pairs of a kernel.  Steps are numbered: statements from 0 as they are written, then checks."""

    def __init__(self, kernel: Kernel) -> None:
        self._kernel = kernel
        self._checks: list[Check] = []
        self._statements: list[Statement] = []
        self.written: list[int] = []
        passed: list[int] = []
        blocks = kernel.blocks[_HEAD:]
        self.count = sum(len(block.statements) for block in blocks)
        for block in blocks:
            for statement in block.statements:
                self.written.append(len(self._statements))
                passed.append(len(self._checks))
                self._statements.append(statement)
            for check in block.checks:
                self.written.append(self.count + len(self._checks))
                self._checks.append(check)
        self._steps = {statement.targets[0]: step for step, statement in enumerate(self._statements)}
        read = [names_in(s.operands) for s in self._statements] + [names_of_check(check) for check in self._checks]
        # those from which each step reads; pairs and arguments of the kernel lie in memory and wait for nothing
        self.sources = [sorted(self._steps[name] for name in names if name in self._steps) for names in read]
        self._results = [self._steps[o.name] for o in kernel.outputs if isinstance(o, Local) and o.name in self._steps]
        self.uses = Counter(source for sources in self.sources for source in sources)
        self.uses.update(set(self._results))
        self.behind = self._behind(passed)

    def _behind(self, passed: Sequence[int]) -> list[int]:
        """How many checks must stand before each statement."""
        tested = self._tested()
        fixed = {load.local for load in self._kernel.loads if load.argument == "p"}
        behind: list[int] = []
        for step, statement in enumerate(self._statements):
            own = 0
            alone = fixed.issuperset(names_in(statement.operands))
            if alone:
                fixed.update(statement.targets)
            if statement.operation == "div" and isinstance(divisor := statement.operands[1], Local):
                own = min(passed[step], tested.get(divisor.name, 0 if alone else passed[step]))
            elif statement.operation not in _ANYWHERE:
                own = passed[step]
            behind.append(max([own, *(behind[source] for source in self.sources[step])]))
        return behind

    def _tested(self) -> dict[str, int]:
        """The number of the check that decides on a value or its magnitude."""
        tested: dict[str, int] = {}
        for number, check in enumerate(self._checks, 1):
            if isinstance(check.value, Local):
                tested.setdefault(check.value.name, number)
                step = self._steps.get(check.value.name)
                if step is not None and self._statements[step].operation == "abs":
                    tested |= {name: number for name in names_in(self._statements[step].operands) if name not in tested}
        return tested

    def waiting(self, order: Sequence[int]) -> int:
        """The largest number of values that wait for their use at once."""
        left = [self.uses[step] for step in range(len(self.sources))]
        alive = largest = 0
        for step in order:
            for source in self.sources[step]:
                left[source] -= 1
                alive -= not left[source]
            alive += left[step] > 0
            largest = max(largest, alive)
        return largest

    def backwards(self) -> list[int]:
        """The order found from its end: of the steps that nothing else needs first, the one that adds least to wait.

        Of equal ones a check stands last, then the longest expression, then the one written last.
        """
        trees = self._trees()
        reads = {
            step: {s for part in tree for s in self.sources[part]}.difference(tree) for step, tree in trees.items()
        }
        needs = {step: [*sources, *self._checks_before(step)] for step, sources in reads.items()}
        users = Counter(need for step in needs for need in needs[step])
        readers: dict[int, list[int]] = {}
        for step, sources in reads.items():
            for source in sources:
                readers.setdefault(source, []).append(step)
        # what a step adds to the values that wait; the last places of the key decide between equal ones
        added = {step: len(sources) for step, sources in reads.items()}
        key = {step: (step < self.count, -len(tree), -step) for step, tree in trees.items()}
        order: list[int] = []
        waiting: set[int] = set()

        def wait(value: int) -> None:
            if value not in waiting:
                waiting.add(value)
                added[value] -= 1
                for reader in readers.get(value, ()):
                    added[reader] -= 1

        for result in self._results:
            wait(result)
        ready = {step for step in needs if not users[step]}
        while ready:
            step = min(ready, key=lambda one: (added[one], key[one]))
            ready.remove(step)
            order += reversed(trees[step])
            for source in reads[step]:
                wait(source)
            for need in needs[step]:
                users[need] -= 1
                if not users[need]:
                    ready.add(need)
        return order[::-1]

    def _checks_before(self, step: int) -> list[int]:
        """The last check that must come before a step, as a list of one or none."""
        number = step - self.count if step >= self.count else self.behind[step]
        return [self.count + number - 1] if number else []

    def _trees(self) -> dict[int, list[int]]:
        """What stays together, by its last step: all that is read once, behind as many checks, is part of its user."""
        user = {source: step for step, sources in enumerate(self.sources) for source in sources}
        last: dict[int, int] = {}
        for step in reversed(range(len(self.sources))):
            reader = user.get(step, self.count)
            part = self.uses[step] == 1 and reader < self.count and self.behind[reader] == self.behind[step]
            last[step] = last[reader] if part else step
        trees: dict[int, list[int]] = {}
        for step in range(len(self.sources)):
            trees.setdefault(last[step], []).append(step)
        return trees

    def kernel(self, order: Sequence[int]) -> Kernel:
        """The kernel with its steps in another order."""
        blocks = [*self._kernel.blocks[:_HEAD]]
        statements: list[Statement] = []
        for step in order:
            if step < self.count:
                statements.append(self._statements[step])
            else:
                blocks.append(Block(tuple(statements), (self._checks[step - self.count],)))
                statements = []
        blocks.append(Block(tuple(statements), ()))
        return replace(self._kernel, blocks=tuple(blocks))
