"""Energies in place of bodies: products of parameters that inputs are linear in, and which of these a log shows."""
