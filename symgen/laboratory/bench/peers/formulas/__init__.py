"""What an expert writes down in a tool's scalars: forces, accelerations, multipliers, matrices."""
