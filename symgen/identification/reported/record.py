"""An identification as JSON: all settings, estimates and what they were held against."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from pathlib import PurePath
from typing import Any

import numpy as np

from symgen.identification.estimates.identification import Identification
from symgen.identification.estimates.whole_bodies import WholeBodies
from symgen.identification.reported.notes import notes

# Digits of numbers in the record: more depend on the processor.
RECORDED_DIGITS = 8


def identification_json(made: Identification) -> str:
    """The record, the same for the same files."""
    record = {
        "model": made.model.name,
        "model_sha256": made.model.text_hash,
        "log": PurePath(made.log.file).name,
        "samples": len(made.log.t),
        "measured": list(made.log.measured),
        "filter": asdict(made.settings),
        "equations": {
            "fitted": made.fitted_to.inputs.size,
            "set_aside": made.aside.inputs.size,
            "parameters": len(made.estimate.values),
        },
        "measured_off_constraints": made.open_by,
        "condition": made.estimate.condition,
        "outliers": made.estimate.outliers,
        "unexplained": made.left_over,
        "parameters": [
            {"name": one.name.replace("\u00a0", " "), "value": one.value, "standard_error": one.error,
             "t_ratio": one.ratio, "before": one.before, "verdict": one.verdict}
            for one in made.parameters
        ],
        "covariance": made.estimate.covariance.tolist(),
        "inputs": [asdict(one) for one in made.drives],
        "file": [
            {"name": name, "value": value, "standard_error": error, "before": before}
            for name, value, error, before in _file_rows(made)
        ],
        "file_misfit": made.values.misfit,
        "whole_bodies": None if made.whole is None else _whole_record(made.whole),
        "impossible_bodies": list(made.values.impossible),
        "kept": dict(made.names.kept),
        "notes": list(notes(made)),
    }  # fmt: skip
    return json.dumps(_rounded(record), indent=2, ensure_ascii=False) + "\n"


def _file_rows(made: Identification) -> list[tuple[str, float, float, float]]:
    values = made.values
    return list(zip(values.names, values.values, values.errors, values.before, strict=True))


def _whole_record(whole: WholeBodies) -> dict[str, Any]:
    rows = zip(whole.parameters, whole.values, whole.errors, whole.before, strict=True)
    return {
        "method": whole.method,
        "misfit": whole.misfit,
        "at_edge": list(whole.at_edge),
        "parameters": [
            {"name": one.name, "value": value, "standard_error": error, "before": before}
            for one, value, error, before in rows
        ],
    }


def _rounded(entry: Any) -> Any:
    """Numbers to the recorded digits; what is no number is null."""
    if isinstance(entry, dict):
        return {key: _rounded(value) for key, value in entry.items()}
    if isinstance(entry, (list, tuple)):
        return [_rounded(value) for value in entry]
    if isinstance(entry, (float, np.floating)):
        return float(f"{entry:.{RECORDED_DIGITS}g}") if math.isfinite(entry) else None
    return entry
