"""Films and pictures by the workers of a cluster."""
