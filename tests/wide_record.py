"""A model whose record names kernels with twice the digits, as a verification would leave it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from symgen.cli.main import main
from symgen.output.write import write_files

# A swing hangs from a runner on a sloping rail: one row, two degrees of freedom, quotients and sines, a spring by
# a table of numbers.
SWING = """
model: swing_on_runner
coordinates:
  s: {unit: m, description: way of the runner along the rail, range: [-1, 1]}
  a: {unit: rad, description: angle of the swing, range: [-1, 1]}
  y: {unit: m, description: height of the seat below the runner, range: [-2, 2]}
parameters:
  l: {value: 0.9, unit: m, range: [0.5, 1.5]}
  b: {value: 0.3, unit: rad}
  m: {value: 4, unit: kg, range: [2, 8]}
  M: {value: 7, unit: kg, range: [3, 12]}
  k: {value: 60, unit: N/m}
  g: {value: 9.81, unit: m/s**2}
kinetic_energy: (M + m)/2*s_dot**2 + m/2*l**2*a_dot**2 + m*l*s_dot*a_dot*cos(a + b)
potential_energy: >-
  k/2*s**2 - (M + m)*g*s*sin(b) - m*g*y
  + 3.1*s**3 + 5.3*s**4 + 2.7*s**5 + 1.9*s**6 + 0.7*s**7 + 0.37*s**8 + 4.3*a**2 + 1.3*a**3 + 2.3*a**4 + 0.9*a**5
constraints:
  geometric: {seat: y - l*cos(a)}
inputs:
  pull: {unit: N, description: force along the rail, acts_on: {s: 1}}
  twist: {unit: N*m, description: torque at the runner, acts_on: {a: 1}}
configuration: {s: 0.1, a: 0.4, y: 0.83}
outputs: [inverse_dynamics, forward_dynamics, singularity]
"""
NAME = "swing_on_runner"


def recorded(
    folder: Path, wide: Mapping[str, Sequence[str]], left_out: Mapping[str, Sequence[str]] | None = None
) -> tuple[Path, Path]:
    """The model's file, and the folder with a record by which quantities work with twice the digits in some types."""
    path, out = folder / f"{NAME}.yaml", folder / "out"
    path.write_text(SWING, encoding="utf-8")
    assert main([str(path), "--only", "c", "--no-verify", "--quiet", "--out", str(out)]) == 0
    file = out / NAME / "derivation.json"
    content: dict[str, Any] = json.loads(file.read_bytes())
    left_out = left_out or {}
    content["rejected"] = [{"quantity": q, "method": "minor", "why": "of a test"} for q in (*wide, *left_out)]
    for quantity, types in wide.items():
        content["kernels"][quantity]["twice_the_digits"] = list(types)
    content["left_out"] = [{"quantity": q, "scalars": list(types)} for q, types in left_out.items()]
    write_files(out / NAME, {"derivation.json": json.dumps(content)})
    return path, out
