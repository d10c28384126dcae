"""What the gallery has on the site beside drawings: the report with the equations of each machine, and its motion.

Motions are no simulations: rates that swing are projected onto those that the constraints allow, and places back onto
the constraints.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from symgen.drawing.pose import MachinePose
from symgen.drawing.scene import scene
from symgen.generation.results import Options
from symgen.mechanics.genericity import assembly_of
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.pipeline import generate
from symgen.simulate.animation import animation

PAGE, FOLDER = "docs/gallery.md", "docs/gallery"
# Where the page names the file of a model.
NAMED = re.compile(r"^\[models/(\w+)\.yaml\]\(\.\./models/\w+\.yaml\)$", re.M)
# Seconds of a motion, and frames in it.
PERIOD, MOMENTS = 6.0, 150
# The fastest swing of an angle (rad/s), and of a length as a share of the machine's size a second.
TURNING, MOVING = 0.5, 0.12
# Newton's steps back onto the constraints, and relative singular values below which a direction is none.
STEPS, NEGLIGIBLE = 4, 1e-9

Array = npt.NDArray[np.float64]


def add_extras(pages: Path, models: Path) -> None:
    """Writes them beside the gathered page of the gallery, and links there."""
    page = pages / PAGE
    if not page.is_file():
        return
    text = page.read_text(encoding="utf-8")
    for name in NAMED.findall(text):
        links = dict(_extras(models / f"{name}.yaml"))
        for title, content in links.items():
            (pages / FOLDER / f"{name}.{title}.html").write_text(content, encoding="utf-8")
        said = "".join(f" · [{title}](gallery/{name}.{title}.html)" for title in links)
        named = f"[models/{name}.yaml](../models/{name}.yaml)"
        text = text.replace(f"{named}\n", f"{named}{said}\n")
    page.write_text(text, encoding="utf-8")


def _extras(path: Path) -> Iterator[tuple[str, str]]:
    files = generate(path, Options(parts=("report",), verify=False), lambda _: None).files
    yield "equations", str(files[f"report/{path.stem}.html"])
    page = moving(load_model(path))
    if page is not None:
        yield "motion", page


def moving(model: Model) -> str | None:
    """A page that plays a motion of the machine; None without frames."""
    if not model.pictured.frames:
        return None
    pose = MachinePose(model)
    shown = scene(model, pose.parameters, [tuple(q) for q in swinging(model, pose.size)])
    assert shown is not None
    times = tuple(PERIOD * k / MOMENTS for k in range(MOMENTS + 1))
    return animation(model.description or model.name, times, shown)


def swinging(model: Model, size: float) -> list[list[float]]:
    """Configurations on the constraints, a moment each: each coordinate swings at one of two frequencies."""
    numeric = NumericSystem.of(model)
    q = np.array(assembly_of(model).places[0].q, dtype=np.float64)
    fastest = np.array([TURNING if coordinate.is_angle else MOVING * size for coordinate in model.coordinates])
    swings = 2 * math.pi / PERIOD * (1 + np.arange(model.n) % 2)
    motion, step = [q.tolist()], PERIOD / MOMENTS
    for k in range(MOMENTS):
        wanted = fastest * np.sin(swings * (k + 0.5) * step)
        q = _closed(numeric, q + step * _admissible(numeric, q, wanted))
        motion.append(q.tolist())
    return motion


def _admissible(numeric: NumericSystem, q: Array, rates: Array) -> Array:
    """The rates nearest to these that the constraints allow."""
    rows = np.array(numeric.jacobian(list(q)), dtype=np.float64).reshape(-1, len(q))
    return rates - np.linalg.pinv(rows, rcond=NEGLIGIBLE) @ (rows @ rates) if len(rows) else rates


def _closed(numeric: NumericSystem, q: Array) -> Array:
    """The configuration on the geometric constraints, by Newton steps of least length."""
    count = len(numeric.geometric)
    for _ in range(STEPS if count else 0):
        values, sparse = numeric.residuals(list(q), range(count))
        q = q - np.linalg.pinv(_dense(sparse, len(q)), rcond=NEGLIGIBLE) @ np.array(values)
    return q


def _dense(rows: Sequence[dict[int, float]], n: int) -> Array:
    return np.array([[row.get(j, 0.0) for j in range(n)] for row in rows])
