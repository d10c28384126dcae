"""What links of a URDF look like: solids for animations, of files that nobody trusts."""

from __future__ import annotations

import math
import os
import struct
from collections import Counter
from itertools import pairwise
from pathlib import Path

import pytest

from symgen.drawing.scene import IN_WORLD, scene
from symgen.model.load import load_model
from symgen.model.mechanism import DrawnSolid
from symgen.model.model import Model
from symgen.model.robots.faces import MOST_TRIANGLES, Faces, box, cylinder, of_stl, sphere
from symgen.notebook.model_file import load
from symgen.simulate.animation import animation

WEDGE = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 3.0))
SIDES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
TEXT = "solid wedge\n" + "".join(
    "facet normal 0 0 0\nouter loop\n"
    + "".join("vertex {:g} {:g} {:g}\n".format(*WEDGE[k]) for k in side)
    + "endloop\nendfacet\n"
    for side in SIDES
)


def robot(looks: str, further: str = "") -> str:
    inertia = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    return f"""<robot name="arm"><link name="base"/>
<link name="arm">{looks}<inertial><mass value="1"/>{inertia}</inertial></link>{further}
<joint name="turn" type="continuous"><parent link="base"/><child link="arm"/>
<origin xyz="0 0 1"/><axis xyz="0 0 1"/></joint></robot>"""


def seen(geometry: str, origin: str = "", tag: str = "visual") -> str:
    return f"<{tag}>{origin}<geometry>{geometry}</geometry></{tag}>"


def model_of(folder: Path, text: str, head: str = "arm.urdf") -> Model:
    (folder / "arm.urdf").write_text(text, encoding="utf-8")
    (folder / "arm.yaml").write_text(f"model: machine\nurdf: {head}\n", encoding="utf-8")
    return load_model(folder / "arm.yaml")


def binary(count: int | None = None) -> bytes:
    triangles = (struct.pack("<12fH", 0, 0, 0, *(x for k in side for x in WEDGE[k]), 0) for side in SIDES)
    return bytes(80) + struct.pack("<I", len(SIDES) if count is None else count) + b"".join(triangles)


def edges(faces: Faces) -> Counter[tuple[int, int]]:
    return Counter((one[k - 1], one[k]) for one in faces.faces for k in range(len(one)))


@pytest.mark.parametrize(
    ("made", "volume"),
    [(box(1, 2, 3), 6), (cylinder(1, 2), 8 * 2 * math.sin(math.pi / 8)), (sphere(1), 4 / 3 * math.pi)],
)
def test_solids_are_closed_and_as_large_as_they_are(made: Faces, volume: float) -> None:
    """Each edge is passed once in each direction, so that all faces look outwards; the volume by Gauss."""
    passed = edges(made)
    assert set(passed.values()) == {1}
    assert {(b, a) for a, b in passed} == set(passed)
    within = 0.0
    for face in made.faces:
        (a, b, c), *others = (made.corners[k] for k in face)
        for (d, e, f), (g, h, i) in pairwise(others):
            within += (a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g)) / 6
    assert within == pytest.approx(volume, rel=0.1)


def test_stl_is_read_in_both_forms() -> None:
    for data in (binary(), TEXT.encode()):
        read = of_stl(data)
        assert read is not None
        assert sorted(read.corners) == sorted(WEDGE)
        assert [[read.corners[k] for k in face] for face in read.faces] == [[WEDGE[k] for k in side] for side in SIDES]


@pytest.mark.parametrize(
    "data",
    [
        b"", b"solid", bytes(84), binary(5), binary()[:-1], b"solid x\nvertex 1 2 3\n",
        b"solid\n" + b"vertex a b c\n" * 3,
        bytes(80) + struct.pack("<I", MOST_TRIANGLES + 1) + bytes(50 * (MOST_TRIANGLES + 1)),
    ],
)  # fmt: skip
def test_what_is_no_stl_is_no_mesh(data: bytes) -> None:
    assert of_stl(data) is None


def test_a_solid_stands_where_its_origin_is(tmp_path: Path) -> None:
    """Roll, pitch and yaw are about fixed axes: x leads to z by the pitch, then nowhere by the yaw."""
    origin = '<origin xyz="1 2 3" rpy="0 -1.5707963267948966 1.5707963267948966"/>'
    (solid,) = model_of(tmp_path, robot(seen('<box size="4 0.2 0.6"/>', origin))).picture.solids
    low, high = (tuple(map(end, zip(*solid.corners, strict=True))) for end in (min, max))
    assert (solid.frame, len(solid.faces)) == ("arm", 6)
    assert low == pytest.approx((1 - 0.1, 2 - 0.3, 3 - 2))
    assert high == pytest.approx((1 + 0.1, 2 + 0.3, 3 + 2))


