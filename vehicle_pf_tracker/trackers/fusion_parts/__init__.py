"""The parts that `fusion` is made of."""
