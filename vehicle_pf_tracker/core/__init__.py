"""Types and rules that every room uses: frames, boxes, stamps, ground truth, input errors."""
