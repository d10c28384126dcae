"""Methods that nothing chooses: published ones, long or less accurate, to be compared with when asked for by name."""
