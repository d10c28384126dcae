"""Which names an expression may use where it stands, and what to say about the others."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field, replace
from typing import Literal, TypeAlias

from symgen.diagnostics import Mistake, Notice, Span
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.names import MOST_LISTED, did_you_mean, name_mistake, nearest
from symgen.model.expressions.parser import parse_expression
from symgen.model.expressions.walk import names_in
from symgen.model.file.source import Node, ScalarNode
from symgen.model.mechanism import PLACES, TURNING_RATES, VELOCITIES, WORLD, is_component

Kind: TypeAlias = Literal[
    "coordinate", "rate", "acceleration", "parameter", "definition", "input", "constraint row", "multiplier", "time",
    "symbol", "setting", "place", "velocity", "frame", "body", "point",
]  # fmt: skip

CONSTANT: frozenset[Kind] = frozenset()
PARAMETERS: frozenset[Kind] = frozenset({"parameter"})
FRAME: frozenset[Kind] = frozenset({"coordinate", "parameter", "definition"})
CONFIGURATION: frozenset[Kind] = FRAME | {"place"}
STATE: frozenset[Kind] = CONFIGURATION | {"rate", "velocity"}
PATH_DEFINITION: frozenset[Kind] = frozenset({"time", "parameter", "symbol"})
PATH_CONDITION: frozenset[Kind] = CONFIGURATION | {"time", "symbol"}
MOTION: frozenset[Kind] = STATE | {"acceleration", "input", "multiplier", "symbol"}

_REMEDIES: dict[Kind, str] = {
    "rate": "forces that depend on rates belong into `applied_forces`, constraints on rates into `nonholonomic`",
    "acceleration": "accelerations are derived; they stand in `published` formulas and `ranges` only",
    "input": "inputs act through `acts_on` only",
    "multiplier": "forces that depend on constraint forces are out of scope",
    "constraint row": "a constraint is no value; write its expression, or name it under `definitions`",
    "time": "time-dependent energies, forces and constraints are out of scope; make it a coordinate or a parameter",
    "coordinate": "use numbers and parameters only",
    "parameter": "use numbers only",
    "definition": "make it a parameter, which may follow from earlier ones, or write what it stands for",
    "setting": "weights, preload and limits act through `allocation` only; name the number under `parameters`",
    "symbol": "symbols of `where` belong to their formula only",
    "place": "frames and points are placed by coordinates and parameters; points are for what comes after them",
    "velocity": "forces that depend on velocities belong into `applied_forces`, constraints into `nonholonomic`",
    "frame": "write a component of its origin or its turning rate, such as `.x`, `.vx`, `.wz`",
    "point": "write one of its components, such as `.x` or `.vx`",
    "body": "write a component of its frame, such as `.x`, `.vx`, `.wz`",
}


NO_NUMBERS = frozenset({"nan", "inf", "infinity"})
_WORD = re.compile(r"[A-Za-z][A-Za-z0-9_]*", re.ASCII)


def words_of(text: str) -> set[str]:
    """The names that stand in a text."""
    return set(_WORD.findall(text))


def _rate_meant(name: str, visible: Iterable[str]) -> str:
    """The remedy where a rate is written in another way, such as dx, xd or x_d."""
    for rate in sorted(visible):
        own = rate.removesuffix("_dot")
        if own != rate and name in (f"d{own}", f"d_{own}", f"dot_{own}", f"{own}d", f"{own}_d", f"{own}dot", f"{own}p"):
            return f"the rate of `{own}` is `{rate}`"
    return ""


def a_kind(kind: Kind) -> str:
    """The kind with its article."""
    return "the time" if kind == "time" else f"{'an' if kind[0] in 'ai' else 'a'} {kind}"


@dataclass(slots=True)
class Scope:
    """The declared names of a model, and the mistakes and notices found so far."""

    kinds: dict[str, Kind] = field(default_factory=dict)
    spans: dict[str, Span] = field(default_factory=dict)
    rate_definitions: set[str] = field(default_factory=set)
    place_definitions: set[str] = field(default_factory=set)
    used: set[str] = field(default_factory=set)
    faulty: set[str] = field(default_factory=set)
    moved_by: dict[str, tuple[str, ...]] = field(default_factory=dict)  # coordinates by joints and their frames
    attempted: set[str] = field(default_factory=set)  # words of declarations that could not be read
    mistakes: list[Mistake] = field(default_factory=list)
    notices: list[Notice] = field(default_factory=list)
    efforts: Notice | None = None  # limits of a robot's drives; what can be done with them is known at the end

    def wrong(self, message: str, remedy: str, span: Span | None, about: str = "") -> None:
        """Records a mistake; `about` is the name that tells it from the same one made elsewhere."""
        self.mistakes.append(Mistake(message, remedy, span, about))

    def coordinate_meant(self, name: str, coordinates: Collection[str], otherwise: str) -> str:
        """The remedy for a name that is no coordinate: a coordinate or a joint that it may stand for, else this."""
        joints = {joint: moved for joint, moved in self.moved_by.items() if moved}
        meant = nearest(name, sorted({*coordinates, *joints}))
        if meant in coordinates:
            return f"did you mean `{meant}`?"
        if meant not in joints:
            return otherwise
        moved = " or ".join(f"`{one}`" for one in joints[meant])
        if meant == name:
            return f"name the coordinate of that joint: {moved}"
        return f"did you mean the joint `{meant}`? Name its coordinate: {moved}"

    def listed_coordinates(self) -> str:
        """The coordinates with the joints that they move, as `a (joint crank), b`; empty where they are many."""
        names = [name for name, kind in self.kinds.items() if kind == "coordinate"]
        moved_by: dict[str, str] = {}
        for joint, moved in self.moved_by.items():
            for name in moved:
                moved_by.setdefault(name, "" if name == joint else f" (joint {joint})")
        return ", ".join(name + moved_by.get(name, "") for name in names) if len(names) <= MOST_LISTED else ""

    def wrong_about(self, name: str, message: str, remedy: str, span: Span | None) -> None:
        """Records a mistake about what a name stands for; one in its declaration is enough to be told."""
        if name not in self.attempted and name.removesuffix("_ddot").removesuffix("_dot") not in self.attempted:
            self.wrong(message, remedy, span)

    def inner(self, **kinds: Kind) -> Scope:
        """A scope for further names that shares everything else with this one."""
        return replace(self, kinds={**self.kinds, **kinds}, spans=dict(self.spans))

    def declare(self, node: ScalarNode, kind: Kind) -> bool:
        """Adds a name, with its rate and acceleration; False (and a mistake) where it is no name or is taken."""
        mistake = name_mistake(node, kind)
        if mistake is not None:
            self.mistakes.append(mistake)
            self.attempted |= {node.value, *words_of(node.value)}
            return False
        name = node.value
        if kind == "frame" and name == WORLD:
            self.wrong("`world` is the frame at rest that all others hang on", "give the frame another name", node.span)
            return False
        if name in self.kinds:
            taken = self.kinds[name]
            span = self.spans.get(name)
            where = "" if span is None else f" ({span.file}:{span.line})" if span.file else f" (line {span.line})"
            self.wrong(f"`{name}` is already {a_kind(taken)}{where}", "give each thing a name of its own", node.span)
            self.attempted.add(name)
            return False
        self.kinds[name] = kind
        self.spans[name] = node.span
        if kind == "coordinate":
            self.kinds[f"{name}_dot"] = "rate"
            self.kinds[f"{name}_ddot"] = "acceleration"
        return True

    def owns(self, node: ScalarNode) -> bool:
        """Whether this very entry declared its name, and not another one of the same name."""
        return self.spans.get(node.value) == node.span

    def expression(
        self, node: Node | None, where: str, allowed: frozenset[Kind], known: Iterable[str] | None = None
    ) -> Expression | None:
        """The expression of a scalar, its names checked; `known` restricts parameters and definitions to those
        declared before it.  None where there is a mistake (recorded) or nothing to read (the shape's mistake)."""
        if not isinstance(node, ScalarNode) or not node.value.strip():
            return None
        if node.value.strip().lower().lstrip("+-.") in NO_NUMBERS and node.value.strip().lstrip("+-").startswith("."):
            self.wrong(f"{where} is not finite: `{node.value.strip()}`", "give a finite number", node.span)
            return None
        parsed = parse_expression(node)
        if isinstance(parsed, Mistake):
            self.mistakes.append(parsed)
            return None
        good = True
        earlier = None if known is None else set(known)
        for name in names_in(parsed):
            good &= self._name(name.name, name.span, where, allowed, earlier)
        # What uses a faulty definition cannot be judged; the mistake in the definition is enough.
        return parsed if good and not any(name.name in self.faulty for name in names_in(parsed)) else None

    def _name(
        self, name: str, span: Span | None, where: str, allowed: frozenset[Kind], earlier: set[str] | None
    ) -> bool:
        if is_component(name):
            return self._component(name, span, where, allowed)
        kind = self.kinds.get(name, "time" if name == "t" else None)
        if kind is None and name.lower() in NO_NUMBERS:
            self.wrong(f"{where} is not finite: `{name}`", "give a finite number", span)
            return False
        if kind is None:
            visible = [other for other, its in self.kinds.items() if its in allowed]
            declared = "declare it under `coordinates`, `parameters` or `definitions`"
            remedy = _rate_meant(name, visible) or did_you_mean(name, visible, declared)
            self.wrong_about(name, f"unknown name `{name}` in {where}", remedy, span)
            return False
        self.used.add(name)
        if kind not in allowed:
            self.wrong_about(name, f"`{name}` is {a_kind(kind)}, which {where} must not contain", _REMEDIES[kind], span)
            return False
        if earlier is not None and kind in ("parameter", "definition") and name not in earlier:
            self.wrong(f"{where} uses `{name}`, which is declared later", "declare it before its first use", span)
            return False
        if name in self.rate_definitions and "rate" not in allowed:
            self.wrong(f"`{name}` contains rates, which {where} must not contain", _REMEDIES["rate"], span)
            return False
        if name in self.place_definitions and "place" not in allowed:
            message = f"`{name}` contains components of points or frames, which {where} must not contain"
            self.wrong(message, _REMEDIES["place"], span)
            return False
        return True

    def _component(self, name: str, span: Span | None, where: str, allowed: frozenset[Kind]) -> bool:
        """Whether `owner.what` is known here."""
        owner, _, what = name.partition(".")
        kind = self.kinds.get(owner)
        if kind not in ("point", "frame"):
            owners = [other for other, its in self.kinds.items() if its in ("point", "frame")]
            remedy = did_you_mean(owner, owners, "declare it under `points` or `frames`")
            self.wrong_about(owner, f"unknown point or frame `{owner}` in {where}", remedy, span)
            return False
        known = (*PLACES, *VELOCITIES, *(TURNING_RATES if kind == "frame" else ()))
        if what not in known:
            self.wrong(f"a {kind} has no component `{what}`", f"its components are {', '.join(known)}", span)
            return False
        self.used.add(owner)
        is_place = what in PLACES
        if ("place" if is_place else "velocity") not in allowed:
            noun = "a place" if is_place else "a velocity"
            remedy = _REMEDIES["place" if "place" not in allowed else "velocity"]
            self.wrong(f"`{name}` is {noun}, which {where} must not contain", remedy, span)
            return False
        return True
