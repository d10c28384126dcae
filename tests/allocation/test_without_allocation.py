"""A model with its allocation set aside is the model without it."""

from __future__ import annotations

from dataclasses import replace

import allocation_models as models

from symgen.model.blocks.allocation import without_allocation
from symgen.model.load import load_text


def test_nothing_of_the_block_is_left() -> None:
    block = "allocation: {weights: {p: 2}, preload: 1, limits: {s: [-1, 1]}}\n"
    made = without_allocation(load_text(models.PLATE + block, "m.yaml"))
    plain = load_text(models.PLATE, "m.yaml")
    assert replace(made, text_hash="") == replace(plain, text_hash="")
    assert without_allocation(plain) is plain


def test_preferred_values_too() -> None:
    made = without_allocation(load_text(models.SKID + "allocation: {preload: {p: 2, v: 1}}\n", "m.yaml"))
    assert replace(made, text_hash="") == replace(load_text(models.SKID, "m.yaml"), text_hash="")
