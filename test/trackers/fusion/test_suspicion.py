"""Doubt, hiding and forgiveness."""

from vehicle_pf_tracker.trackers.fusion.appearance import Likeness
from vehicle_pf_tracker.trackers.fusion.suspicion import Sight, Suspicion

CLEAR = Likeness(0.95, 0.95, 0.8)


def looks(following, colour=0.8, anchor=0.9):
    return Likeness(anchor, following, colour)


def settled(frames=30):
    """A judge that has seen clear frames."""
    judge = Suspicion()
    judge.settle(CLEAR)
    for _ in range(frames):
        ask(judge, CLEAR)
    return judge


def ask(judge, likeness, off=0.05, half=0.9, *, gate=True, patience=25, **seen):
    sight = Sight(likeness, off, lambda: half, **seen)
    return judge.judge(sight, gate=gate, patience=patience)


def test_usual_looks_are_clear():
    judge = settled()
    assert ask(judge, CLEAR).clear
    assert judge.frames == 0
    assert judge.share(looks(0.475)) == 0.5


def test_a_fall_is_a_doubt_and_no_more():
    judge = settled()
    for _ in range(10):
        verdict = ask(judge, looks(0.8, colour=0.7))
        assert not verdict.clear
        assert not verdict.hidden
    assert judge.frames == 10


def test_looks_settle_in_the_first_frames():
    assert ask(settled(3), looks(0.75)).clear
    assert not ask(settled(30), looks(0.75)).clear


def test_neither_the_whole_nor_a_half_for_three_frames_is_hidden():
    judge = settled()
    told = [ask(judge, looks(0.4, colour=0.5), half=0.5).hidden for _ in range(3)]
    assert told == [False, False, True]


def test_a_half_in_sight_is_not_hidden():
    judge = settled()
    assert not any(ask(judge, looks(0.4, colour=0.5), half=0.9).hidden for _ in range(10))


def test_beside_the_foretold_path_in_doubt_is_hidden_unless_the_gate_is_off():
    for gate in (True, False):
        judge = settled()
        verdicts = [ask(judge, looks(0.8, colour=0.7), off=0.6, gate=gate) for _ in range(3)]
        assert verdicts[-1].hidden is gate


def test_beside_the_foretold_path_and_clear_is_a_swerve():
    judge = settled()
    assert ask(judge, CLEAR, off=0.6).clear


def test_lasting_colours_on_the_path_are_a_turn():
    judge = settled()
    verdict = ask(judge, looks(0.4), half=0.3)
    assert verdict.turning
    assert not verdict.hidden
    assert not ask(settled(), looks(0.4), half=0.3, grey=True).turning
    assert not ask(settled(), looks(0.4), half=0.3, off=0.4).turning


def test_after_long_doubt_on_the_path_the_new_looks_are_the_target():
    judge = settled()
    clear = [ask(judge, looks(0.8, colour=0.7), patience=5).clear for _ in range(7)]
    assert clear == [False] * 5 + [True, True]


def test_candidates_are_strong_or_fair_or_neither():
    judge = settled()
    assert judge.is_strong(looks(0.93))
    assert not judge.is_strong(looks(0.8))
    assert not judge.is_strong(looks(0.93, colour=0.5))
    assert judge.is_fair(looks(0.8))
    assert not judge.is_fair(looks(0.6))
    assert not judge.is_fair(looks(0.8, colour=0.4))


def test_what_was_there_before_the_target_is_not_the_target():
    verdict = ask(settled(), CLEAR, background=True)
    assert not verdict.clear


def test_an_anchor_that_has_sunk_is_a_doubt_though_the_following_template_went_along():
    assert ask(settled(), looks(0.95, anchor=0.6)).clear
    assert not ask(settled(), looks(0.95, anchor=0.4)).clear
    assert ask(settled(5), looks(0.95, anchor=0.4)).clear


def test_doubt_is_told_from_the_second_frame_on_and_until_looks_are_back():
    judge = settled()
    told = []
    for likeness in [looks(0.7), looks(0.7), looks(0.83), looks(0.9), looks(0.7), CLEAR]:
        ask(judge, likeness, half=0.9)
        told.append(judge.doubtful)
    assert told == [False, True, True, False, False, False]


def test_a_reset_forgets_the_doubts():
    judge = settled()
    for _ in range(2):
        ask(judge, looks(0.4, colour=0.5), half=0.5)
    judge.reset()
    assert judge.frames == 0
    assert not judge.doubtful
    assert not ask(judge, looks(0.4, colour=0.5), half=0.5).hidden


def test_new_looks_are_told_once():
    judge = settled()
    renewed = [ask(judge, looks(0.8, colour=0.7), patience=3).renewed for _ in range(6)]
    assert renewed == [False, False, False, True, False, False]


def test_renewed_it_settles_anew():
    judge = settled()
    judge.renew()
    judge.settle(looks(0.6, colour=0.5, anchor=0.6))
    judge.settle(CLEAR)  # only the first counts
    assert judge.level == 0.6
    assert ask(judge, looks(0.58, colour=0.5, anchor=0.6)).clear
