import io

from vehicle_pf_tracker.cli.progress import counting


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_plain_lines_come_every_five_seconds():
    now, out = [0.0], io.StringIO()
    with counting("tracked", out, lambda: now[0]) as progress:
        for done in range(1, 13):
            now[0] += 1.0
            progress(done, 12)
    assert out.getvalue() == "tracked 5 of 12 frames\ntracked 10 of 12 frames\n"


def test_where_the_total_is_unknown_the_line_says_less():
    now, out = [0.0], io.StringIO()
    with counting("imported", out, lambda: now[0]) as progress:
        now[0] = 9.0
        progress(7, None)
    assert out.getvalue() == "imported 7 frames\n"


def test_a_terminal_gets_a_bar():
    out = Terminal()
    with counting("tracked", out) as progress:
        progress(3, 12)
    assert "3/12" in out.getvalue()
