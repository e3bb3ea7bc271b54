"""What is measured in the image: frames, boxes, windows, histograms, similarity."""
