"""What links of a URDF look like: `visual`, or else `collision`, as solids for animations; nothing here is a mistake.

Files are untrusted, and geometry is for pictures alone: what cannot be drawn is left out and told.  A mesh is read
where it is an STL file of moderate size in the folder of the robot description or below it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from symgen.model.kinematics.triples import plus
from symgen.model.mechanism import DrawnSolid
from symgen.model.robots.faces import MOST_BYTES, MOST_TRIANGLES, Corner, Faces, box, cylinder, of_stl, sphere
from symgen.model.robots.xml import Element

# Faces that are drawn of a robot, all its links together.
MOST_FACES = 4 * MOST_TRIANGLES
# Metres from the origin of its link beyond which nothing is drawn.
FARTHEST_DRAWN = 1e4
# Where a robot description names files.
FILE_NAMED = re.compile(r"""\bfilename\s*=\s*(?:"([^"]*)"|'([^']*)')""")


@dataclass(slots=True)
class Looks:
    """Solids in the axes of their links; links whose geometry, and meshes that are not drawn."""

    solids: list[DrawnSolid] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    meshes: list[str] = field(default_factory=list)


def read_looks(root: Element, frames: Mapping[str, str], unread: Collection[str], folder: Path) -> Looks:
    """The solids of all links, in `frames` by the names of links; meshes are looked for in `folder`."""
    looks, room = Looks(), MOST_FACES
    for link in root.all("link"):
        name = link.attributes.get("name", "")
        shown = [element for tag in ("visual", "collision") if tag not in unread for element in link.all(tag)]
        tags = {element.tag for element in shown}
        for element in shown:
            geometry = next((part for child in element.all("geometry") for part in child.children), None)
            if geometry is None or ("visual" in tags and element.tag != "visual"):
                continue
            faces = _faces(element, geometry, folder)
            if faces is not None and len(faces.faces) <= room:
                room -= len(faces.faces)
                looks.solids.append(DrawnSolid(frames[name], faces.corners, faces.faces))
            elif geometry.tag == "mesh":
                looks.meshes.append(geometry.attributes.get("filename", ""))
            else:
                looks.links.append(name)
    return looks


def said_of(looks: Looks) -> Iterator[str]:
    """What is not drawn, and why."""
    if looks.meshes:
        why = f"an STL file of at most {MOST_TRIANGLES} triangles in the folder of the URDF would be"
        yield f"meshes of the URDF are not drawn ({', '.join(dict.fromkeys(looks.meshes))}): {why}"
    if looks.links:
        listed = ", ".join(dict.fromkeys(looks.links))
        yield f"geometry of the URDF is not drawn ({listed}): boxes, cylinders and spheres of some size would be"


def _faces(shown: Element, geometry: Element, folder: Path) -> Faces | None:
    """A geometry at its origin; None where it has no size, no place or no mesh."""
    made = _mesh(geometry, folder) if geometry.tag == "mesh" else _simple(geometry)
    if made is None:
        return None
    origin = next(iter(shown.all("origin")), None)
    shift, angles = (_numbers(origin, key, 3) or (0.0, 0.0, 0.0) for key in ("xyz", "rpy"))
    if not all(map(math.isfinite, angles)):
        return None
    corners = tuple(_turned(corner, shift, angles) for corner in made.corners)
    return Faces(corners, made.faces) if all(abs(x) <= FARTHEST_DRAWN for corner in corners for x in corner) else None


def _simple(geometry: Element) -> Faces | None:
    size, radius, length = (_numbers(geometry, *key) for key in (("size", 3), ("radius", 1), ("length", 1)))
    match geometry.tag, size, radius, length:
        case "box", (x, y, z), _, _ if min(x, y, z) > 0:
            return box(x, y, z)
        case "cylinder", _, (r,), (h,) if min(r, h) > 0:
            return cylinder(r, h)
        case "sphere", _, (r,), _ if r > 0:
            return sphere(r)
    return None


def _mesh(geometry: Element, folder: Path) -> Faces | None:
    path = mesh_path(geometry.attributes.get("filename", ""), folder)
    if path is None:
        return None
    try:
        with path.open("rb") as stream:
            made = of_stl(stream.read(MOST_BYTES))
    except (OSError, ValueError):
        return None
    a, b, c = _numbers(geometry, "scale", 3) or (1.0, 1.0, 1.0)
    return made and Faces(tuple((a * x, b * y, c * z) for x, y, z in made.corners), made.faces)


def named_meshes(text: str, folder: Path) -> dict[str, Path]:
    """The meshes that a robot description names and that are there to be read, by the names in its text."""
    names = (one or other for one, other in FILE_NAMED.findall(text))
    return {name: path for name in names if (path := mesh_path(name, folder)) is not None}


def mesh_path(name: str, folder: Path) -> Path | None:
    """The STL file of that name in the folder or below it, if it is there and of moderate size."""
    parts = PurePosixPath(name).parts
    plain = name.isprintable() and not name.startswith("/") and ".." not in parts and not set("\\:") & set(name)
    if not plain or not name.lower().endswith(".stl"):
        return None
    path = folder / name
    try:
        inside = path.resolve().is_relative_to(folder.resolve()) and path.is_file()
        return path if inside and path.stat().st_size <= MOST_BYTES else None
    except (OSError, ValueError):
        return None


def _numbers(element: Element | None, key: str, count: int) -> tuple[float, ...]:
    """As many numbers as there should be, or none."""
    words = (element.attributes.get(key, "") if element is not None else "").split()
    try:
        numbers = tuple(map(float, words))
    except ValueError:
        return ()
    return numbers if len(numbers) == count else ()


def _turned(corner: Corner, shift: tuple[float, ...], angles: tuple[float, ...]) -> Corner:
    """Turned by roll, pitch and yaw about the fixed axes, then shifted."""
    x, y, z = corner
    roll, pitch, yaw = angles
    y, z = math.cos(roll) * y - math.sin(roll) * z, math.sin(roll) * y + math.cos(roll) * z
    x, z = math.cos(pitch) * x + math.sin(pitch) * z, math.cos(pitch) * z - math.sin(pitch) * x
    x, y = math.cos(yaw) * x - math.sin(yaw) * y, math.sin(yaw) * x + math.cos(yaw) * y
    a, b, c = shift
    return plus((x, y, z), (a, b, c))
