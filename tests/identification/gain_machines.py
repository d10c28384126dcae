"""Machines whose logs have motor currents, by gains that are not those of the file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from identified_machines import MACHINES_WITH_LOGS, ROOT, IdentifiedMachine
from simulated_logs import Motion, Sensors, SimulatedLog, simulated_log

ARM, RAPKM = MACHINES_WITH_LOGS["arm"], MACHINES_WITH_LOGS["rapkm"]


def _replaced(text: str, *changes: tuple[str, str]) -> str:
    for before, after in changes:
        assert text.count(before) == 1, before
        text = text.replace(before, after)
    return text


# The arm with friction and a spring, by currents.
ARM_BY_CURRENTS = _replaced(
    ARM.text,
    ("gravity:", "  k_1: {value: 0.9, unit: N*m/A}\n  k_2: {value: 0.35, unit: N*m/A}\ngravity:"),
    ("u_a: {joint: a, unit: N*m}", "u_a: {acts_on: {a: k_1}, unit: A}"),
    ("u_b: {joint: b, unit: N*m}", "u_b: {acts_on: {b: k_2}, unit: A}"),
)
# Its lower link is a payload that was weighed.
ARM_WITH_PAYLOAD = _replaced(
    ARM_BY_CURRENTS,
    ("{mass: m_2, com: [c_2, 0, 0], inertia: {zz: J_2}}", "{mass: 0.8, com: [0.17, 0, 0], inertia: {zz: 0.009}}"),
    ("  m_2: {value: 1.0, unit: kg}\n  c_2: {value: 0.15, unit: m}\n  J_2: {value: 0.012, unit: kg*m**2}\n", ""),
)
# The RA-PKM by the currents of its three drives.
RAPKM_BY_CURRENTS = _replaced(
    RAPKM.text,
    ("gravity:", "".join(f"  k_{k}: {{value: 0.12, unit: N*m/A}}\n" for k in (1, 2, 3)) + "gravity:"),
    *(
        (f"drive_{k}: {{unit: N*m, description: torque of the drive at base joint {k}, joint: a_{k}}}",
         f"drive_{k}: {{unit: A, acts_on: {{a_{k}: k_{k}}}}}")
        for k in (1, 2, 3)
    ),
)  # fmt: skip

# Two slides that do not feel each other, in a plane that is level: masses and gains show as quotients alone.
TWO_SLIDES = """
model: two_slides
parameters:
  m_x: {value: 3.0, unit: kg}
  m_y: {value: 2.0, unit: kg}
  d_x: {value: 4.0, unit: N*s/m}
  k_x: {value: 20.0, unit: N/A}
  k_y: {value: 10.0, unit: N/A}
joints:
  across: {type: prismatic, axis: x, coordinate: x}
  along: {type: prismatic, axis: y, coordinate: y}
bodies:
  across: {mass: m_x}
  along: {mass: m_y}
friction:
  x: {viscous: d_x}
inputs:
  i_x: {acts_on: {x: k_x}, unit: A}
  i_y: {acts_on: {y: k_y}, unit: A}
"""

_SEVEN_JOINTS = (ROOT / "models" / "arm7.yaml").read_text(encoding="utf-8")
_SEVEN_DRIVES = "".join(f"  u_{k}: {{acts_on: {{q_{k}: k_{k}}}, unit: A}}\n" for k in range(1, 8))
_SEVEN_GAINS = "".join(f"  k_{k}: {{value: 0.5, unit: N*m/A}}\n" for k in range(1, 8))
_ANGLES = tuple(f"q_{k}" for k in range(1, 8))
# The arm with seven joints by currents.
ARM7_BY_CURRENTS = _replaced(
    _SEVEN_JOINTS[: _SEVEN_JOINTS.index("inputs:")] + _SEVEN_JOINTS[_SEVEN_JOINTS.index("configuration:") :],
    ("parameters:\n", f"parameters:\n{_SEVEN_GAINS}"),
    ("configuration:", f"inputs:\n{_SEVEN_DRIVES}configuration:"),
)


@dataclass(frozen=True)
class MachineByCurrents(IdentifiedMachine):
    """One with the true gains of its inputs over those of the file, without gains under `identify`."""

    factors: Mapping[str, float]

    def asked(self, *gains: str) -> str:
        return f"{self.text}identify: {{gains: [{', '.join(gains)}]}}\n"


_OF_UPPER_ARM = {name: value for name, value in ARM.truth.items() if name not in ("m_2", "c_2", "J_2")}
MACHINES_BY_CURRENTS = {
    "arm": MachineByCurrents(ARM_BY_CURRENTS, ARM.motion, ARM.measured, ARM.truth, {"u_b": 1.25}),
    "payload": MachineByCurrents(
        ARM_WITH_PAYLOAD, ARM.motion, ARM.measured, _OF_UPPER_ARM, {"u_a": 0.8, "u_b": 1.25}
    ),
    "rapkm": MachineByCurrents(
        RAPKM_BY_CURRENTS, RAPKM.motion, RAPKM.measured, RAPKM.truth, {"drive_2": 0.75, "drive_3": 1.2}
    ),
    "arm7": MachineByCurrents(
        ARM7_BY_CURRENTS, Motion(dict.fromkeys(_ANGLES, (0.2, 1.6))), _ANGLES, {},
        {f"u_{k}": 1 + 0.1 * (k - 4) for k in range(2, 8)},
    ),
    "slides": MachineByCurrents(
        TWO_SLIDES, Motion({"x": (0.0, 0.3), "y": (0.0, 0.3)}), ("x", "y"), {"m_x": 3.5, "d_x": 3.0}, {"i_y": 1.3}
    ),
}  # fmt: skip


def log_of_currents(machine: MachineByCurrents, sensors: Sensors, seed: int = 0, seconds: float = 10.0) -> SimulatedLog:
    """A log whose currents are those of the gains of the file, divided by how much larger the true gains are."""
    log = simulated_log(machine.text, machine.motion, machine.measured, machine.truth, sensors, seed, seconds)
    return log.divided(machine.factors)
