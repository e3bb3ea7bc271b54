"""Parameters: the table that everything else is derived from, its files, and a node's whole set."""
