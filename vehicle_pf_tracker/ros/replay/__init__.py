"""The replay of a recording to nodes."""
