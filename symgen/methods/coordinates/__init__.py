"""Other velocities than those of the file: along inputs, independent ones; coordinates that rows do not need."""
