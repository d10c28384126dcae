"""The quantities of a model, each by the cheapest valid method by counted cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from symgen.ir.kernel import Scalar
from symgen.mechanics.genericity import Genericity, genericity
from symgen.mechanics.system import System
from symgen.methods.graphs import derived_on
from symgen.methods.method import INPUTS
from symgen.methods.quantity import Quantity, scalars
from symgen.methods.selection import AUTO, MethodChoice, Methods
from symgen.model.model import Model
from symgen.model.quantities import FRICTION, LIMITED, NAMED, POINTS, TASK_OPEN
from symgen.quantities.candidates import Candidates
from symgen.quantities.catalogue import BY_NAME, CATALOGUE, CatalogueEntry, missing
from symgen.quantities.everything import WorkBudget, too_long
from symgen.quantities.finish import finished
from symgen.quantities.row_units import in_ordinary_units
from symgen.records import dataclass
from symgen.runtime.activity import each, working
from symgen.symbolic.traverse import reached


@dataclass(frozen=True, slots=True)
class Choice:
    """Which candidate a quantity took, and the counted cost of each: by their titles.

    `method` is the one that q_ddot and lambda take along a null space, `wide` the scalar types in which its kernel
    works with twice the digits.
    """

    quantity: str
    title: str
    costs: tuple[tuple[str, int], ...]
    method: str = ""
    wide: tuple[Scalar, ...] = ()

    @property
    def digits(self) -> str:
        """What is told of it beside the title: empty where it works with plain numbers."""
        return f", with twice the digits in {' and '.join(self.wide)}" if self.wide else ""


@dataclass(frozen=True, slots=True)
class Rejection:
    """A method that verification rejected, and why."""

    quantity: str
    method: str
    why: str


@dataclass(frozen=True, slots=True)
class Selection:
    """The derived quantities of a model and how they were chosen."""

    mechanics: System
    generic: Genericity
    quantities: tuple[Quantity, ...]
    choices: tuple[Choice, ...]
    absent: tuple[tuple[str, str], ...]
    method_of_u: MethodChoice | None = None  # where it is among the quantities
    named: tuple[tuple[str, MethodChoice], ...] = ()  # of other quantities, where a method was asked for by name
    methods: Methods | None = None  # those of u that were looked at
    rejected: tuple[Rejection, ...] = ()  # by verification
    left_out: tuple[tuple[str, tuple[str, ...]], ...] = ()  # quantities with the scalar types in which no method passes


class NoSuchMethodError(Exception):
    """A method of a quantity that this system does not have, with the reason."""

    def __init__(self, quantity: str, method: str, reason: str) -> None:
        super().__init__(f"no method {method!r} of {quantity}: {reason}")


def requested(model: Model, generic: Genericity, outputs: Sequence[str]) -> tuple[list[str], list[tuple[str, str]]]:
    """The names to derive, in catalogue order, and what was asked for that this system does not have."""
    everything = "all" in outputs
    present: list[str] = []
    absent: list[tuple[str, str]] = []
    for entry in CATALOGUE:
        if entry.name in outputs or (everything and _is_meant(entry, model)):
            reason = missing(entry, model, generic)
            if reason is None:
                present.append(entry.name)
            else:
                absent.append((entry.name, reason))
    return present, absent


def _is_meant(entry: CatalogueEntry, model: Model) -> bool:
    """Whether `all` asks a system for a quantity: for places of points where it has some, derivatives where it says,
    what is measured and what is of a task where it names that; columns for each body nowhere."""
    if entry.needs == NAMED:
        return False
    if entry.row.is_derivative:
        return model.derivatives
    if entry.row.is_of_measured:
        return bool(model.measured)
    if entry.row.is_of_task:
        return bool(model.task) and (entry.needs != TASK_OPEN or bool(model.task_leaves.rates))
    if entry.needs == FRICTION:
        return bool(model.rough)
    if entry.needs == LIMITED:
        return model.allocation is not None and bool(model.allocation.limits)
    return entry.needs != POINTS or bool(model.mechanism.points)


def derive_quantities(
    model: Model, outputs: Sequence[str], asked: Mapping[str, str] = MappingProxyType({})
) -> Selection:
    """Derive what is asked for and nothing else; methods `asked` for, by quantity, are taken whatever they cost.

    Raises NoSuchMethodError where the system does not have one of them.
    """
    model = in_ordinary_units(model)
    with working("motion equations"):
        mechanics = System(model)
        generic = genericity(mechanics)
    present, absent = requested(model, generic, outputs)
    methods, everything = Methods(model, generic), WorkBudget(outputs, asked)
    candidates = Candidates(mechanics, methods, everything, [name for name in present if name not in asked])
    made: dict[str, Quantity] = {}
    choices: dict[str, Choice] = {}
    compared: dict[str, MethodChoice] = {}
    for name in each("methods of", present, str):
        if name == INPUTS or name in asked:
            method = asked.get(name, AUTO)
            answer = methods.choose(name, method)
            if isinstance(answer, str):
                raise NoSuchMethodError(name, method, answer)
            one, compared[name] = answer
            made[name] = derived_on(mechanics.graph, one)
            choices[name] = Choice(name, one.title, compared[name].costs)
            continue
        chosen = candidates.cheapest(BY_NAME[name])
        if chosen is None:
            absent.append((name, too_long()))
            continue
        one, costs = chosen
        made[name], choices[name] = one.derived, Choice(name, one.title, tuple(costs.items()), one.method)
    costs = {name: dict(choice.costs)[choice.title] for name, choice in choices.items()}
    for name in everything.surplus(costs):
        absent.append((name, too_long(costs[name])))
        del made[name], choices[name]
    lengths = [len(reached(scalars(derived))) for derived in made.values()]
    named_so = each("shortening", tuple(made.values()), lambda derived: derived.name, lengths)
    quantities = tuple(finished(mechanics, generic, derived) for derived in named_so)
    of_u = compared.pop(INPUTS, None)
    named = tuple(compared.items())
    return Selection(mechanics, generic, quantities, tuple(choices.values()), tuple(absent), of_u, named, methods)
