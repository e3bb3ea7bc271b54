"""Candidates have to agree over several frames."""

from vehicle_pf_tracker.trackers.fusion_parts.candidates import Candidate, Candidates

VELOCITY = (4.0, 0.0)


def found(x, share=0.95, scale=1.0):
    return Candidate((x, 50.0), (x, 50.0), scale, share)


def followed(places, **values):
    candidates = Candidates()
    return [candidates.follow([found(x, **values)], VELOCITY, 1.0, 30.0) for x in places][-1]


def test_what_moves_like_the_target_is_followed():
    (one,) = followed([100, 104, 108, 112])
    assert one.frames == 4
    assert one.velocity == (4.0, 0.0)
    assert one.is_certain((112.0, 50.0), 10.0, confirm=4, least=0.8)
    assert not one.is_certain((112.0, 50.0), 10.0, confirm=5, least=0.8)


def test_what_stands_still_is_none():
    assert all(one.frames < 8 for one in followed([100] * 12))


def test_what_is_less_alike_is_not_taken():
    (one,) = followed([100, 104, 108, 112], share=0.75)
    assert not one.is_certain((112.0, 50.0), 10.0, confirm=4, least=0.8)


def test_far_away_takes_longer():
    (one,) = followed([100, 104, 108, 112])
    assert not one.is_certain((142.0, 50.0), 10.0, confirm=4, least=0.8)


def test_a_jump_in_size_begins_anew():
    candidates = Candidates()
    candidates.follow([found(100)], VELOCITY, 1.0, 30.0)
    (one,) = candidates.follow([found(104, scale=1.6)], VELOCITY, 1.0, 30.0)
    assert one.frames == 1


def test_two_are_followed_at_once():
    candidates = Candidates()
    for x in (100, 104, 108):
        both = candidates.follow([found(x), found(x + 80, share=0.85)], VELOCITY, 1.0, 30.0)
    assert [one.frames for one in both] == [3, 3]
