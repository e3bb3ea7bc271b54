"""The ground everything stands on: frames, boxes, stamps, truth and the user's mistakes."""
