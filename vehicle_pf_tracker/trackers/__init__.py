"""One file per tracker variant, the contract they share, and the registry."""
