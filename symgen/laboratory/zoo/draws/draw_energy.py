"""Planar systems given by their energies: trees of links, loops closed where they stand, rows, inputs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

from symgen.laboratory.zoo.dice import Dice, decimal
from symgen.laboratory.zoo.draws.describe import Description, Terms
from symgen.laboratory.zoo.draws.draw_potentials import potentials
from symgen.laboratory.zoo.draws.endings import finish
from symgen.laboratory.zoo.draws.sketch import Sketch


@dataclass(frozen=True)
class DrawnLink:
    """A link that was drawn: its coordinate, angle and places as texts."""

    coordinate: str
    parent: int
    slides: bool
    angle: str
    turning: str
    base: tuple[str, str]
    tip: tuple[str, str]
    length: str


def planar_energies(dice: Dice) -> Description:
    """A tree of links in a vertical plane with up to four loops."""
    sketch = Sketch(dice, "planar_energies")
    sketch.inlined = dice.chance(0.35)
    links = _tree(sketch, dice.whole(1, dice.choice((3, 5, 8, 12))))
    loops = min(dice.weighted({0: 4, 1: 4, 2: 3, 3: 2, 4: 1.5}), (len(links) - 1) // 2)
    units = dict[str, str]()
    if dice.chance(0.06):
        # what cannot move is refused
        for link in links:
            units[sketch.row(f"hold_{link.coordinate}", link.coordinate)] = "m" if link.slides else "rad"
    for index in range(loops):
        sketch.that_moves(partial(_loop, sketch, links, index, units), oddly=0.15)
    _potentials(sketch, links)
    _surplus(sketch, units)
    _inputs(sketch, links)
    return finish(sketch)


def _tree(sketch: Sketch, count: int) -> list[DrawnLink]:
    dice = sketch.dice
    absolute = dice.chance(0.5)
    if count > 2:
        sketch.mark("absolute angles" if absolute else "relative angles")
    extreme, equal = dice.chance(0.06), dice.chance(0.15)
    shared = sketch.parameter("l", dice.length()) if equal else ""
    massless = dice.chance(0.12)
    gravity = sketch.parameter("g", "9.81") if dice.chance(0.8) else "0"
    links: list[DrawnLink] = []
    kinetic: list[str] = []
    potential: list[str] = []
    for k in range(1, count + 1):
        parent = (
            -1
            if not links or dice.chance(0.12)
            else (len(links) - 1 if dice.chance(0.7) else dice.whole(0, len(links) - 1))
        )
        slides = dice.chance(0.15)
        before = links[parent] if parent >= 0 else None
        base = before.tip if before else ("0", decimal(dice.uniform(0.5, 2), 2) if parent < 0 and links else "0")
        if before is None and links:
            base = (decimal(dice.uniform(0.3, 2), 2), "0")
        if slides:
            coordinate = sketch.coordinate(f"s_{k}", round(dice.uniform(0.2, 0.9), 2), "m")
            angle = before.angle if before else dice.choice(("0", "pi/2", "0.3"))
            turning = before.turning if before else "0"
            length = coordinate
        else:
            coordinate = sketch.coordinate(f"a_{k}", dice.angle())
            relative = not absolute and before is not None and before.angle != "0"
            angle = (
                sketch.definition(f"th_{k}", f"{before.angle} + {coordinate}") if relative and before else coordinate
            )
            carried = relative and before is not None and before.turning != "0"
            turning = f"({before.turning} + {coordinate}_dot)" if carried and before else f"{coordinate}_dot"
            length = shared or sketch.parameter(f"l_{k}", dice.length())
        tip = tuple(
            sketch.definition(f"{axis}_{k}", joined([*([place] if place != "0" else []), f"{length}*{wave}({angle})"]))
            for axis, place, wave in zip("xy", base, ("cos", "sin"), strict=True)
        )
        links.append(DrawnLink(coordinate, parent, slides, angle, turning, base, (tip[0], tip[1]), length))
        weightless = massless and k < count and dice.chance(0.4)
        if weightless:
            continue
        mass = sketch.parameter(f"m_{k}", dice.mass(extreme))
        velocity = _velocity(sketch, links, k - 1, dice.choice(("1", "1/2", "0.4")))
        kinetic.append(f"{mass}/2*({velocity[0]}**2 + {velocity[1]}**2)")
        if not slides or before is not None:
            inertia = "0" if dice.chance(0.15) else sketch.parameter(f"J_{k}", dice.number(0.001, 0.4, 2))
            if inertia != "0" and turning != "0":
                kinetic.append(f"{inertia}/2*{turning}**2")
        if gravity != "0":
            potential.append(f"{mass}*{gravity}*{tip[1]}")
    sketch.blocks["kinetic_energy"] = Terms(tuple(kinetic or [f"{links[0].coordinate}_dot**2"]))
    sketch.blocks["potential_energy"] = Terms(tuple(potential))
    return links


def _velocity(sketch: Sketch, links: list[DrawnLink], index: int, share: str) -> tuple[str, str]:
    """The velocity of the point at a share of a link, summed along its chain."""
    parts: tuple[list[str], list[str]] = [], []
    current, factor = index, "" if share == "1" else f"{share}*"
    while current >= 0:
        link = links[current]
        if link.slides:
            parts[0].append(f"{factor}{link.coordinate}_dot*cos({link.angle})")
            parts[1].append(f"{factor}{link.coordinate}_dot*sin({link.angle})")
        if link.turning != "0":
            parts[0].append(f"-{factor}{link.length}*sin({link.angle})*{link.turning}")
            parts[1].append(f"{factor}{link.length}*cos({link.angle})*{link.turning}")
        current, factor = link.parent, ""
    names = tuple(
        sketch.definition(f"v{axis}_{index + 1}", joined(part)) for axis, part in zip("xy", parts, strict=True)
    )
    return names[0], names[1]


def joined(terms: list[str]) -> str:
    """Terms as a sum, signs as people write them."""
    text = terms[0]
    for term in terms[1:]:
        text += f" - {term[1:]}" if term.startswith("-") else f" + {term}"
    return text


def _loop(sketch: Sketch, links: list[DrawnLink], index: int, units: dict[str, str]) -> int:
    """One loop more: a tip at the ground, on a line, on another tip, or at the end of a rod; how many rows it has.

    `units` are those of rows by name.
    """
    dice = sketch.dice
    # a chain that is long enough to move when it is closed, and now and then any
    least = 1 if dice.chance(0.07) else 3
    deep = [k for k in range(1, len(links)) if _depth(links, k) >= least] or [len(links) - 1]
    leaf = dice.choice(deep)
    x, y = links[leaf].tip
    others = [k for k in range(len(links)) if k != leaf]
    other = links[dice.choice(others)].tip
    kind = dice.weighted({"ground": 4, "line": 3, "meet": 2, "rod": 2, "angle": 1})
    match kind:
        case "ground":
            units[sketch.row(f"close_{index}_x", x)] = "m"
            units[sketch.row(f"close_{index}_y", y)] = "m"
        case "line":
            slope = dice.choice(("0", "0", "0.5", "1"))
            units[sketch.row(f"guide_{index}", y if slope == "0" else f"{y} - {slope}*{x}")] = "m"
        case "meet":
            # the other point is carried along at a fixed offset across both: a pin on a plate
            units[sketch.row(f"pin_{index}_x", f"{x} - {other[0]}")] = "m"
            units[sketch.row(f"pin_{index}_y", f"{y} - {other[1]}")] = "m"
        case "rod":
            text = f"({x} - {other[0]})**2 + ({y} - {other[1]})**2"
            is_length = dice.chance(0.3)
            units[sketch.row(f"rod_{index}", f"sqrt({text})" if is_length else text)] = "m" if is_length else "m**2"
        case _:
            slides = dice.chance(0.3)
            alike = [link.coordinate for link in links if link.slides == slides]
            if len(alike) < 2:
                alike = [link.coordinate for link in links if link.slides != slides]
            if len(alike) < 2:
                return 0
            one, two = dice.sample(alike, 2)
            ratio = dice.choice(("1", "2", "-3", "0.5"))
            sketch.mark("coupling")
            text = f"{one} - {ratio}*{two}" if ratio[0] != "-" else f"{one} + {ratio[1:]}*{two}"
            slides = any(link.slides for link in links if link.coordinate == one)
            units[sketch.row(f"gear_{index}", text)] = "m" if slides else "rad"
    if kind != "angle":
        sketch.mark("loop in the plane")
    return 2 if kind in ("ground", "meet") else 1


def _depth(links: list[DrawnLink], index: int) -> int:
    """How many links lead from the ground to a tip."""
    return 0 if index < 0 else 1 + _depth(links, links[index].parent)


def _potentials(sketch: Sketch, links: list[DrawnLink]) -> None:
    """Springs and stranger potentials."""
    dice = sketch.dice
    link = dice.choice(links)
    angles = [each.coordinate for each in links if not each.slides]
    terms = potentials(sketch, angles, [each.coordinate for each in links if each.slides], link.tip)
    old = sketch.blocks["potential_energy"]
    sketch.blocks["potential_energy"] = Terms((*old.terms, *terms))
    if not sketch.blocks["potential_energy"].terms:
        del sketch.blocks["potential_energy"]
    for link in links:
        if dice.chance(0.12):
            rate = f"{link.coordinate}_dot"
            force = dice.choice((f"-0.4*{rate}", f"-2*tanh({rate}/0.05)", f"-0.1*{rate}*sqrt({rate}**2 + 1e-4)"))
            sketch.block("applied_forces")[link.coordinate] = force


def _surplus(sketch: Sketch, units: Mapping[str, str]) -> None:
    """Rows that say once more what others say; what is in other units has no sum with them."""
    dice = sketch.dice
    rows = (sketch.blocks.get("constraints") or {}).get("geometric") or {}
    if not rows or not dice.chance(0.15):
        return
    name = dice.choice(list(rows))
    text = rows[name]
    others = [each for each in rows if each != name and units[each] == units[name]]
    if len(rows) > 1 and dice.chance(0.5) and others:
        other = dice.choice(others)
        text = f"({text}) + {dice.choice(('2', '0.5', '1'))}*({rows[other]})"
    else:
        text = f"{dice.choice(('2', '-1', '1e-6', '1e6', '1'))}*({text})"
    rows[sketch.name("again")] = text


def _inputs(sketch: Sketch, links: list[DrawnLink]) -> None:
    """Too few, enough or too many inputs."""
    dice = sketch.dice
    rows = len((sketch.blocks.get("constraints") or {}).get("geometric") or {})
    freedom = max(1, len(links) - rows)
    count = max(0, freedom + dice.weighted({-1: 2, 0: 5, 1: 2, 2: 1, 3: 0.4}))
    drawn: list[dict[str, str]] = []
    for _ in range(count):
        drawn.append(_column(sketch, links))
        if dice.chance(0.06):
            drawn.append(dict(drawn[-1]))
    for k, column in enumerate(drawn, 1):
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"acts_on": column}


def _column(sketch: Sketch, links: list[DrawnLink]) -> dict[str, str]:
    dice = sketch.dice
    index = dice.whole(0, len(links) - 1)
    link = links[index]
    if dice.chance(0.7):
        if dice.chance(0.2) and link.parent >= 0 and not link.slides and not links[link.parent].slides:
            return {link.coordinate: "1", links[link.parent].coordinate: "-1"}
        return {link.coordinate: dice.choice(("1", "1", "1", "2.5", "-1"))}
    # a force along x or y at the tip: what each joint of the chain does to the tip
    along = dice.whole(0, 1)
    column: dict[str, str] = {}
    current = index
    while current >= 0:
        each = links[current]
        relative = each.angle != each.coordinate and not each.slides
        turning_base = each.base if relative or _carries(links, current) else None
        if each.slides:
            column[each.coordinate] = f"{('cos', 'sin')[along]}({each.angle})"
        elif turning_base is not None and "+" in each.turning:
            column[each.coordinate] = (
                f"-({link.tip[1]} - {each.base[1]})" if along == 0 else f"{link.tip[0]} - {each.base[0]}"
            )
        else:
            sign, wave = (("-", "sin"), ("", "cos"))[along]
            column[each.coordinate] = f"{sign}{each.length}*{wave}({each.angle})"
        current = each.parent
    return column


def _carries(links: list[DrawnLink], index: int) -> bool:
    return any(link.parent == index and links[index].coordinate in link.turning for link in links)
