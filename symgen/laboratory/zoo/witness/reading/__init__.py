"""Model files to nodes of the witness: expressions, frames, what they say of motion."""