def test_collision_stands_for_what_is_not_seen(tmp_path: Path) -> None:
    ball, block = seen('<sphere radius="1"/>', tag="collision"), seen('<box size="1 1 1"/>')
    faces = [
        [len(one.faces) for one in model_of(tmp_path, robot(looks), head).picture.solids]
        for looks, head in (
            (ball, "arm.urdf"), (ball + block, "arm.urdf"), (ball + block, "{file: arm.urdf, leave_out: [visual]}")
        )
    ]  # fmt: skip
    assert faces == [[128], [6], [128]]


def test_meshes_lie_in_the_folder_of_the_robot(tmp_path: Path) -> None:
    inside, outside = tmp_path / "robot", tmp_path / "wedge.stl"
    (inside / "meshes").mkdir(parents=True)
    (inside / "meshes/wedge.stl").write_bytes(binary())
    (inside / "meshes/wedge.dae").write_bytes(binary())
    outside.write_bytes(binary())
    os.symlink(outside, inside / "link.stl")

    def solids(name: str) -> tuple[tuple[DrawnSolid, ...], list[str]]:
        scaled = f'<mesh filename="{name}" scale="2 1 1"/>'
        model = model_of(inside, robot(seen(scaled)))
        return model.picture.solids, [one.message for one in model.notices if one.message.startswith("meshes")]

    (wedge,), said = solids("meshes/wedge.stl")
    assert (2, 0, 0) in wedge.corners
    assert not said
    for name in (
        "meshes/wedge.dae", "../wedge.stl", "link.stl", str(outside), f"file://{outside}", "package://arm/wedge.stl",
        "meshes", "none.stl", "",
    ):  # fmt: skip
        none, (notice,) = solids(name)
        assert not none
        assert f"not drawn ({name}): an STL file" in notice
    # in a notebook the model lies elsewhere, and its meshes with it
    solids("meshes/wedge.stl")
    assert len(load(inside / "arm.yaml").resolved.picture.solids) == 1


@pytest.mark.parametrize(
    "geometry",
    [
        '<box size="1 1"/>', '<box size="1 1 0"/>', '<box size="1 1 nan"/>', '<sphere radius="1e9"/>', "<sphere/>",
        '<cylinder radius="1"/>', '<capsule radius="1" length="1"/>', '<sphere radius="-1"/>', '<sphere radius="a"/>',
    ],
)  # fmt: skip
def test_geometry_without_a_size_is_told_and_no_mistake(geometry: str, tmp_path: Path) -> None:
    model = model_of(tmp_path, robot(seen(geometry)))
    assert not model.picture.solids
    assert any(one.message.startswith("geometry of the URDF is not drawn (arm)") for one in model.notices)


def test_equations_have_nothing_of_it(tmp_path: Path) -> None:
    plain, drawn = (model_of(tmp_path, robot(looks)) for looks in ("", seen('<sphere radius="1"/>')))
    assert plain.mechanism.solids == drawn.mechanism.solids == ()
    assert len(drawn.pictured.solids) == 1
    assert [frame.name for frame in plain.mechanism.frames] == [frame.name for frame in drawn.mechanism.frames]


def test_solids_move_in_the_place_of_bars(tmp_path: Path) -> None:
    looks = seen('<box size="2 0.2 0.2"/>', '<origin xyz="1 0 0"/>')
    stand = '<link name="foot">' + seen('<box size="1 1 1"/>') + "</link>"
    fixed = stand + '<joint name="f" type="fixed"><parent link="base"/><child link="foot"/></joint>'
    model = model_of(tmp_path, robot(looks, fixed))
    shown = scene(model, {}, [(0.0,), (1.0,)])
    assert shown is not None
    by_frame = {shown.names[one.frame]: one for one in shown.solids}
    assert {name: len(one.faces) for name, one in by_frame.items()} == {"arm": 6, "foot": 6}
    assert all(one.frame in shown.turned for one in shown.solids)
    # bars of these are left out, the stand of the world stays, and boxes say how far solids reach
    assert [one.frame == IN_WORLD for one in shown.links if one.shown] == [True]
    reach = max(place[0] for one in shown.links if not one.shown for place in one.places)
    assert reach == pytest.approx(2)
    page = animation("arm", (0.0, 1.0), shown)
    assert "Links as the URDF shows them" in page
