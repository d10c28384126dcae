"""`urdf: robot.urdf`: the file beside the model, read with suspicion, as blocks of the model language."""

from __future__ import annotations

from pathlib import Path

from symgen.diagnostics import Mistake, Notice, Span, printable
from symgen.model.file.scope import Scope
from symgen.model.file.source import MappingNode
from symgen.model.mechanism import DrawnSolid
from symgen.model.robots.file import Imported, read_description
from symgen.model.robots.names import read_names
from symgen.model.robots.nodes import ranged_names
from symgen.model.robots.numbers import WrittenNumber, quarters
from symgen.model.urdf.blocks import with_robot
from symgen.model.urdf.bodies import judge_links
from symgen.model.urdf.checks import check_joints, find_root
from symgen.model.urdf.elements import GEOMETRY, read_robot
from symgen.model.urdf.looks import read_looks, said_of
from symgen.model.urdf.robot import Robot, named_things

ABOUT = {
    "transmission": "inputs stand in the model file, as forces and torques of the joints",
    "ros2_control": "inputs stand in the model file, as forces and torques of the joints",
    "gazebo": "it is for a simulator",
    "safety_controller": "it is for a controller",
}
# a quarter turn written with too few digits to be one
NEAR_QUARTER = 1e-4


def import_robot(scope: Scope, tree: MappingNode, folder: Path) -> Imported:
    """The robot that `urdf` names, in the tree; what is wrong with it is recorded, and the tree then stays as it is."""
    given = read_description(scope, tree, folder, "urdf")
    text, file, span, root = given.text, given.file, given.span, given.root
    if root is None:
        return Imported(tree, text, file)
    robot, mistakes = read_robot(root, given.unread)
    if not mistakes and not robot.links:
        mistakes = (Mistake("the robot has no links", "give a URDF file with links and joints", root.span),)
    if not mistakes:
        robot, mistakes = find_root(robot)
    scope.mistakes.extend(mistakes)
    if mistakes:
        return Imported(tree, text, file)
    names = read_names(scope, given.node, named_things(robot), span)
    own = ranged_names(tree)
    scope.mistakes.extend(check_joints(robot, {joint for joint, name in names.coordinates.items() if name in own}))
    solids: tuple[DrawnSolid, ...] = ()
    if not scope.mistakes:
        tree = with_robot(scope, tree, robot, names, span)
        looks = read_looks(root, names.frames, given.unread, Path(file).parent)
        solids = tuple(looks.solids)
        undrawn = (Notice(said, span) for said in said_of(looks))
        notices = (*_notices(robot, span), *undrawn, *judge_links(robot))
        # names in the file are any text
        scope.notices.extend(Notice(printable(notice.message), notice.span) for notice in notices)
        efforts = _listed(robot, "effort")
        if efforts:
            scope.efforts = Notice(printable(f"effort limits of the URDF bound no input ({efforts})"), span)
    return Imported(tree, text, file, solids)


def _notices(robot: Robot, span: Span) -> list[Notice]:
    """What of the robot description takes no part, by name."""
    notices = []
    geometry = [f"`{tag}`" for tag in GEOMETRY if tag in robot.left_out]
    if geometry:
        are = "is" if len(geometry) == 1 else "are"
        notices.append(Notice(f"{' and '.join(geometry)} of the URDF {are} geometry, for animations alone", span))
    for tag, names in robot.left_out.items():
        if tag not in GEOMETRY:
            listed = ", ".join(dict.fromkeys(name for name in names if name)) or "no name"
            why = f": {ABOUT[tag]}" if tag in ABOUT else ""
            notices.append(Notice(f"`{tag}` of the URDF takes no part ({listed}){why}", span))
    still = [name for name, joint in robot.joints.items() if _is_zero(joint.limits.get("velocity"))]
    if still:
        message = f"velocity limits of 0 in the URDF are taken for none ({', '.join(still)})"
        notices.append(Notice(message, span))
    for joint in robot.joints.values():
        idle = _idle(joint.kind, joint.limits, joint.dynamics, joint.mimic is not None)
        if idle:
            notices.append(Notice(f"{idle} of the {joint.kind} joint `{joint.name}` says nothing", joint.span))
        for angle in joint.origin.rpy:
            turns = float(angle.value) / 1.5707963267948966
            if quarters(angle) is None and abs(turns - round(turns)) < NEAR_QUARTER:
                message = f"the angle {angle.text} is taken as written; with eight digits a quarter turn is exact"
                notices.append(Notice(message, angle.span))
    return notices


def _idle(kind: str, limits: dict[str, WrittenNumber], dynamics: dict[str, WrittenNumber], mimics: bool) -> str:
    """What a joint of this kind has no use for."""
    unused = []
    if kind in ("fixed", "planar", "floating") and any(value.value for value in limits.values()):
        unused.append("`limit`")
    if kind == "continuous" and any(key in limits for key in ("lower", "upper")):
        unused.append("the position in `limit`")
    if kind == "fixed" and any(value.value for value in dynamics.values()):
        unused.append("`dynamics`")
    if kind == "fixed" and mimics:
        unused.append("`mimic`")
    return " and ".join(unused)


def _listed(robot: Robot, key: str) -> str:
    bounds = ((name, joint.limits.get(key)) for name, joint in robot.joints.items() if joint.kind != "fixed")
    return ", ".join(f"{name} {bound.text}" for name, bound in bounds if bound is not None and bound.value > 0)


def _is_zero(value: WrittenNumber | None) -> bool:
    return value is not None and value.value == 0
