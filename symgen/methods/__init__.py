"""The methods that compute u, accelerations and multipliers, each with where it is valid."""
