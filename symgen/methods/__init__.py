"""The ways to compute u, accelerations and multipliers, each with where it is valid."""
