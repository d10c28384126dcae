"""FMI: functional mock-up units of plant and controller around the C, for Model Exchange and Co-Simulation."""
