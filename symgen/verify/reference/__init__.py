"""The independent reference in ball arithmetic; it shares nothing with the derivation but the parsed model."""
