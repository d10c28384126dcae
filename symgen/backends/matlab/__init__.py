"""MATLAB and Octave: the C behind a gateway, and a function for each quantity."""
