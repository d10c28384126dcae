"""Linkages that are known by name, most with more rows than they need: they move only because of their shape."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from symgen.laboratory.zoo.dice import Dice, decimal, exact
from symgen.laboratory.zoo.draws.describe import Description, Terms
from symgen.laboratory.zoo.draws.endings import finish
from symgen.laboratory.zoo.draws.sketch import Sketch


def parallelogram_energies(dice: Dice) -> Description:
    """A coupler on three to five equal and parallel cranks, given by energies in absolute angles."""
    sketch = Sketch(dice, "parallelogram_energies")
    cranks = dice.weighted({2: 4, 3: 2, 4: 1, 5: 1})
    if cranks > 2:
        sketch.mark("parallelogram with several cranks")
    angle = dice.angle()
    names = [sketch.coordinate(f"a_{k}", angle) for k in range(1, cranks + 1)]
    turns = dice.chance(0.7)
    coupler = sketch.coordinate("c", 0.0) if turns else ""
    length = sketch.parameter("l", dice.length())
    mass, inertia = sketch.parameter("m", dice.mass()), sketch.parameter("J", dice.number(0.01, 0.3, 2))
    kinetic = [f"{inertia}/2*{name}_dot**2" for name in names]
    speed = f"{length}**2*{names[0]}_dot**2"
    if turns:
        arm = sketch.parameter("h", dice.length())
        twice = f"2*{length}*{arm}*cos({names[0]} - {coupler})*{names[0]}_dot*{coupler}_dot"
        kinetic.append(f"{mass}/2*({speed} + {arm}**2*{coupler}_dot**2 + {twice})")
        kinetic.append(f"{inertia}/2*{coupler}_dot**2")
    else:
        kinetic.append(f"{mass}/2*{speed}")
    sketch.blocks["kinetic_energy"] = Terms(tuple(kinetic))
    if dice.chance(0.7):
        sketch.blocks["potential_energy"] = Terms((f"{mass}*9.81*{length}*sin({names[0]})",))
    rows = sketch.block("constraints").setdefault("geometric", {})
    for k, name in enumerate(names[1:], 1):
        before = names[0] if dice.chance(0.7) else names[k - 1]
        span = str(k) if before == names[0] else "1"
        offset = (f" + {span}*cos({coupler}) - {span}", f" + {span}*sin({coupler})") if turns else ("", "")
        rows[sketch.name(f"x_{k}")] = f"{length}*cos({before}){offset[0]} - {length}*cos({name})"
        rows[sketch.name(f"y_{k}")] = f"{length}*sin({before}){offset[1]} - {length}*sin({name})"
    _drives(sketch, names)
    description = finish(sketch)
    if cranks == 2 and dice.chance(0.5):
        # all bars on one line: two branches meet there, and both have the same ranks
        flat = dict.fromkeys(sketch.start, "0")
        # a name on purpose that is none stays
        blocks = {**description.blocks, "configuration": {**description.blocks.get("configuration", {}), **flat}}
        return replace(description, blocks=blocks, marks=(*description.marks, "start at a singular pose"))
    return description


def common_pin(dice: Dice) -> Description:
    """Cranks of one length about one axle that share a pin, whose place is among the coordinates."""
    sketch = Sketch(dice, "common_pin")
    sketch.mark("cranks on a common pin")
    angle, length = dice.angle(), dice.length()
    bar = sketch.parameter("l", length)
    x = sketch.coordinate("x", float(length) * math.cos(angle), "m")
    y = sketch.coordinate("y", float(length) * math.sin(angle), "m")
    names = [sketch.coordinate(f"a_{k}", angle) for k in range(1, dice.whole(2, 5))]
    rows = sketch.block("constraints").setdefault("geometric", {})
    for k, name in enumerate(names, 1):
        rows[sketch.name(f"p_{k}")] = f"{x} - {bar}*cos({name})"
        rows[sketch.name(f"r_{k}")] = f"{y} - {bar}*sin({name})"
    kinetic = [f"{dice.mass()}/2*({x}_dot**2 + {y}_dot**2)"]
    kinetic += [f"{dice.number(0.01, 0.2, 2)}/2*{name}_dot**2" for name in names if dice.chance(0.7)]
    sketch.blocks["kinetic_energy"] = Terms(tuple(kinetic))
    sketch.blocks["potential_energy"] = Terms((f"9.81*{y}",))
    _drives(sketch, names)
    return finish(sketch)


def double_four_bar(dice: Dice) -> Description:
    """Two or three four-bars on one crank, given by energies, with absolute or relative angles of the couplers."""
    sketch = Sketch(dice, "double_four_bar")
    sketch.inlined = dice.chance(0.4)
    crank = sketch.coordinate("a", dice.angle())
    r = sketch.parameter("r", dice.number(0.1, 0.3, 2))
    relative = dice.chance(0.5)
    sketch.mark("relative angles" if relative else "absolute angles")
    kinetic, potential, drives = [f"0.02/2*{crank}_dot**2"], [], [crank]
    for k in range(1, dice.whole(2, 3) + 1):
        b, c = sketch.coordinate(f"b_{k}", dice.angle()), sketch.coordinate(f"c_{k}", dice.angle())
        bar = sketch.parameter(f"l_{k}", dice.number(0.4, 1, 2))
        h = sketch.parameter(f"h_{k}", dice.number(0.3, 0.8, 2))
        th = sketch.definition(f"t_{k}", f"{crank} + {b}") if relative else b
        rate = f"({crank}_dot + {b}_dot)" if relative else f"{b}_dot"
        rocker = sketch.definition(f"w_{k}", f"{th} + {c}") if relative else c
        rocker_rate = f"({rate} + {c}_dot)" if relative else f"{c}_dot"
        sketch.mark("loop in the plane")
        sketch.row(f"x_{k}", f"{r}*cos({crank}) + {bar}*cos({th}) - {h}*cos({rocker})")
        sketch.row(f"y_{k}", f"{r}*sin({crank}) + {bar}*sin({th}) - {h}*sin({rocker})")
        mass = sketch.parameter(f"m_{k}", dice.mass())
        kinetic.append(f"{mass}/2*({r}**2*{crank}_dot**2 + {bar}**2/4*{rate}**2)")
        kinetic.append(f"{mass}/2*{r}*{bar}*cos({crank} - {th})*{crank}_dot*{rate}")
        kinetic.append(f"0.05/2*{rocker_rate}**2")
        potential.append(f"{mass}*9.81*({r}*sin({crank}) + {bar}/2*sin({th}))")
        drives.append(c)
    sketch.blocks["kinetic_energy"] = Terms(tuple(kinetic))
    sketch.blocks["potential_energy"] = Terms(tuple(potential))
    _drives(sketch, drives)
    return finish(sketch)


def _drives(sketch: Sketch, names: list[str]) -> None:
    """Drives at some of the coordinates: one or too many."""
    dice = sketch.dice
    chosen = dice.sample(names, dice.weighted({1: 4, 2: 2, 3: 2, 0: 0.3}))
    for k, name in enumerate(chosen, 1):
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"acts_on": {name: "1"}}


def parallelogram_bodies(dice: Dice) -> Description:
    """The same as bodies; or a row of four-bars with bars of equal length, one after the other."""
    sketch = Sketch(dice, "parallelogram_bodies")
    angle = dice.angle()
    bar, d = sketch.parameter("l", dice.length()), sketch.parameter("d", dice.length())
    m = sketch.parameter("m", dice.mass())
    sketch.blocks["gravity"] = ["0", "-9.81", "0"]
    in_a_row = dice.chance(0.4)
    count = dice.whole(2, 4)
    sketch.mark("parallelogram with several cranks")
    cranks = [_joint(sketch, f"crank_{k}", f"a_{k}", angle, at=[_times(k, d), "0", "0"]) for k in range(count + 1)]
    turned = list(sketch.start)
    for crank in cranks:
        sketch.block("bodies")[crank] = {"mass": m, "com": [f"{bar}/2", "0", "0"], "inertia": {"zz": "0.02"}}
    starts = range(count) if in_a_row else (0,)
    for k in starts:
        rod = _joint(sketch, f"bar_{k}", f"b_{k}", -angle, parent=cranks[k], at=[bar, "0", "0"])
        sketch.block("bodies")[rod] = {"mass": m, "com": [f"{d}/2", "0", "0"], "inertia": {"zz": "0.05"}}
        for other in (k + 1,) if in_a_row else range(1, count + 1):
            tip = sketch.name(f"tip_{k}_{other}")
            end = sketch.name(f"end_{k}_{other}")
            sketch.block("points")[tip] = {"frame": cranks[other], "at": [bar, "0", "0"]}
            sketch.block("points")[end] = {"frame": rod, "at": [_times(other - k, d), "0", "0"]}
            sketch.mark("loop in the plane")
            sketch.block("loops")[sketch.name(f"pin_{k}_{other}")] = {"type": "point", "between": [end, tip]}
    drives = dice.sample(turned, dice.whole(1, 3))
    for k, name in enumerate(drives, 1):
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"joint": name}
    return finish(sketch)


def _times(factor: int, length: str) -> str:
    return "0" if factor == 0 else length if factor == 1 else f"{factor}*{length}"


def _joint(sketch: Sketch, plain: str, coordinate: str, value: float, **entry: Any) -> str:
    """A revolute joint about z, or about `axis`; the name of its frame."""
    joint = sketch.name(plain)
    q = sketch.name(coordinate)
    sketch.start[q] = value
    sketch.block("joints")[joint] = {"type": "revolute", "axis": "z", **entry, "coordinate": q}
    return joint


def bennett(dice: Dice) -> Description:
    """Four revolute joints in space: opposite lengths and twists are equal, and a/sin(alpha) = b/sin(beta)."""
    sketch = Sketch(dice, "bennett")
    alpha, beta = dice.number(0.4, 1.4, 2), dice.number(1.6, 2.6, 2)
    length = dice.number(0.3, 0.8, 2)
    a = sketch.parameter("a", length)
    other = f"{a}*sin({beta})/sin({alpha})"
    if dice.chance(0.4):
        other = exact(sketch.measured(other))
    b = sketch.name("b")
    sketch.block("parameters")[b] = {"value": other}
    first = round(dice.uniform(0.5, 2.4), 2)
    # tan(t1/2) tan(t2/2) = sin((beta + alpha)/2)/sin((beta - alpha)/2)
    ratio = math.sin((float(beta) + float(alpha)) / 2) / math.sin((float(beta) - float(alpha)) / 2)
    second = 2 * math.atan(ratio / math.tan(first / 2))
    _ring(sketch, (a, b, a, b), (alpha, beta, alpha, beta), (first, second, -first, -second))
    return finish(sketch)


def bricard(dice: Dice) -> Description:
    """Six revolute joints with equal links and twists of plus and minus a quarter turn: threefold symmetric."""
    sketch = Sketch(dice, "bricard")
    a = sketch.parameter("a", dice.number(0.3, 0.8, 2))
    one = round(dice.uniform(0.3, 1.4), 2)
    # cos t1 + cos t2 + cos t1 cos t2 = 0
    two = -math.acos(-math.cos(one) / (1 + math.cos(one)))
    _ring(sketch, (a,) * 6, ("pi/2", "-pi/2") * 3, (one, two) * 3)
    return finish(sketch)


def _ring(sketch: Sketch, lengths: tuple[str, ...], twists: tuple[str, ...], angles: tuple[float, ...]) -> None:
    """A ring of links, each turned about z, then moved along x, then twisted about x; the last one is the ground."""
    dice = sketch.dice
    sketch.blocks["gravity"] = ["0", "0", "-9.81"]
    before = ""
    for k, angle in enumerate(angles[:-1], 1):
        entry: dict[str, Any] = {}
        if before:
            entry = {"parent": before, "at": [lengths[k - 2], "0", "0"], "rotation": [["x", twists[k - 2]]]}
        before = _joint(sketch, f"j_{k}", f"t_{k}", angle, **entry)
        com = [f"{lengths[k - 1]}/2", "0", "0"]
        inertia = {"xx": "0.004", "yy": "0.03", "zz": "0.032"}
        mass = sketch.parameter(f"m_{k}", dice.mass())
        sketch.block("bodies")[before] = {"mass": mass, "com": com, "inertia": inertia}
    end, dock = sketch.name("end"), sketch.name("dock")
    back = twists[-1][1:] if twists[-1].startswith("-") else f"-{twists[-1]}"
    sketch.blocks["frames"] = {
        end: {"parent": before, "translation": [lengths[-2], "0", "0"], "rotation": [["x", twists[-2]]]},
        dock: {"translation": [f"-{lengths[-1]}", "0", "0"], "rotation": [["x", back]]},
    }
    sketch.mark("loop in space")
    sketch.block("loops")[sketch.name("ring")] = {"type": "revolute", "between": [end, dock]}
    for k, name in enumerate(dice.sample(list(sketch.start), dice.weighted({1: 5, 2: 2})), 1):
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"joint": name}


def sarrus(dice: Dice) -> Description:
    """Two chains of three parallel hinges hold a platform that moves straight up."""
    sketch = Sketch(dice, "sarrus")
    bar, d = sketch.parameter("l", dice.length()), sketch.parameter("d", dice.length())
    lean = round(dice.uniform(0.3, 1.2), 2)
    sketch.blocks["gravity"] = ["0", "0", "-9.81"]
    sides = dice.choice((("x", "y"), ("x", "y", "x")))
    feet = {0: ["0", f"-{d}", "0"], 1: [f"-{d}", "0", "0"], 2: ["0", d, "0"]}
    platform = ""
    for k, axis in enumerate(sides):
        foot = _joint(sketch, f"foot_{k}", f"p_{k}", lean, axis=axis, at=feet[k])
        knee = _joint(sketch, f"knee_{k}", f"k_{k}", -2 * lean, axis=axis, parent=foot, at=["0", "0", bar])
        for frame in (foot, knee):
            mass = sketch.parameter("m", dice.mass())
            inertia = {"xx": "0.02", "yy": "0.02", "zz": "0.003"}
            sketch.block("bodies")[frame] = {"mass": mass, "com": ["0", "0", f"{bar}/2"], "inertia": inertia}
        if not platform:
            platform = _joint(sketch, "platform", "e", lean, axis=axis, parent=knee, at=["0", "0", bar])
            inertia = {"xx": "0.2", "yy": "0.2", "zz": "0.3"}
            sketch.block("bodies")[platform] = {"mass": "3", "com": ["0", d, "0"], "inertia": inertia}
            continue
        end, dock = sketch.name(f"end_{k}"), sketch.name(f"dock_{k}")
        sketch.block("frames")[end] = {"parent": knee, "translation": ["0", "0", bar]}
        place = {1: [f"-{d}", d, "0"], 2: ["0", f"2*{d}", "0"]}[k]
        sketch.block("frames")[dock] = {"parent": platform, "translation": place}
        sketch.mark("loop in space")
        sketch.block("loops")[sketch.name(f"hinge_{k}")] = {"type": "revolute", "between": [end, dock], "axis": axis}
    for k, name in enumerate(dice.sample(list(sketch.start), dice.weighted({1: 5, 2: 2, 3: 1})), 1):
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"joint": name}
    return finish(sketch)


def legged_platform(dice: Dice) -> Description:
    """A planar platform on two to four legs with two links each, as bodies."""
    sketch = Sketch(dice, "legged_platform")
    sketch.mark("platform on legs")
    sketch.blocks["gravity"] = ["0", "-9.81", "0"] if dice.chance(0.6) else ["0", "0", "-9.81"]
    x, y, phi = (sketch.name(name) for name in ("x", "y", "phi"))
    sketch.start |= {x: 0.1, y: 0.2, phi: round(dice.uniform(-0.5, 0.5), 2)}
    platform = sketch.name("platform")
    sketch.block("joints")[platform] = {"type": "planar", "coordinates": [x, y, phi]}
    sketch.block("bodies")[platform] = {"mass": sketch.parameter("m", dice.mass()), "inertia": {"zz": "0.1"}}
    legs = dice.whole(2, 4)
    proximal = []
    for k in range(legs):
        turn = 2 * math.pi * k / legs + dice.uniform(-0.3, 0.3)
        corner = sketch.name(f"corner_{k}")
        at = [decimal(0.25 * math.cos(turn), 3), decimal(0.25 * math.sin(turn), 3), "0"]
        sketch.block("points")[corner] = {"frame": platform, "at": at}
        place = sketch.place(corner)
        upper, lower = dice.angle(), dice.angle()
        p, r = sketch.parameter(f"p_{k}", dice.length()), sketch.parameter(f"r_{k}", dice.length())
        reach = [sketch.measured(f"{p}*{wave}({upper}) + {r}*{wave}({upper} + {lower})") for wave in ("cos", "sin")]
        foot = [exact(place[0] - reach[0]), exact(place[1] - reach[1]), "0"]
        arm = _joint(sketch, f"arm_{k}", f"a_{k}", upper, at=foot)
        rod = _joint(sketch, f"rod_{k}", f"b_{k}", lower, parent=arm, at=[p, "0", "0"])
        proximal.append(sketch.block("joints")[arm]["coordinate"])
        sketch.block("bodies")[arm] = {"mass": dice.mass(), "com": [f"{p}/2", "0", "0"], "inertia": {"zz": "0.02"}}
        if dice.chance(0.7):
            sketch.block("bodies")[rod] = {"mass": dice.mass(), "com": [f"{r}/2", "0", "0"], "inertia": {"zz": "0.02"}}
        tip = sketch.name(f"tip_{k}")
        sketch.block("points")[tip] = {"frame": rod, "at": [r, "0", "0"]}
        between = dice.shuffled([tip, corner])
        sketch.mark("loop in the plane")
        sketch.block("loops")[sketch.name(f"leg_{k}")] = {"type": "point", "between": between}
    for k, name in enumerate(dice.sample(proximal, dice.whole(1, legs)), 1):
        sketch.block("inputs")[sketch.name(f"u_{k}")] = {"joint": name}
    return finish(sketch)
