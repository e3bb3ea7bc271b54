# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The picture of the rooms has every room and arrow, and each room above what it imports from."""

import itertools
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tools.rooms_layout import BOX_HEIGHT, BOX_WIDTH, MARGIN, ROW_STEP
from tools.rooms_picture import picture

PAGES = Path(__file__).resolve().parents[2] / "docs"
SVG = "{http://www.w3.org/2000/svg}"


@st.composite
def graphs(draw):
    """Draw a graph without circles: a room imports from those of smaller numbers."""
    count = draw(st.integers(1, 8))
    return {
        f"r{room}": {f"r{other}" for other in range(room) if draw(st.booleans())}
        for room in range(count)
    }


def boxes(text):
    """Return the left upper corner of each room's box."""
    root = ElementTree.fromstring(text)
    drawn = [one for one in root.iter(f"{SVG}rect") if one.get("x")]
    names = [one.text for one in root.iter(f"{SVG}text")]
    return {
        name: (float(one.get("x")), float(one.get("y")))
        for name, one in zip(names, drawn, strict=True)
    }


def arrows(text):
    """Return where each arrow begins and ends."""
    paths = [
        one for one in ElementTree.fromstring(text).iter(f"{SVG}path") if one.get("marker-end")
    ]
    ends = []
    for path in paths:
        first, *_, last = path.get("d").split("C")
        x, y = map(float, first.partition("V")[0].strip("M").split())
        ends.append(((x, y), tuple(map(float, last.split()[-2:]))))
    return ends


def test_a_chain_of_two_stands_as_computed_by_hand():
    text = picture({"upper": {"lower"}, "lower": set()})
    assert boxes(text) == {"lower": (MARGIN, MARGIN + ROW_STEP), "upper": (MARGIN, MARGIN)}
    x = MARGIN + BOX_WIDTH / 2
    assert arrows(text) == [((x, MARGIN + BOX_HEIGHT), (x, MARGIN + ROW_STEP))]


@given(graphs())
def test_every_arrow_leads_down_from_a_room_to_what_it_imports_from(graph):
    text = picture(graph)
    places = boxes(text)
    assert set(places) == set(graph)
    below = {(x + BOX_WIDTH / 2, y + BOX_HEIGHT): room for room, (x, y) in places.items()}
    above = {(x + BOX_WIDTH / 2, y): room for room, (x, y) in places.items()}
    drawn = [(below[begin], above[end]) for begin, end in arrows(text)]
    assert sorted(drawn) == sorted((room, one) for room, others in graph.items() for one in others)
    assert all(places[room][1] < places[other][1] for room, other in drawn)


@given(graphs())
def test_boxes_keep_apart(graph):
    places = sorted(boxes(picture(graph)).values(), key=lambda place: (place[1], place[0]))
    for (x, y), (next_x, next_y) in itertools.pairwise(places):
        assert next_y - y > BOX_HEIGHT or next_x - x > BOX_WIDTH


def test_rooms_that_import_from_each_other_have_no_picture():
    with pytest.raises(ValueError, match="cycle"):
        picture({"a": {"b"}, "b": {"a"}})


def test_the_page_shows_the_picture_and_no_source_of_one():
    page = (PAGES / "development.md").read_text()
    assert "](images/rooms.svg)" in page
    assert "mermaid" not in page
