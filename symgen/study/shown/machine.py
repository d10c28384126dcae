"""The machine in a map of its workspace, where it stays in the plane of the map."""

from __future__ import annotations

import math
from typing import Any

from symgen.drawing.pose import NEXT_TO_NOTHING, MachinePose
from symgen.drawing.sketch import MachineSketch, sketch_in
from symgen.drawing.view import views_along_axes
from symgen.mechanics.genericity import assembly_of, parameter_values
from symgen.mechanics.system import System
from symgen.model.model import Model
from symgen.study.asked.request import GRID
from symgen.study.plan import StudyPlan
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.translate import translate

# Points of a picture: the width of a bar, and the diameter of a joint.
MAP_BAR, MAP_JOINT = 2.0, 3.5
# Points: what a border adds to a bar.
MAP_BORDER = 1.4
INK = "#2b2f36"


def machine_in_map(plan: StudyPlan) -> MachineSketch | None:
    """The machine at its start; None where the map is no picture of its plane.

    It is one where the two coordinates of the task that are varied are those of a place of the machine.
    """
    model = plan.model
    varied = [one for one in plan.over if one.kind == "task"]
    if plan.request.sample != GRID or len(varied) != 2 or len(plan.over) != 2 or not model.pictured.frames:
        return None
    if not assembly_of(model).places:
        return None
    try:
        pose = MachinePose(model)
        views = views_along_axes(pose)
        task = task_at_start(model)
    except (ArithmeticError, ValueError):  # a slide at 0 may have no place
        return None
    here = [task[one.place] for one in varied]
    for view in views:
        if any(math.dist(here, view.flat(place)) < NEXT_TO_NOTHING * pose.size for place in pose.places.values()):
            return sketch_in(pose, view)
    return None


def task_at_start(model: Model) -> list[float]:
    """The coordinates of the task where the model's start leads."""
    system = System(model)
    names = [c.name for c in model.coordinates]
    values = parameter_values(system) | dict(zip(names, map(float, assembly_of(model).places[0].q), strict=True))
    return Evaluator([translate(system.graph, one.expression, system.names) for one in model.task])(values)


def draw_machine(panel: Any, machine: MachineSketch) -> None:
    """Bars and joints over a map, whose limits stay."""
    limits = panel.get_xlim(), panel.get_ylim()
    for stroke in machine.strokes:
        if stroke.role in ("link", "tie"):
            places = (*stroke.places, stroke.places[0]) if stroke.closed else stroke.places
            # a light border shows it on dark maps
            for colour, width in (("white", MAP_BAR + MAP_BORDER), (INK, MAP_BAR)):
                panel.plot(*zip(*places, strict=True), color=colour, linewidth=width, solid_capstyle="round")
    for symbol in machine.symbols:
        if symbol.mark != "ground":
            panel.plot(*symbol.place, "o", color="white", markeredgecolor=INK, markersize=MAP_JOINT)
    panel.set_xlim(limits[0])
    panel.set_ylim(limits[1])
