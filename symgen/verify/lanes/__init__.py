"""Many states at once in float64, a lane each: where to look, never what is right."""
