"""Whether what a result divides by vanishes at a regular state: proofs, searches, measures of rank."""
