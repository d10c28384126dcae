"""symgen from Python and in notebooks: models built, derived, generated, compiled and simulated."""
