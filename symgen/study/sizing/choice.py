"""Which motors of a catalogue can be the drives of a study, at all of its points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from symgen.records import dataclass
from symgen.study.asked.request import DRIVE_SPEED, MOTOR_TORQUE
from symgen.study.plan import StudyPlan
from symgen.study.reductions import LARGEST_OF, RMS_OF
from symgen.study.shown.summary import TableRows
from symgen.study.sizing.catalogue import Motor
from symgen.study.sizing.drives import MotorDrive


@dataclass(frozen=True, slots=True)
class MotorFit:
    """A motor at a drive: the largest shares of its peak torque, rated torque (root of the mean square along a motion)
    and speed that a point of the study takes."""

    drive: MotorDrive
    motor: Motor
    peak: float
    rated: float
    speed: float

    @property
    def worst(self) -> float:
        """The largest of the shares: at most 1 where the motor can be the drive."""
        return max(self.peak, self.rated, self.speed)

    @property
    def limit(self) -> str:
        """What it needs most of."""
        return max(("peak torque", self.peak), ("rated torque", self.rated), ("speed", self.speed), key=_share)[0]


def _share(named: tuple[str, float]) -> float:
    return named[1]


def motor_fits(plan: StudyPlan, results: Any) -> tuple[tuple[MotorFit, ...], ...]:
    """For each drive all motors in the order of the catalogue; `results` is an xarray Dataset."""
    motors = plan.request.motors
    if not motors:
        return ()

    def worst(name: str) -> Sequence[float]:
        values = results[name]
        return [float(one) for one in values.max([d for d in values.dims if d in plan.dimensions]).values]

    peaks, means = (worst(f"{MOTOR_TORQUE}_{figure}") for figure in (LARGEST_OF, RMS_OF))
    speeds = worst(f"{DRIVE_SPEED}_{LARGEST_OF}")
    return tuple(
        tuple(
            MotorFit(
                drive,
                motor,
                peaks[k * len(motors) + j] / motor.peak_torque,
                means[k * len(motors) + j] / motor.rated_torque,
                speeds[k] * motor.ratio / motor.speed,
            )
            for j, motor in enumerate(motors)
        )
        for k, drive in enumerate(plan.drives)
    )


def fitting(fits: Sequence[MotorFit]) -> list[MotorFit]:
    """Of the motors at one drive those that can be it."""
    return [one for one in fits if one.worst <= 1]


def sizing_tables(plan: StudyPlan, fits: Sequence[Sequence[MotorFit]]) -> tuple[TableRows, ...]:
    """All motors at all drives, and what to tell the model of the first ones that fit."""
    columns = ("drive", "motor", "peak torque", "rated torque", "speed", "")
    rows = [_row(one) for of_drive in fits for one in of_drive]
    chosen = [fitting(of_drive)[0] for of_drive in fits if fitting(of_drive)]
    names = [c.name for c in plan.model.coordinates]
    inertias = [(names[one.drive.coordinate], one.motor.name, f"{_reflected(one):.6g}") for one in chosen]
    return (
        ("motors at the drives", columns, rows),
        ("rotor_inertias of the first that fit", ("coordinate", "motor", "inertia"), inertias),
    )


def sizing_lines(fits: Sequence[Sequence[MotorFit]]) -> Iterator[str]:
    """For each drive the motors that fit, or the one that comes closest."""
    if fits:
        yield "  motors that fit"
    for of_drive in fits:
        best = fitting(of_drive)
        for one in best:
            shares = f"peak {one.peak:.0%}, rated {one.rated:.0%}, speed {one.speed:.0%}"
            yield f"    {one.drive.name}  {one.motor.name}  {shares}"
        if not best:
            nearest = min(of_drive, key=lambda one: one.worst)
            needs = f"{nearest.motor.name} needs {nearest.worst:.0%} of its {nearest.limit}"
            yield f"    {nearest.drive.name}  none: {needs}"


def _row(one: MotorFit) -> tuple[str, ...]:
    shares = (f"{share:.1%}" for share in (one.peak, one.rated, one.speed))
    return (one.drive.name, one.motor.name, *shares, "fits" if one.worst <= 1 else f"too little {one.limit}")


def _reflected(one: MotorFit) -> float:
    """The inertia at the coordinate: T = J/2 (n share q')^2."""
    return one.motor.inertia * (one.motor.ratio * one.drive.share) ** 2
