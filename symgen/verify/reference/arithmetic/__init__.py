"""What the reference computes with: tapes of balls, truncated Taylor polynomials, linear algebra at known rank."""
