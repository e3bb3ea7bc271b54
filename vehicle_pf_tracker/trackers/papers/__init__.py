"""Variants after papers, and the bases and parameters that they share."""
