"""Measurements in the image: windows, histograms, gradients, templates, similarity."""
