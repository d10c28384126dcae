"""Model files of random systems: non-holonomic rows and inputs with random rational and trigonometric entries."""

from __future__ import annotations

import random
from itertools import pairwise

# n coordinates, r rows, m inputs: delta = n - r is at most m
SIZES = ((4, 1, 3), (4, 2, 2), (5, 2, 4), (5, 3, 2), (5, 3, 4))


def random_system(seed: int) -> str:
    """The text of one system; the same seed gives the same text."""
    source = random.Random(f"forms {seed}")
    n, r, m = SIZES[seed % len(SIZES)]
    names = [f"q_{i}" for i in range(n)]

    def number() -> str:
        return f"{source.choice((-1, 1)) * source.randint(2, 19) / 8}"

    def entry() -> str:
        angle = source.choice(names)
        return source.choice((number(), f"{number()}*{source.choice(('sin', 'cos'))}({angle})"))

    lines = [f"model: random_{seed}", "coordinates:"]
    lines += [f"  {name}: {{unit: rad}}" for name in names]
    lines += ["parameters:", "  mass: {value: 1.5, unit: kg*m**2, range: [1, 2]}"]
    lines += ["  spring: {value: 1.5, unit: N*m, range: [1, 2]}"]
    energy = [f"mass*{i + 2}*{name}_dot**2" for i, name in enumerate(names)]
    energy += [f"mass*cos({a} - {b})*{a}_dot*{b}_dot" for a, b in pairwise(names)]
    lines += [f"kinetic_energy: {' + '.join(energy)}", f"potential_energy: spring*sin({names[0]})"]
    lines += ["constraints:", "  nonholonomic:"]
    for k in range(r):
        lines.append(f"    row_{k}: " + " + ".join(f"({entry()})*{name}_dot" for name in names))
    lines.append("inputs:")
    for k in range(m):
        acts = ", ".join(f"{name}: {entry()}" for name in source.sample(names, 3))
        lines.append(f"  u_{k}: {{acts_on: {{{acts}}}}}")
    lines.append("outputs: [inverse_dynamics]")
    return "\n".join(lines) + "\n"
