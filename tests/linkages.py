"""Planar linkages with several branches of configurations, or with surplus rows, as model files."""

from __future__ import annotations


def on_two_bases(four_bar: str) -> str:
    """The tilted four-bar with its rocker on a base of its own, tilted as the other one: both sides of its loop meet at
    the world, and of the three rows in the axes of that two are independent."""
    base, rocker = "base: {rotation: [[x, 0.5], [y, 0.3]]}", "rocker:  {type: revolute, parent: base,"
    loop, axis = "{type: revolute, between: [end_of_coupler, end_of_rocker]", ", axis: z}"
    changes = {
        base: f"{base}\n  beside: {base[6:]}",
        rocker: rocker.replace("base", "beside"),
        loop + axis: loop.replace("revolute", "spherical") + "}",
    }
    for part, other in changes.items():
        assert part in four_bar
        four_bar = four_bar.replace(part, other)
    return four_bar


def row_of_four_bars(
    count: int, crank: str = "0.4", ground: str = "0.4", scales: tuple[str, str] = ("1", "1"), tail: str = ""
) -> str:
    """Cranks a0, a1, ... on a line, joined by couplers b1, b2, ...; the first is driven.  Bars are uniform."""
    angles = [f"a{k}" for k in range(count + 1)] + [f"b{k}" for k in range(1, count + 1)]
    energy = [f"m*l**2/6*a{k}_dot**2" for k in range(count + 1)]
    height = [f"l/2*sin(a{k})" for k in range(count + 1)]
    rows = []
    for k in range(1, count + 1):
        before, coupler, after = f"a{k - 1}", f"b{k}", f"a{k}"
        energy.append(
            f"m/2*(l**2*{before}_dot**2 + w**2/3*{coupler}_dot**2"
            f" + l*w*cos({before} - {coupler})*{before}_dot*{coupler}_dot)"
        )
        height.append(f"l*sin({before}) + w/2*sin({coupler})")
        rows.append(f"    x{k}: {scales[0]}*(l*cos({before}) + w*cos({coupler}) - w - l*cos({after}))")
        rows.append(f"    y{k}: {scales[1]}*(l*sin({before}) + w*sin({coupler}) - l*sin({after}))")
    return "\n".join(
        [
            "model: row_of_four_bars",
            "coordinates:",
            *(f"  {name}: {{unit: rad}}" for name in angles),
            f"parameters: {{l: {crank}, w: {ground}, m: 0.9, g: 9.81}}",
            "kinetic_energy: " + " + ".join(energy),
            "potential_energy: m*g*(" + " + ".join(height) + ")",
            "constraints:",
            "  geometric:",
            *rows,
            "inputs: {u: {acts_on: {a0: 1}}}",
            "outputs: [inverse_dynamics, forward_dynamics]",
            tail,
        ]
    )


def cranks_on_one_coupler(count: int, tail: str = "") -> str:
    """Equal parallel cranks a0, a1, ... under one coupler at the angle b: rows depend on each other while b = 0."""
    cranks = [f"a{k}" for k in range(count)]
    rows = []
    for k in range(1, count):
        rows.append(f"    x{k}: l*cos(a0) + {k}*w*cos(b) - {k}*w - l*cos(a{k})")
        rows.append(f"    y{k}: l*sin(a0) + {k}*w*sin(b) - l*sin(a{k})")
    return "\n".join(
        [
            "model: cranks_on_one_coupler",
            "coordinates:",
            *(f"  {name}: {{unit: rad}}" for name in (*cranks, "b")),
            "parameters: {l: 0.5, w: 0.6, m: 2, g: 9.81}",
            "kinetic_energy: m*l**2/2*a0_dot**2 + m*w**2/6*b_dot**2 + "
            + " + ".join(f"m*l**2/6*{name}_dot**2" for name in cranks),
            "potential_energy: m*g*l*sin(a0)",
            "constraints:",
            "  geometric:",
            *rows,
            "inputs: {u: {acts_on: {a1: 1}}}",
            "outputs: [inverse_dynamics, forward_dynamics]",
            tail,
        ]
    )


# A pendulum on a cart, in energy form.
CART = """
model: cart
coordinates: {x: {unit: m}, a: {unit: rad, description: from upright}}
parameters: {M: {value: 2}, m: {value: 0.5}, l: {value: 0.7}, g: {value: 9.81}}
kinetic_energy: (M + m)*x_dot**2/2 + m*l*cos(a)*x_dot*a_dot + m*l**2*a_dot**2/2
potential_energy: m*g*l*cos(a)
inputs: {push: {unit: N, acts_on: {x: 1}}}
"""
