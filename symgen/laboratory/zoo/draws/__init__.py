"""The families of drawn systems: what is drawn, and the model files they become."""
