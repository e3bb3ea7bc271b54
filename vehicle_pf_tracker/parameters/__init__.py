"""Parameters: the table that everything else is derived from, its files, a node's configuration."""
