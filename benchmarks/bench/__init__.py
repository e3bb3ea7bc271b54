"""Speed, memory and cost of the node, as ratios measured in one run: `make bench`."""
