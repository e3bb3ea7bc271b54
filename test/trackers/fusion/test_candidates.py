"""Candidates have to agree over several frames."""

import pytest

from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.candidates import Candidate, Candidates, Chain

STILL = CameraMotion()


def chain_of(places, *, scales=None, strong=True, motion=STILL):
    """Chain after one candidate at each x of `places`, one frame apart; None leaves a frame out."""
    candidates = Candidates()
    for number, x in enumerate(places):
        candidates.age(1.0, motion)
        if x is not None:
            scale = scales[number] if scales else 1.0
            candidates.add(Candidate((float(x), 50.0), scale, strong))
    return candidates.chain(30.0)


def test_a_steady_run_is_one_chain_with_its_mean_velocity():
    chain = chain_of([100, 104, 108, 113])
    assert chain.frames == 4
    assert chain.velocity == pytest.approx((13 / 3, 0.0))
    assert chain.strong == 1.0
    assert [one.place[0] for one in chain.links] == [100, 104, 108, 113]


def test_one_missed_frame_is_borne_and_two_are_not():
    assert chain_of([100, 104, None, 112]).frames == 3
    assert chain_of([100, 104, None, None, 116, 120]).frames == 2


def test_no_candidate_in_this_frame_is_no_chain():
    assert chain_of([100, 104, 108, None]) is None
    assert chain_of([100]) is None


def test_a_jump_begins_a_new_chain():
    assert chain_of([100, 104, 108, 160, 164, 168]).frames == 3


def test_a_jump_in_size_begins_a_new_chain():
    assert chain_of([100, 104, 108, 112], scales=[1.0, 1.0, 1.6, 1.6]).frames == 2


def test_a_camera_that_pans_takes_the_candidates_along():
    pan = CameraMotion((4.0, 0.0))
    assert chain_of([100, 104, 108], motion=pan).velocity == pytest.approx((0.0, 0.0))


def proves(chain, expected, confirm=3):
    return chain.proves(expected, 1.0, confirm)


def chain(frames, velocity, strong):
    """A chain of so many frames, with that share of strong candidates."""
    count = round(strong * frames)
    return Chain(
        tuple(
            Candidate((velocity[0] * t, velocity[1] * t), 1.0, t < count, frames - 1.0 - t)
            for t in range(frames)
        )
    )


def test_what_moves_as_foretold_is_believed_soon():
    assert proves(chain(3, (4.0, 0.5), 0.0), (4.0, 0.0))
    assert not proves(chain(2, (4.0, 0.5), 1.0), (4.0, 0.0))
    assert not proves(chain(3, (4.0, 0.5), 1.0), (4.0, 0.0), confirm=4)


@pytest.mark.parametrize("velocity", [(1.5, 0.0), (7.0, 0.0), (4.0, 2.0)])
def test_what_brakes_speeds_up_or_swerves_has_to_look_right_for_longer(velocity):
    assert proves(chain(5, velocity, 0.8), (4.0, 0.0))
    assert not proves(chain(4, velocity, 0.8), (4.0, 0.0))
    assert not proves(chain(5, velocity, 0.6), (4.0, 0.0))


@pytest.mark.parametrize("velocity", [(0.0, 0.0), (-4.0, 0.0), (4.0, 4.0), (9.0, 0.0)])
def test_what_moves_against_all_expectation_has_to_look_right_for_longest(velocity):
    assert proves(chain(12, velocity, 0.9), (4.0, 0.0))
    assert not proves(chain(11, velocity, 0.9), (4.0, 0.0))
    assert not proves(chain(12, velocity, 0.75), (4.0, 0.0))


@pytest.mark.parametrize(("away", "frames"), [(0.5, 3), (1.0, 3), (1.4, 5), (3.0, 13)])
def test_what_is_further_away_has_to_last_for_longer(away, frames):
    expected = (4.0, 0.0)
    assert chain(frames, expected, 1.0).proves(expected, 1.0, 3, away)
    assert not chain(frames - 1, expected, 1.0).proves(expected, 1.0, 3, away)
