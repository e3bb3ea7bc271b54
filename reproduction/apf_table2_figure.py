"""Table II as a picture: every tracker's error on every video, with its range over the seeds."""

from __future__ import annotations

from matplotlib.figure import Figure

from reproduction.apf_systems import SIX
from reproduction.case_figure import SHADES, Values, error_case_figure
from reproduction.scenes.videos import VIDEOS


def table_figure(videos: Values) -> Figure:
    """Draw medians as marks and ranges as lines, on a logarithmic scale."""
    shown = {
        name: {system.label: errors[system.label] for system in SIX}
        for name, errors in videos.items()
    }
    shades = {name: SHADES[VIDEOS[name].occlusion] for name in videos}
    names = [name.removeprefix("video") for name in videos]
    return error_case_figure(shown, shades, names, "video")
