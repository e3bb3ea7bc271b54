"""The tracker node: images in, estimates out."""
