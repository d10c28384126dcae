"""The rule of statuses: where a result may be wrong, and what a status has to answer to."""
