"""A machine as blocks of the model language, put before the entries that the model file has itself.

What moves with a link is given in the axes that its joint moves, so that kernels pay for what moves only; the link's
own axes are a frame beside them where they differ.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from symgen.diagnostics import Notice, Span
from symgen.model.file.reading import entries
from symgen.model.file.scope import Scope
from symgen.model.file.source import MappingNode, ScalarNode, SequenceNode
from symgen.model.mechanism import WORLD
from symgen.model.robots.joint_friction import JointFriction, friction_entries
from symgen.model.robots.machine import ENDINGS, Closing, Follower, Machine, MachineJoint
from symgen.model.robots.names import RobotNames, plain_name
from symgen.model.robots.nodes import Entry, own_names, ranged_names, replaced, text_node, with_entries
from symgen.model.robots.numbers import WrittenNumber, written
from symgen.model.robots.places import AxesPlace, shift_node, texts, turns_node, unit
from symgen.model.robots.solids import PLACES, body_node, made, together


@dataclass(frozen=True, slots=True)
class CarriedLink:
    """Where a link sits in the axes that move it."""

    carrier: str
    place: AxesPlace


def with_machine(
    scope: Scope, tree: MappingNode, machine: Machine, names: RobotNames, form: str, span: Span
) -> MappingNode:
    """The tree of the model file with all that the machine has."""
    return _MachineBlocks(scope, tree, machine, names, form).tree_with(span)


class _MachineBlocks:
    def __init__(self, scope: Scope, tree: MappingNode, machine: Machine, names: RobotNames, form: str) -> None:
        self._scope, self._tree, self._machine, self._names, self._form = scope, tree, machine, names, form
        self._frames: list[Entry] = []
        self._joints: list[Entry] = []
        self._points: list[Entry] = []
        self._carried = {WORLD: CarriedLink(WORLD, AxesPlace())}
        self._carried |= {name: CarriedLink(names.frames[name], AxesPlace()) for name in machine.placed}

    def tree_with(self, span: Span) -> MappingNode:
        """The whole."""
        for joint in self._machine.joints:
            self._place(joint)
        moving = [joint for joint in self._machine.joints if joint.kind != "fixed"]
        single = [joint for joint in moving if len(ENDINGS[joint.kind]) == 1]
        bodies = list(self._bodies())
        loops = [self._loop(closing) for closing in self._machine.closings]
        couplings, rows = self._followers()
        inputs = [] if self._tree.get("inputs") is not None else list(self._inputs())
        additions = {
            "constraints": rows,
            "frames": self._frames,
            "joints": self._joints,
            "bodies": bodies,
            "points": self._points,
            "loops": loops,
            "rotor_inertias": list(self._numbers(single, "rotor_inertias", "rotor")),
            "springs": list(self._springs(single)),
            "friction": list(friction_entries(self._scope, self._tree, self._form, self._friction(single))),
            "coupling": couplings,
            "inputs": inputs,
            "configuration": list(self._start(moving)) if loops or rows or couplings else [],
            "ranges": list(self._ranges(single)),
        }
        tree = with_entries(self._tree, additions, span)
        if self._machine.gravity and tree.get("gravity") is None:
            place = self._machine.gravity[0].span
            gravity = SequenceNode(tuple(_number(entry) for entry in self._machine.gravity), place)
            tree = replaced(tree, "gravity", gravity, place)
        return tree

    def _place(self, joint: MachineJoint) -> None:
        """The joint with its coordinates, and the frame of the link behind it where the joint does not make it."""
        span, parent = joint.span, self._carried[joint.parent]
        at = parent.place.then(joint.place)
        link = self._machine.links[joint.child]
        if joint.kind == "fixed":
            self._carried[joint.child] = CarriedLink(parent.carrier, at.then(joint.rest))
            self._frame(self._names.frames[joint.child], self._carried[joint.child], span)
            return
        name = self._names.coordinates[joint.name]
        own = joint.rest.is_nowhere and not link.stands_between
        carrier = self._names.frames[joint.child] if own else f"{name}_frame"
        coordinates = tuple(text_node(name + ending, span) for ending in ENDINGS[joint.kind])
        entry: list[Entry] = [
            (text_node("type", span), text_node(joint.kind, span)),
            (text_node("parent", span), text_node(parent.carrier, span)),
            (text_node("child", span), text_node(carrier, span)),
        ]
        if any(joint.axis):
            axis = texts(unit(joint.axis) if joint.kind == "prismatic" else joint.axis)
            entry.append(
                (text_node("axis", span), SequenceNode(tuple(text_node(text, span) for text in axis), span))
            )
        entry.append((text_node("coordinates", span), SequenceNode(coordinates, span)))
        self._joints.append((text_node(name, span), _with_place(entry, at, ("at", "rotation"), span)))
        self._carried[joint.child] = CarriedLink(carrier, joint.rest)
        if not own and not link.stands_between:
            self._frame(self._names.frames[joint.child], self._carried[joint.child], span)

    def _frame(self, name: str, carried: CarriedLink, span: Span) -> None:
        parent: list[Entry] = [(text_node("parent", span), text_node(carried.carrier, span))]
        entry = _with_place(parent, carried.place, ("translation", "rotation"), span)
        self._frames.append((text_node(name, span), entry))

    def _bodies(self) -> Iterator[Entry]:
        """One body for the links that move together; what stands still needs none."""
        groups: dict[str, list[str]] = {}
        for name, carried in self._carried.items():
            if carried.carrier != WORLD:
                groups.setdefault(carried.carrier, []).append(name)
        taken = {key.value: key.span for key, _ in entries(self._tree.get("bodies"))}
        for carrier, links in groups.items():
            members = [self._machine.links[name] for name in links if self._machine.links[name].solids]
            if not members:
                continue
            solids = [solid.seen_from(self._carried[link.name].place) for link in members for solid in link.solids]
            whole, span = together(solids), members[0].span
            elements = [whole.tensor[row][column] for row, column in PLACES]
            com = [text_node(text, span) for text in texts(whole.com)] if any(whole.com) else []
            tensor = [text_node(text, span) for text in texts(elements)]
            shown = [node.value != "0" for node in tensor]
            body = body_node(made(whole.mass, span), com, tensor, shown, span)
            name = self._names.frames[members[0].name]
            if name in taken:
                remedy = f"name the further body differently, with `frame: {name}`"
                self._scope.wrong(f"`{name}` has its mass from the {self._form} file", remedy, taken[name])
            if name != carrier:
                frame = text_node("frame", span), text_node(carrier, span)
                body = MappingNode((*body.entries, frame), span, True)
            yield text_node(name, span), body

    def _loop(self, closing: Closing) -> Entry:
        """The loop between two points or frames of its own, which are where the machine is assembled."""
        span, name = closing.span, plain_name(closing.name)
        ends = []
        for number, (link, place) in enumerate(zip(closing.links, closing.places, strict=True), 1):
            end, carried = f"{name}_{number}", self._carried[link]
            at = carried.place.then(place)
            if closing.kind == "point":
                entry: list[Entry] = [(text_node("frame", span), text_node(carried.carrier, span))]
                point = _with_place(entry, AxesPlace(at.shift), ("at", "rotation"), span)
                self._points.append((text_node(end, span), point))
            else:
                self._frame(end, CarriedLink(carried.carrier, at), span)
            ends.append(text_node(end, span))
        loop = (
            (text_node("type", span), text_node(closing.kind, span)),
            (text_node("between", span), SequenceNode(tuple(ends), span)),
        )
        return text_node(name, span), MappingNode(loop, span, True)

    def _followers(self) -> tuple[list[Entry], list[Entry]]:
        """Couplings; where a coordinate has one already, rows."""
        taken = own_names(self._tree, "coupling")
        couplings: list[Entry] = []
        rows: list[Entry] = []
        for follower in self._machine.followers:
            name, text = self._names.coordinates[follower.joint], self._polynomial(follower)
            if name in taken:
                row = text_node(f"{name} - ({text})", follower.span)
                rows.append((text_node(plain_name(follower.name), follower.span), row))
            else:
                couplings.append((text_node(name, follower.span), text_node(text, follower.span)))
            taken.add(name)
        return couplings, rows

    def _polynomial(self, follower: Follower) -> str:
        constant = follower.offset + follower.coefficients[0].value
        terms = [f"({written(constant)})"] if constant or not follower.leader else []
        if follower.leader:
            leader = self._names.coordinates[follower.leader]
            if follower.leader_offset:
                leader = f"({leader} - ({written(follower.leader_offset)}))"
            for power, factor in enumerate(follower.coefficients[1:], 1):
                if factor.value:
                    scaled = leader if factor.value == 1 else f"({factor.text})*{leader}"
                    terms.append(scaled if power == 1 else f"{scaled}**{power}")
        return " + ".join(terms) or "0"

    def _inputs(self) -> Iterator[Entry]:
        """Inputs, which are called u_... where a coordinate or a frame has the name."""
        taken = {*self._names.coordinates.values(), *self._names.frames.values()}
        for drive in self._machine.drives:
            span, coordinate = drive.span, self._names.coordinates[drive.joint]
            key: Entry = text_node("joint", span), text_node(coordinate, span)
            if drive.gear.value != 1:
                table = MappingNode(((text_node(coordinate, span), _number(drive.gear)),), span, True)
                key = text_node("acts_on", span), table
            name = plain_name(drive.name)
            if name in taken:
                name = f"u_{name}"
                self._scope.notices.append(Notice(f"the motor of that name is the input `{name}`", span))
            yield text_node(name, span), MappingNode((key,), span, True)

    def _start(self, moving: list[MachineJoint]) -> Iterator[Entry]:
        """The configuration of the file, in which its loops are closed."""
        own = own_names(self._tree, "configuration")
        for joint in moving:
            base = self._names.coordinates[joint.name]
            for ending, value in zip(ENDINGS[joint.kind], joint.start, strict=False):
                if base + ending not in own:
                    yield text_node(base + ending, joint.span), made(value, joint.span)

    def _numbers(self, joints: list[MachineJoint], block: str, key: str) -> Iterator[Entry]:
        own = own_names(self._tree, block)
        for joint in joints:
            name, value = self._names.coordinates[joint.name], joint.values.get(key)
            if value is not None and value.value and name not in own:
                yield text_node(name, value.span), _number(value)

    def _springs(self, joints: list[MachineJoint]) -> Iterator[Entry]:
        own = own_names(self._tree, "springs")
        for joint in joints:
            stiffness, rest = joint.values.get("stiffness"), joint.values.get("unstretched")
            name = f"{self._names.coordinates[joint.name]}_spring"
            if stiffness is None or not stiffness.value or name in own:
                continue
            span = stiffness.span
            parts: list[Entry] = [
                (text_node("joint", span), text_node(self._names.coordinates[joint.name], span)),
                (text_node("stiffness", span), _number(stiffness)),
            ]
            if rest is not None and rest.value:
                parts.append((text_node("length", rest.span), _number(rest)))
            yield text_node(name, span), MappingNode(tuple(parts), span, True)

    def _friction(self, joints: list[MachineJoint]) -> Iterator[JointFriction]:
        for joint in joints:
            viscous, dry = (
                _number(value) if value is not None and value.value else None
                for value in (joint.values.get("viscous"), joint.values.get("dry"))
            )
            yield JointFriction(joint.name, self._names.coordinates[joint.name], viscous, dry, joint.span)

    def _ranges(self, joints: list[MachineJoint]) -> Iterator[Entry]:
        own = ranged_names(self._tree)
        for joint in joints:
            name = self._names.coordinates[joint.name]
            lower, upper, rate = (joint.values.get(key) for key in ("lower", "upper", "velocity"))
            if lower is not None and upper is not None and name not in own:
                yield text_node(name, lower.span), SequenceNode((_number(lower), _number(upper)), lower.span)
            if rate is not None and rate.value > 0 and f"{name}_dot" not in own:
                lowest = text_node(f"-{rate.text}", rate.span)
                yield text_node(f"{name}_dot", rate.span), SequenceNode((lowest, _number(rate)), rate.span)


def _with_place(entry: list[Entry], place: AxesPlace, keys: tuple[str, str], span: Span) -> MappingNode:
    shift, turns = shift_node(place.shift, span), turns_node(place.axes, span)
    added = [(text_node(key, span), node) for key, node in zip(keys, (shift, turns), strict=True) if node is not None]
    return MappingNode((*entry, *added), span, True)


def _number(value: WrittenNumber) -> ScalarNode:
    # the characters there may say more than the number does, as degrees do
    return text_node(value.text, value.span)
