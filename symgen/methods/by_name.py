"""q_ddot, lambda and N_B along a form that is asked for by name: whether it is valid everywhere, and the quantity.

What these forms divide by vanishes by theorem only where B loses rank or the motion is not determined; the two that
start from the inverse of G need G positive definite in all directions, which is minimised over configurations and
parameters (`forms/definiteness.py`).
"""

from __future__ import annotations

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.admission import DECIMALS, Singular, Verdict
from symgen.methods.compared import MOTIONS, quantities_by, why_missing
from symgen.methods.forward_dynamics.motions import BY_BODIES, BY_FRAMES, MOTION_NAMES
from symgen.methods.quantity import Quantity, scalars
from symgen.methods.selection import MethodChoice
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.symbolic.angles import share_angles
from symgen.symbolic.traverse import cost
from symgen.validity.definiteness import Indefinite, indefinite
from symgen.validity.formula import formula

FREE = ("schur_qr", "schur_ldl")  # need G positive definite in every direction
SQUARED = "; it loses digits with the square of the condition of B"
THEOREMS = {
    "minor": "its denominator is the determinant of the equations of motion",
    "nullspace": "its pivots are those of G along the constraints",
    "schur_qr": "its pivots are those of G, which is positive definite everywhere, and those of B",
    "schur_ldl": "its pivots are those of G, which is positive definite everywhere, and those of B" + SQUARED,
    "shifted": "its matrix is positive definite where G is so along the constraints" + SQUARED,
    "kkt": "its pivots are those of the whole system",
    BY_FRAMES: "its pivots are inertias met along the joints, positive where G is definite, and those of B",
    BY_BODIES: "its pivots are inertias met along the joints, positive where G is definite, and those of B",
}
PROJECTOR = {
    "minor": "its denominator is the sum of the squared minors of B",
    "householder": "its pivots vanish only where the rank of B drops",
}


@dataclass(frozen=True, slots=True)
class NamedForm:
    """A form of q_ddot, lambda or N_B: the mechanics it was derived on, the quantity there, and what is known of it."""

    name: str
    mechanics: System
    derived: Quantity
    verdict: Verdict

    @property
    def weight(self) -> int:
        """Counted cost of a regular state, outputs and tested denominators."""
        return cost(share_angles(self.mechanics.graph, scalars(self.derived))).weight

    @property
    def choice(self) -> MethodChoice:
        """The form as the one that is taken."""
        return MethodChoice(self.name, self.verdict, ((self.name, self.weight, self.verdict.explanation),))


def named_form(model: Model, generic: Genericity, quantity: str, name: str) -> NamedForm | str:
    """A form of forward_dynamics, multipliers or nullspace_projector, or why this system does not have it."""
    mechanics, found = quantities_by(model, generic, name)
    derived = next((one for one in found if one.name == quantity), None)
    if derived is None:
        return why_missing(generic, quantity, name)
    return NamedForm(name, mechanics, derived, _verdict(mechanics, quantity, name))


def valid_form(mechanics: System, found: tuple[Quantity, ...], quantity: str, name: str) -> NamedForm | None:
    """q_ddot or lambda among those `found` by a name, if that form is valid wherever the motion is determined."""
    derived = next((one for one in found if one.name == quantity), None)
    if derived is None:
        return None
    verdict = _verdict(mechanics, quantity, name)
    return NamedForm(name, mechanics, derived, verdict) if verdict.admitted else None


def forms_compared(model: Model, generic: Genericity, quantity: str, taken: str) -> MethodChoice | None:
    """Every form of a quantity by counted cost, with `taken` as the name of what is taken; None without forms."""
    names = (*MOTION_NAMES, BY_FRAMES) if quantity in MOTIONS else tuple(PROJECTOR)
    found = [form for name in names if isinstance(form := named_form(model, generic, quantity, name), NamedForm)]
    if not found:
        return None
    costs = sorted((form.weight, form.name, form.verdict) for form in found)
    chosen = next((verdict for _, name, verdict in costs if name == taken), costs[0][2])
    return MethodChoice(taken, chosen, tuple((name, weight, verdict.explanation) for weight, name, verdict in costs))


def failing_motions(mechanics: System) -> tuple[tuple[str, str], ...]:
    """The forms of q_ddot and lambda that fail at regular states of a system, and where."""
    verdicts = [(name, _verdict(mechanics, MOTIONS[0], name)) for name in FREE]
    return tuple((name, found.explanation) for name, found in verdicts if not found.admitted)


def _verdict(mechanics: System, quantity: str, name: str) -> Verdict:
    if quantity not in MOTIONS:
        return Verdict(0, 0, (), PROJECTOR[name])
    found = indefinite(mechanics) if name in FREE else None
    return Verdict(0, 0, (), THEOREMS[name]) if found is None else Verdict(0, 0, (_singular(mechanics, found),))


def _singular(mechanics: System, found: Indefinite) -> Singular:
    """In words: the pivot of G is the inertia a coordinate has when those before it are free."""
    coordinate = mechanics.model.coordinates[found.coordinate].name
    pivot = f"the pivot of {coordinate} in G"
    if not found.pivot.is_zero:
        pivot += f", {formula(found.pivot)}"
    return Singular(pivot, tuple((name, round(value, DECIMALS)) for name, value in found.state))
