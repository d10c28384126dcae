"""A model on its way: derived and scheduled, nothing printed yet; what verification rejects is replaced here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from typing import TYPE_CHECKING

from symgen.generation.results import Options, Trig, WrongUseError
from symgen.ir.bounded import Bound, bounded
from symgen.ir.bounded_coordinates import CoordinateBound, within
from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.ir.last_kernels import LastKernels
from symgen.ir.library_trig import with_library_trig
from symgen.ir.raised import Raised, with_raised_thresholds
from symgen.lowering.schedule import schedule
from symgen.mechanics.structure import Structure, analyse
from symgen.mechanics.system import System
from symgen.methods.graphs import moved
from symgen.model.checks.signs import nonnegative_parameters, positive_parameters
from symgen.model.model import Model
from symgen.quantities.alternatives import Alternative
from symgen.quantities.select import Choice, NoSuchMethodError, Rejection, Selection, derive_quantities
from symgen.records import dataclass
from symgen.runtime.activity import working
from symgen.runtime.garbage import let_go_and_keep

if TYPE_CHECKING:
    from symgen.verify.certificate import LeftOut

REJECTED = "verification rejects it"
# Scalars, at half a kilobyte each: derivations of fewer leave little behind.
LARGE_GRAPH = 100_000
# Of kernels in float64 that work with pairs those with plain numbers which they are made of: searches ask for these.
_PLAIN = LastKernels[Kernel](12)


@dataclass(frozen=True, slots=True)
class Draft:
    """The derived quantities of a model and their kernels; `left_out` is what verification rejects by every method.

    `bounds` are those of parameters by type and quantity, `coordinate_bounds` those of coordinates, and thresholds of
    rank are `raised`: so are those of `written` programs.  `notice` says why it does not hold what an earlier
    verification led to, where that was asked for.
    """

    model: Model
    derivations: Selection
    structure: Structure
    programs: Mapping[Scalar, Program]
    trig: Trig
    left_out: tuple[LeftOut, ...] = ()
    notice: str = ""
    bounds: Mapping[Scalar, Mapping[str, tuple[Bound, ...]]] = field(default_factory=dict)
    coordinate_bounds: Mapping[Scalar, Mapping[str, tuple[CoordinateBound, ...]]] = field(default_factory=dict)
    raised: Mapping[Scalar, Mapping[str, Raised]] = field(default_factory=dict)

    @property
    def written(self) -> dict[Scalar, Program]:
        """The programs as they are written: with the checks of bounds and thresholds that are raised."""
        names = tuple(parameter.name for parameter in self.model.parameters)
        coordinates = tuple(coordinate.name for coordinate in self.model.coordinates)
        positive = positive_parameters(self.model) | nonnegative_parameters(self.model)
        made = {}
        for scalar, program in self.programs.items():
            bounds, thresholds = self.bounds.get(scalar, {}), self.raised.get(scalar, {})
            raised = (
                with_raised_thresholds(kernel, scalar, thresholds.get(kernel.name, Raised()))
                for kernel in program.kernels
            )
            inside = self.coordinate_bounds.get(scalar, {})
            raised = (within(kernel, inside.get(kernel.name, ()), coordinates) for kernel in raised)
            kernels = (bounded(kernel, bounds.get(kernel.name, ()), names, positive) for kernel in raised)
            made[scalar] = replace(program, kernels=tuple(kernels))
        return made

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be told of a draft that is not verified again: its notice, and what was left out before."""
        left_out = self.derivations.left_out
        every = f"{REJECTED} by every method"
        notices = (f"{name} is left out in {' and '.join(types)}: {every}" for name, types in left_out)
        return (*((self.notice,) if self.notice else ()), *notices)

    @property
    def program(self) -> Program:
        """The float64 program, which Python, the counts and the report are made from."""
        return self.programs["float64"]

    def choice(self, quantity: str) -> Choice:
        """The candidate a quantity takes."""
        return next(choice for choice in self.derivations.choices if choice.quantity == quantity)

    def method(self, quantity: str) -> str:
        """The method a quantity takes, and along which null space."""
        choice = self.choice(quantity)
        own = choice.method not in ("", choice.title)
        return (f"{choice.method} along {choice.title}" if own else choice.title) + choice.digits

    def taken(self, quantity: str) -> Alternative:
        """The alternative a quantity takes, as it stands."""
        derivations = self.derivations
        derived = next(one for one in derivations.quantities if one.name == quantity)
        known = derivations.method_of_u if quantity == "inverse_dynamics" else dict(derivations.named).get(quantity)
        return Alternative(self.choice(quantity), derivations.mechanics, derived, known)

    def kernels(self, quantity: str) -> dict[Scalar, Kernel]:
        """The kernels of a quantity by scalar type."""
        all_kernels = ((scalar, kernel) for scalar, program in self.programs.items() for kernel in program.kernels)
        return {scalar: kernel for scalar, kernel in all_kernels if kernel.name == quantity}

    def kernels_along(self, alternative: Alternative, scalars: Sequence[Scalar]) -> dict[Scalar, Kernel]:
        """The kernels of a quantity by another method."""
        wide = set(alternative.choice.wide).intersection(scalars)
        # thresholds of pairs of float32 lie between those of both types
        made = tuple(dict.fromkeys((*scalars, "float64"))) if wide else scalars
        programs = schedule(alternative.mechanics, [alternative.derived], made)
        if self.trig == "libm":
            programs = {scalar: with_library_trig(program) for scalar, program in programs.items()}
        kernels = {scalar: program.kernels[0] for scalar, program in programs.items()}
        if not wide:
            return kernels
        from symgen.ir.pairs.sharp_thresholds import with_sharp_thresholds  # few models need these
        from symgen.ir.pairs.wide import widened

        by_scalar = {scalar: kernels[scalar] for scalar in scalars}
        if "float32" in wide:
            by_scalar["float32"] = with_sharp_thresholds(kernels["float32"], kernels["float64"])
        along = {scalar: widened(one, scalar) if scalar in wide else one for scalar, one in by_scalar.items()}
        if "float64" in wide:
            _PLAIN.of(along["float64"], lambda: kernels["float64"])
        return along

    def plain_kernel(self, alternative: Alternative, kernels: Mapping[Scalar, Kernel]) -> Kernel:
        """The kernel in float64 that works with plain numbers, of an alternative with these kernels."""
        if "float64" in kernels and "float64" not in alternative.choice.wide:
            return kernels["float64"]
        plain = replace(alternative, choice=replace(alternative.choice, wide=()))

        def made() -> Kernel:
            return self.kernels_along(plain, ("float64",))["float64"]

        return _PLAIN.of(kernels["float64"], made) if "float64" in kernels else made()

    def along(self, alternative: Alternative, kernels: Mapping[Scalar, Kernel]) -> Draft:
        """The draft with a quantity by another method, by kernels of `kernels_along`."""
        name, derivations = alternative.choice.quantity, self.derivations
        of_u, named = derivations.method_of_u, dict(derivations.named)
        if alternative.known is not None and name == "inverse_dynamics":
            of_u = alternative.known
        elif alternative.known is not None:
            named[name] = alternative.known
        else:
            named.pop(name, None)
        derivations = replace(
            derivations,
            quantities=tuple(alternative.derived if q.name == name else q for q in derivations.quantities),
            choices=tuple(alternative.choice if c.quantity == name else c for c in derivations.choices),
            method_of_u=of_u,
            named=tuple(named.items()),
        )
        programs = {}
        for scalar, program in self.programs.items():
            exchanged = (kernels.get(scalar, k) if k.name == name else k for k in program.kernels)
            programs[scalar] = replace(program, kernels=tuple(exchanged))
        return replace(self, derivations=derivations, programs=programs)

    def without(self, quantity: str, scalars: Sequence[Scalar], why: str) -> Draft:
        """The draft without a quantity in some scalar types; without float64, which all else is made of, in none."""
        derivations = self.derivations
        left_out = tuple(one for one in derivations.left_out if one[0] != quantity)
        derivations = replace(derivations, left_out=(*left_out, (quantity, tuple(scalars))))
        programs = {
            scalar: replace(program, kernels=tuple(kernel for kernel in program.kernels if kernel.name != quantity))
            if scalar in scalars
            else program
            for scalar, program in self.programs.items()
        }
        if "float64" not in scalars:
            return replace(self, derivations=derivations, programs=programs)
        derivations = replace(
            derivations,
            quantities=tuple(q for q in derivations.quantities if q.name != quantity),
            choices=tuple(c for c in derivations.choices if c.quantity != quantity),
            absent=(*derivations.absent, (quantity, why)),
            method_of_u=None if quantity == "inverse_dynamics" else derivations.method_of_u,
            named=tuple(one for one in derivations.named if one[0] != quantity),
        )
        return replace(self, derivations=derivations, programs=programs)

    def rejecting(self, rejected: tuple[Rejection, ...]) -> Draft:
        """The draft that tells of more methods which verification rejected."""
        return replace(self, derivations=replace(self.derivations, rejected=(*self.derivations.rejected, *rejected)))


