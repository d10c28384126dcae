"""A robot description read by the witness: its links and joints as blocks of the model language."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any
from xml.etree import ElementTree

QUARTER, NEAR = math.pi / 2, 1e-8
ZERO = "0 0 0"


def expanded(blocks: Mapping[str, Any], files: Mapping[str, str]) -> dict[str, Any]:
    """The blocks with the robot of `urdf` in them, as the documentation says what becomes of it."""
    given = blocks.get("urdf")
    if not given:
        return dict(blocks)
    entry = {"file": given} if isinstance(given, str) else given
    robot = ElementTree.fromstring(files[entry["file"]])
    made = _robot(robot, entry)
    links = {link.get("name", "") for link in robot.iter("link")}
    root = next(iter(links - {joint.find("child").get("link") for joint in robot.iter("joint")}))  # type: ignore[union-attr]
    placed = {*(blocks.get("frames") or {}), *(e.get("child", n) for n, e in (blocks.get("joints") or {}).items())}
    if root != "world" and root not in placed:
        made["frames"] = {root: {}, **made["frames"]}
    merged = {key: value for key, value in blocks.items() if key != "urdf"}
    for name, block in made.items():
        if not block:
            continue
        if name == "constraints":
            old = merged.get(name) or {}
            merged[name] = {**old, "geometric": {**block["geometric"], **(old.get("geometric") or {})}}
        else:
            merged[name] = {**block, **(merged.get(name) or {})}
    return merged


def _robot(robot: ElementTree.Element, entry: Mapping[str, Any]) -> dict[str, Any]:
    frames: dict[str, Any] = {}
    joints: dict[str, Any] = {}
    bodies: dict[str, Any] = {}
    friction: dict[str, Any] = {}
    ranges: dict[str, Any] = {}
    rows: dict[str, str] = {}
    for joint in robot.iter("joint"):
        name, kind = joint.get("name", ""), joint.get("type")
        parent, child = (_of(joint, what, "link") for what in ("parent", "child"))
        place, turns = _origin(joint)
        if kind == "fixed":
            frames[child] = _placed(parent, place, turns)
            continue
        axis = _of(joint, "axis", "xyz", "1 0 0").split()
        motion = {"type": "prismatic" if kind == "prismatic" else "revolute", "axis": axis, "coordinate": name}
        turned = {"rotation": turns} if turns else {}
        joints[name] = {**motion, "parent": parent, "child": child, "at": place, **turned}
        friction |= dict(_friction(joint, name, entry))
        ranges |= dict(_limits(joint, name))
        mimic = joint.find("mimic")
        if mimic is not None:
            follows = f"{mimic.get('multiplier', '1')}*{mimic.get('joint')} + {mimic.get('offset', '0')}"
            rows[f"{name}_mimic"] = f"{name} - ({follows})"
    for link in robot.iter("link"):
        inertial = link.find("inertial")
        if inertial is None:
            continue
        place, turns = _origin(inertial)
        name = f"{link.get('name')}_inertial"
        frames[name] = _placed(link.get("name", ""), place, turns)
        tensor = inertial.find("inertia")
        bodies[name] = {
            "mass": _of(inertial, "mass", "value"),
            "inertia": {key[1:]: value for key, value in (tensor.attrib if tensor is not None else {}).items()},
        }
    constraints = {"geometric": rows} if rows else {}
    return {
        "frames": frames, "joints": joints, "bodies": bodies, "friction": friction, "ranges": ranges,
        "constraints": constraints,
    }  # fmt: skip


def _placed(parent: str, place: list[str], turns: list[Any]) -> dict[str, Any]:
    return {"parent": parent, "translation": place, **({"rotation": turns} if turns else {})}


def _of(element: ElementTree.Element, what: str, attribute: str, otherwise: str = "") -> str:
    child = element.find(what)
    return otherwise if child is None else child.get(attribute, otherwise)


def _origin(element: ElementTree.Element) -> tuple[list[str], list[Any]]:
    """Translation, and yaw, pitch, roll about the axes reached so far."""
    place = _of(element, "origin", "xyz", ZERO).split()
    angles = _of(element, "origin", "rpy", ZERO).split()
    turns = [[axis, _angle(text)] for axis, text in zip("xyz", angles, strict=True) if float(text)]
    return place, turns[::-1]


def _angle(text: str) -> str:
    """Angles within 1e-8 of a multiple of a quarter turn stand for it."""
    count = _quarters(float(text))
    return f"{count}*pi/2" if count else text


def exact_angles(text: str) -> str:
    """A URDF in which angles that stand for multiples of a quarter turn have all their digits."""

    def whole(match: re.Match[str]) -> str:
        angles = (float(angle) for angle in match[2].split())
        texts = (repr(count * QUARTER if (count := _quarters(angle)) else angle) for angle in angles)
        return f"{match[1]}{' '.join(texts)}{match[3]}"

    return re.sub(r"""(\brpy\s*=\s*["'])([^"']*)(["'])""", whole, text)


def _quarters(angle: float) -> int:
    """The multiple of a quarter turn that an angle stands for, 0 for none."""
    count = round(angle / QUARTER)
    return count if abs(angle - count * QUARTER) < NEAR else 0


def _friction(joint: ElementTree.Element, name: str, entry: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    damping, dry = (_of(joint, "dynamics", key, "0") for key in ("damping", "friction"))
    coefficients = {"viscous": damping} if float(damping) else {}
    if float(dry):
        coefficients |= {"coulomb": dry, "width": str(entry["friction_width"])}
    if coefficients:
        yield name, coefficients


def _limits(joint: ElementTree.Element, name: str) -> Iterator[tuple[str, Any]]:
    limit = joint.find("limit")
    if limit is not None and joint.get("type") != "continuous" and "lower" in limit.attrib:
        yield name, [limit.get("lower"), limit.get("upper")]
