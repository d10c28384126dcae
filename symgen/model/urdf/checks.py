"""Whether the links hang together as one tree, and whether each joint says what its type needs."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace
from fractions import Fraction

from symgen.diagnostics import Mistake
from symgen.model.expressions.names import did_you_mean
from symgen.model.robots.reader import MAXIMUM_ANGLE
from symgen.model.urdf.robot import ENDINGS, Robot, UrdfJoint

# The direction that a planar joint needs as its normal.
NORMAL = (Fraction(0), Fraction(0), Fraction(1))


def find_root(robot: Robot) -> tuple[Robot, tuple[Mistake, ...]]:
    """The robot with its root link, and what is wrong with the tree."""
    mistakes = list(_ends(robot))
    if mistakes:
        return robot, tuple(mistakes)
    held = {joint.child for joint in robot.joints.values()}
    roots = [name for name in robot.links if name not in held]
    if len(roots) > 1:
        listed = ", ".join(f"`{name}`" for name in roots)
        message = f"the links are no tree: {listed} hang on nothing"
        remedy = "connect all links but one as `child` of a joint"
        return robot, (Mistake(message, remedy, robot.links[roots[1]].span),)
    circle = _circle(robot)
    if circle or not roots:
        span = next(iter(robot.links.values())).span if not circle else robot.links[circle[0]].span
        way = " -> ".join(f"`{name}`" for name in circle)
        remedy = "a robot description is a tree; close loops with `loops` in the model file"
        return robot, (Mistake(f"the links hang on each other: {way}", remedy, span),)
    return replace(robot, root=roots[0]), ()


def check_joints(robot: Robot, ranged: Collection[str]) -> Iterator[Mistake]:
    """Axes, limits and mimics that say nothing, too little, or the impossible; `ranged` are the joints whose ranges the
    model file gives."""
    for joint in robot.joints.values():
        yield from _axis(joint)
        if joint.name not in ranged:
            yield from _way(joint)
        yield from _sizes(joint)
        yield from _mimic(robot, joint)


def _ends(robot: Robot) -> Iterator[Mistake]:
    holders: dict[str, str] = {}
    for joint in robot.joints.values():
        for end, name in (("parent", joint.parent), ("child", joint.child)):
            if name and name not in robot.links:
                remedy = did_you_mean(name, robot.links, "name a link of this file")
                yield Mistake(f"the {end} `{name}` of the joint `{joint.name}` is no link", remedy, joint.span)
        if joint.parent == joint.child and joint.child in robot.links:
            message = f"the joint `{joint.name}` joins the link `{joint.child}` with itself"
            yield Mistake(message, "name two links, `parent` and `child`", joint.span)
        if joint.child in holders:
            message = f"the link `{joint.child}` hangs on two joints, `{holders[joint.child]}` and `{joint.name}`"
            remedy = "a robot description is a tree; close loops with `loops` in the model file"
            yield Mistake(message, remedy, joint.span)
        holders.setdefault(joint.child, joint.name)


def _circle(robot: Robot) -> list[str]:
    """Links that hang on each other, the first also as the last; none in a tree."""
    parents = {joint.child: joint.parent for joint in robot.joints.values()}
    sound: set[str] = set()
    for name in robot.links:
        line: list[str] = []
        while name in parents and name not in sound and name not in line:
            line.append(name)
            name = parents[name]
        if name in line:
            return [*line[line.index(name) :], name]
        sound.update(line)
    return []


def _axis(joint: UrdfJoint) -> Iterator[Mistake]:
    values = tuple(entry.value for entry in joint.axis)
    if joint.kind in ("revolute", "continuous", "prismatic") and values and not any(values):
        remedy = 'give its direction, such as <axis xyz="0 0 1"/>'
        yield Mistake(f"the axis of the joint `{joint.name}` has length zero", remedy, joint.axis[0].span)
    if joint.kind == "planar" and values != NORMAL:
        remedy = 'turn the joint by the `rpy` of its origin so that <axis xyz="0 0 1"/> is the normal of the plane'
        span = joint.axis[0].span if joint.axis else joint.span
        yield Mistake(f"the planar joint `{joint.name}` does not have z as its axis", remedy, span)


def _way(joint: UrdfJoint) -> Iterator[Mistake]:
    """Between which positions the joint moves."""
    if joint.kind not in ("revolute", "prismatic"):
        return
    lower, upper = joint.limits.get("lower"), joint.limits.get("upper")
    free = ", or make it continuous" if joint.kind == "revolute" else ""
    remedy = f"give <limit lower=... upper=.../>, or its range under `ranges` of the model file{free}"
    ends = lower.value if lower else Fraction(0), upper.value if upper else Fraction(0)
    place = next((limit.span for limit in (lower, upper) if limit is not None), joint.span)
    if not joint.limits:
        yield Mistake(f"the {joint.kind} joint `{joint.name}` has no `limit`", remedy, joint.span)
    elif ends[0] >= ends[1]:
        shown = " and ".join(f"{float(end):.6g}" for end in ends)
        yield Mistake(f"the limits of the joint `{joint.name}` leave no way between {shown}", remedy, place)
    elif joint.kind == "revolute" and max(abs(end) for end in ends) > MAXIMUM_ANGLE:
        yield Mistake(f"the joint `{joint.name}` turns by more than {MAXIMUM_ANGLE} rad", remedy, place)


def _sizes(joint: UrdfJoint) -> Iterator[Mistake]:
    for key in ("velocity", "acceleration", "effort"):
        bound = joint.limits.get(key)
        if bound is not None and bound.value < 0:
            message = f"the {key} limit of the joint `{joint.name}` is negative"
            yield Mistake(message, "give its size", bound.span)
    if joint.kind in ("planar", "floating"):
        for key, value in joint.dynamics.items():
            if value.value != 0:
                message = f"`{key}` of the {joint.kind} joint `{joint.name}` is not read"
                remedy = "write it under `friction` in the model file, coordinate by coordinate"
                yield Mistake(message, remedy, value.span)


def _mimic(robot: Robot, joint: UrdfJoint) -> Iterator[Mistake]:
    mimic = joint.mimic
    if mimic is None or joint.kind == "fixed":
        return
    single = {name for name, other in robot.joints.items() if ENDINGS.get(other.kind) == ("",)}
    if joint.name not in single:
        message = f"the {joint.kind} joint `{joint.name}` cannot mimic another one"
        yield Mistake(message, "write constraints in the model file", mimic.span)
    elif mimic.joint not in single - {joint.name}:
        message = f"`{joint.name}` mimics `{mimic.joint}`, which is no other joint with one coordinate"
        remedy = did_you_mean(mimic.joint, single - {joint.name}, "name a revolute, continuous or prismatic joint")
        yield Mistake(message, remedy, mimic.span)
