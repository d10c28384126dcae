"""What the witness computes with: nodes and their values in floats and balls, linear algebra."""
