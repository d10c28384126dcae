"""Methods for accelerations and multipliers, which solve the equations of motion (3) as a whole."""
