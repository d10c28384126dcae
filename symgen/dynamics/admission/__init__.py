"""Which forms may be chosen without being asked for: those that divide by nothing that vanishes at a regular state."""
