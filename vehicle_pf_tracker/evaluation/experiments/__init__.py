"""The papers' experiments: runs, data, figure and verdict of each, by name (`catalogue`)."""