def draft_of(model: Model, outputs: Sequence[str], options: Options) -> Draft:
    """What derivation chooses; raises WrongUseError for a method that the model does not have."""
    try:
        derivations = derive_quantities(model, tuple(outputs), options.methods)
    except NoSuchMethodError as reason:
        raise WrongUseError(f"{model.name} has {reason}") from reason
    with working("what is not needed"):
        structure = analyse(derivations.mechanics, derivations.generic)
    scalars: tuple[Scalar, ...] = ("float64", *(s for s in options.scalars if s != "float64"))
    programs = schedule(derivations.mechanics, derivations.quantities, scalars)
    if options.trig == "libm":
        programs = {scalar: with_library_trig(program) for scalar, program in programs.items()}
    if len(derivations.mechanics.graph) > LARGE_GRAPH:
        derivations = _on_a_new_graph(derivations)
        let_go_and_keep()
    return Draft(model, derivations, structure, programs, options.trig)


def _on_a_new_graph(derivations: Selection) -> Selection:
    """The same without what was derived on the way: of a large system ten times what is kept."""
    before, mechanics = derivations.mechanics.graph, System(derivations.mechanics.model)
    quantities = tuple(moved(mechanics.graph, q) for q in derivations.quantities)
    before.dissolve()
    return replace(derivations, mechanics=mechanics, quantities=quantities)
