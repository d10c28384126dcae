"""What is said by laws of short matrices and by determinants, where formulas would take pages."""
