"""Frames and bodies as the reference sees them: its own kinematics, and what a motion asks of bodies."""
