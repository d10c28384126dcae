"""Bodies that can be: the full set of inertial parameters nearest to estimates and model file, on pseudo-inertias."""
