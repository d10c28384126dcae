"""On the site the gallery has equations and a motion of each machine: the motion keeps to the constraints."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import pytest
from gallery_extras import FOLDER, NAMED, PAGE, PERIOD, TURNING, add_extras, moving, swinging

from symgen.drawing.pose import MachinePose
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.load import load_model, load_text

ROOT = Path(__file__).parent.parent
MODELS = ROOT / "models"


@pytest.mark.parametrize("name", ["five_bar", "rolling_disc"])
def test_a_motion_keeps_to_the_constraints(name: str) -> None:
    model = load_model(MODELS / f"{name}.yaml")
    motion = swinging(model, MachinePose(model).size)
    numeric = NumericSystem.of(model)
    for q in motion:
        values, _ = numeric.residuals(q, range(len(numeric.geometric)))
        assert max(map(abs, values)) < 1e-9
    step = PERIOD / (len(motion) - 1)
    for before, after in pairwise(motion):
        middle = [(a + b) / 2 for a, b in zip(before, after, strict=True)]
        rates = [(b - a) / step for a, b in zip(before, after, strict=True)]
        slips = [abs(sum(a * b for a, b in zip(row, rates, strict=True))) for row in numeric.jacobian(middle)]
        assert max(slips) < 0.02 * TURNING
    # it goes somewhere, and comes back
    far = max(math.dist(q, motion[0]) for q in motion)
    assert far > 0.2
    assert math.dist(motion[-1], motion[0]) < 0.1 * far


def test_models_without_frames_do_not_move() -> None:
    text = (MODELS / "skate.yaml").read_text(encoding="utf-8")
    assert moving(load_text(text[: text.index("\npicture:")], "skate.yaml")) is None


def test_every_machine_of_the_page_has_its_file_named() -> None:
    assert sorted(NAMED.findall((ROOT / PAGE).read_text(encoding="utf-8"))) == sorted(
        path.stem for path in MODELS.glob("*.yaml")
    )


@pytest.mark.slow
def test_links_lead_to_equations_and_motions(tmp_path: Path) -> None:
    (tmp_path / FOLDER).mkdir(parents=True)
    page = tmp_path / PAGE
    lines = [f"[models/{name}.yaml](../models/{name}.yaml)\n" for name in ("skate", "scara")]
    page.write_text("\n".join(lines), encoding="utf-8")
    add_extras(tmp_path, MODELS)
    skate, scara = page.read_text(encoding="utf-8").split("\n\n")
    named = "[models/skate.yaml](../models/skate.yaml)"
    assert skate == f"{named} · [equations](gallery/skate.equations.html) · [motion](gallery/skate.motion.html)"
    assert scara.rstrip().endswith("(gallery/scara.equations.html) · [motion](gallery/scara.motion.html)")
    assert "Singular configurations" in (tmp_path / FOLDER / "skate.equations.html").read_text(encoding="utf-8")
    assert '"spindle"' in (tmp_path / FOLDER / "scara.motion.html").read_text(encoding="utf-8")
