"""Planar chains of N equal links with a pinned tip and motors in all joints but the last, for any N."""

from __future__ import annotations


def chain(links: int) -> str:
    """The model as text; the tip is pinned where links that point in all directions of a quadrant can reach."""
    names = range(1, links + 1)
    lines = [f"model: chain{links}", "coordinates:"]
    lines += [f"  a_{i}: {{unit: rad, range: [-1.5, 1.5]}}" for i in names]
    lines += [
        "parameters:",
        "  l: {value: 0.4, unit: m, range: [0.3, 0.5]}",
        "  c: {value: 0.18, unit: m, range: [0.1, 0.25]}",
        "  m: {value: 1.5, unit: kg, range: [0.5, 3]}",
        "  J: {value: 0.02, unit: kg*m**2, range: [0.005, 0.05]}",
        "  g: {value: 9.81, unit: m/s**2}",
        f"  x_t: {{value: {links / 4}*l, unit: m}}",
        f"  y_t: {{value: {links / 4}*l, unit: m}}",
        "gravity: [0, -g, 0]",
        "frames:",
        "  link_1: {rotation: [[z, a_1]]}",
    ]
    for i in names[1:]:
        lines.append(f"  link_{i}: {{parent: link_{i - 1}, translation: [l, 0, 0], rotation: [[z, a_{i}]]}}")
    lines.append("bodies:")
    lines += [f"  link_{i}: {{mass: m, com: [c, 0, 0], inertia: {{zz: J}}}}" for i in names]
    lines += ["points:", f"  tip: {{frame: link_{links}, at: [l, 0, 0]}}", "constraints:", "  geometric:"]
    lines += ["    pin_x: tip.x - x_t", "    pin_y: tip.y - y_t", "inputs:"]
    lines += [f"  u_{i}: {{unit: N*m, joint: a_{i}}}" for i in names[:-1]]
    return "\n".join([*lines, "outputs: [inverse_dynamics, forward_dynamics, multipliers, singularity]", ""])
