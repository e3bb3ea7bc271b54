"""Scenes after the papers' videos and cases, beside those of the package."""
