"""More inputs than motions: how they share the work, and what their limits leave."""
