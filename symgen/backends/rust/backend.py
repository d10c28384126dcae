"""Rust: the kernels for one state, in float64 and float32, as one crate."""

from __future__ import annotations

from symgen.backends.backend import Backend, Variant
from symgen.backends.rust.crate import emit_crate
from symgen.backends.rust.module import emit_rust

BACKEND = Backend(
    "rust",
    "Rust",
    (Variant(emit_rust),),
    (".rs",),
    "c",
    folder="rust/src",
    stem=lambda _, scalar, ending: scalar + ending,
    around=emit_crate,
)
