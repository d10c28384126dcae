"""A tree of the links of a model, chosen in the order of the file; joints beyond it close loops."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace
from fractions import Fraction

from symgen.model.expressions.names import did_you_mean
from symgen.model.mechanism import WORLD
from symgen.model.robots.machine import Closing, Follower, Machine, MachineJoint, MachineLink, computed
from symgen.model.robots.places import UPRIGHT, AxesPlace, quaternion_of, z_to
from symgen.model.robots.reader import ElementReader
from symgen.model.robots.solids import ZERO
from symgen.model.sdf.joints import SdfJoint
from symgen.model.sdf.words import LOOPS, TYPES

# what a loop has no coordinate for
FORCES = ("viscous", "dry", "stiffness")
ENDINGS_OF_AXES = {"axis": "_1", "axis2": "_2"}


def made_tree(
    reader: ElementReader,
    links: dict[str, MachineLink],
    places: dict[str, AxesPlace],
    joints: list[SdfJoint],
    held: Collection[str],
) -> Machine:
    """The machine; `places` are those of links in the world, `held` the links that the model file places itself."""
    return _Tree(reader, links, places, joints, held).machine()


class _Tree:
    def __init__(
        self,
        reader: ElementReader,
        links: dict[str, MachineLink],
        places: dict[str, AxesPlace],
        joints: list[SdfJoint],
        held: Collection[str],
    ) -> None:
        self._reader, self._links, self._places = reader, dict(links), {WORLD: AxesPlace(), **places}
        self._joints, self._held = joints, held
        self._made: list[MachineJoint] = []
        self._closings: list[Closing] = []

    def machine(self) -> Machine:
        """Links of one part of the machine after the other, joints near to the root first."""
        part = {name: name for name in self._places}
        tree: list[SdfJoint] = []
        for joint in self._joints:
            one, other = part[joint.parent], part[joint.child]
            if one == other:
                self._close(joint)
            else:
                tree.append(joint)
                part = {name: one if root == other else root for name, root in part.items()}
        reached = {WORLD}
        placed: list[str] = []
        for name in self._links:
            together = [other for other in self._places if part[other] == part[name]]
            if reached.isdisjoint(together):
                root = next((other for other in together if other in self._held), together[0])
                reached.add(root)
                if root in self._held:
                    placed.append(root)
                else:
                    self._free(root)
        while tree:
            joint = next(joint for joint in tree if joint.parent in reached or joint.child in reached)
            tree.remove(joint)
            self._enter(joint, joint.parent in reached)
            reached |= {joint.parent, joint.child}
        followers = tuple(self._followers())
        return Machine(self._links, tuple(self._made), tuple(self._closings), followers, placed=tuple(placed))

    def _free(self, root: str) -> None:
        """A link that is joined to nothing moves freely, as SDF has it."""
        place, span = self._places[root], self._links[root].span
        start = (*place.shift, *quaternion_of(place))
        free = MachineJoint(f"{root}_free", "floating", WORLD, root, AxesPlace(), AxesPlace(), span, start=start)
        self._made.append(free)

    def _enter(self, joint: SdfJoint, is_forward: bool) -> None:
        """The motions of a joint one after the other; where the child is nearer to the root, from the child."""
        kinds = TYPES[joint.kind]
        span, endings = joint.span, ("",) if len(kinds) == 1 else ("_1", "_2")
        steps = [
            MachineJoint(joint.name + ending, kind, "", "", AxesPlace(), AxesPlace(), span, start=(ZERO,))
            for kind, ending in zip(kinds, endings, strict=False)
        ]
        steps = [
            replace(step, axis=axis.direction, values=axis.values)
            for step, axis in zip(steps, joint.axes, strict=False)
        ] or [replace(step, start=UPRIGHT) for step in steps]
        if not steps:
            steps = [MachineJoint(joint.name, "fixed", "", "", AxesPlace(), AxesPlace(), span)]
        parent, child = joint.parent, joint.child
        if not is_forward:
            parent, child = child, parent
            steps = [replace(step, axis=(-step.axis[0], -step.axis[1], -step.axis[2])) for step in reversed(steps)]
        before = self._places[parent].inverse.then(joint.place)
        after = joint.place.inverse.then(self._places[child])
        for number, step in enumerate(steps, 1):
            last = number == len(steps)
            end = child if last else f"{step.name} of {joint.name}"
            if not last:
                self._links[end] = MachineLink(end, (), span, True)
            place, rest = before if number == 1 else AxesPlace(), after if last else AxesPlace()
            self._made.append(replace(step, parent=parent, child=end, place=place, rest=rest))
            parent = end

    def _close(self, joint: SdfJoint) -> None:
        """A joint beyond the tree: both its sides meet as they do where the file has them."""
        what = f"the joint `{joint.name}` of type {joint.kind} closes a loop"
        remedy = "write it in front of the other joints of its loop, so that another one closes it"
        if joint.kind not in LOOPS:
            self._reader.wrong(f"{what}, which this type cannot", remedy, joint.span)
            return
        acting = [key for axis in joint.axes for key in FORCES if key in axis.values and axis.values[key].value]
        if acting or any(axis.mimic for axis in joint.axes):
            message = f"{what}, and has no coordinate that friction, springs or mimics could act in"
            self._reader.wrong(message, remedy, joint.span)
            return
        if any({"lower", "velocity"} & set(axis.values) for axis in joint.axes):
            self._reader.leave_out("limit", joint.name)
        at = joint.place
        if joint.axes and any(joint.axes[0].direction):
            at = at.then(AxesPlace(axes=z_to(joint.axes[0].direction)))
        ends = self._places[joint.parent].inverse.then(at), self._places[joint.child].inverse.then(at)
        self._closings.append(Closing(joint.name, LOOPS[joint.kind], (joint.parent, joint.child), ends, joint.span))

    def _followers(self) -> Iterator[Follower]:
        single = {joint.name: joint for joint in self._made if len(joint.start) == 1}
        for joint in self._joints:
            for axis, ending in zip(joint.axes, ("_1", "_2"), strict=False):
                mimic = axis.mimic
                if mimic is None or joint.name in {closing.name for closing in self._closings}:
                    continue
                follower = joint.name if len(joint.axes) == 1 else joint.name + ending
                leader = mimic.joint if mimic.joint in single else mimic.joint + ENDINGS_OF_AXES.get(mimic.axis, "")
                if leader not in single or leader == follower:
                    message = f"`{joint.name}` mimics `{mimic.joint}`, which is no other joint with such a coordinate"
                    others = [name for name in single if name != follower]
                    remedy = did_you_mean(mimic.joint, others, "name a joint of the tree with an axis")
                    self._reader.wrong(message, remedy, mimic.span)
                    continue
                factor = mimic.multiplier or computed(Fraction(1), mimic.span)
                factors = (computed(ZERO, mimic.span), factor)
                yield Follower(
                    f"{follower}_mimic", follower, leader, factors, mimic.offset, mimic.reference, mimic.span
                )
