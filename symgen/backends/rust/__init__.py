"""Rust: a crate without the standard library and without unsafe code, in float64 and float32."""
