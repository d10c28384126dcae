"""Names inside kernels: which locals exist, which are used, and what they are called in a language."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from symgen.backends.quantities import output_argument
from symgen.ir.kernel import Argument, Check, Kernel, Local, Operand, Program, Statement
from symgen.model.model import Model
from symgen.naming import identifiers
from symgen.records import dataclass

ARGUMENT_NAMES = ("q", "qd", "qdd", "u", "q_m", "qd_m", "qdd_m", "x_t", "xd_t", "xdd_t", "w_u", "w_qdd", "v_x", "p")

@dataclass(frozen=True, slots=True)
class Names:
    """Identifiers of one program: locals of the kernels, members of the parameter struct, output arguments."""

    locals: dict[str, str]
    members: dict[str, str]
    outputs: dict[str, str]

    @property
    def renamed(self) -> tuple[tuple[str, str], ...]:
        """Members of the parameter struct that are not called as in the model file."""
        return tuple((name, new) for name, new in self.members.items() if name != new)


def names_of(
    model: Model,
    program: Program,
    is_taken: Callable[[str], bool],
    own_names: Iterable[str],
    inside: Iterable[str] = (),
) -> Names:
    """Names for all kernels of the program in a language where some are taken.

    `own_names` are the generated file's own global names, `inside` those that it uses inside of functions.
    """
    own = frozenset(own_names)
    users = user_names(model)
    members = identifiers((parameter.name for parameter in model.parameters), is_taken, own)
    outputs: dict[str, str] = {}
    for kernel in program.kernels:
        wanted = output_argument(kernel.name)
        clash = wanted in users or wanted in {argument.name for argument in array_arguments(kernel)}
        outputs[kernel.name] = f"{wanted}_out" if clash else wanted
    taken = own.union(ARGUMENT_NAMES, inside, outputs.values())
    names = [*users, *(name for kernel in program.kernels for name in kernel_locals(kernel))]
    return Names(identifiers(names, is_taken, taken), members, outputs)


def user_names(model: Model) -> tuple[str, ...]:
    """Every name of the model file that can become a local of a kernel."""
    coordinates = [name for c in model.coordinates for name in (c.name, c.rate, c.acceleration)]
    others = [item.name for group in (model.parameters, model.definitions, model.inputs) for item in group]
    further = [name for argument in model.further_arguments for name in argument.names]
    return tuple(coordinates + others + further)


def array_arguments(kernel: Kernel) -> tuple[Argument, ...]:
    """The arguments of a signature: arrays of length 0 are left out."""
    return tuple(argument for argument in kernel.arguments if argument.length)


def all_statements(kernel: Kernel) -> Iterator[Statement]:
    """Every statement, those that run only when a check fails included."""
    for block in kernel.blocks:
        yield from block.all_statements()


def kernel_locals(kernel: Kernel) -> Iterator[str]:
    """Every local, in the order of assignment."""
    yield from (load.local for load in kernel.loads)
    for statement in all_statements(kernel):
        yield from statement.targets


def used_locals(kernel: Kernel) -> frozenset[str]:
    """Locals that an operand, a check or an output refers to."""
    operands = [operand for statement in all_statements(kernel) for operand in statement.operands]
    checked = [o for block in kernel.blocks for check in block.checks for o in check_operands(check)]
    return frozenset(o.name for o in (*operands, *checked, *kernel.outputs) if isinstance(o, Local))


def check_operands(check: Check) -> Iterator[Operand]:
    """Everything a check refers to, what it evaluates on failure included."""
    yield from (check.value, check.limit)
    if check.first is not None:
        for statement in check.first.statements:
            yield from statement.operands
        for inner in check.first.checks:
            yield from check_operands(inner)
