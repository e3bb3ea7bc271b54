from tools.licence_headers import HEADER, without_header


def test_every_file_has_the_licences_header():
    assert list(without_header()) == []  # `python -m tools.licence_headers` adds it


def test_a_file_without_it_is_found(tmp_path):
    folder = tmp_path / "test"
    folder.mkdir()
    (folder / "empty.py").write_text("")
    (folder / "good.py").write_text(HEADER + '"""Text."""\n')
    (folder / "bad.py").write_text('"""Text."""\n')
    assert [path.name for path in without_header(tmp_path)] == ["bad.py"]
