# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Addresses without the passwords in them."""

import pickle
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.addresses import short_name, shown, shown_values, without_passwords
from vehicle_pf_tracker.core.errors import InputError

SECRET = "hunter2"


@pytest.mark.parametrize(
    ("address", "as_shown", "name"),
    [
        ("rtsp://admin:hunter2@10.0.0.7:554/main", "rtsp://***@10.0.0.7:554/main", "main"),
        ("rtsp://admin:hunter2@cam.local", "rtsp://***@cam.local", "cam.local"),
        ("rtsp://hunter2@cam/1", "rtsp://***@cam/1", "1"),
        ("rtsp://:hunter2@cam/1", "rtsp://***@cam/1", "1"),
        ("RTSP://admin:hunter2@cam/1", "RTSP://***@cam/1", "1"),
        ("rtsp://admin:p@hunter2@cam/1", "rtsp://***@cam/1", "1"),
        ("rtsp://admin:p/hunter2@cam/1", "rtsp://***@cam/1", "1"),
        ("rtsp://admin:p#hunter2@cam/1", "rtsp://***@cam/1", "1"),
        ("rtsp://admin:p?hunter2@cam/1", "rtsp://***@cam/1", "1"),
        ("rtsp://admin:hunter2%40@cam/1", "rtsp://***@cam/1", "1"),
        ("rtsp://admin:p hunter2@cam/1", "rtsp://***@cam/1", "1"),
        ("http://u:hunter2@[::1]:80/v.mp4", "http://***@[::1]:80/v.mp4", "v"),
        ("http://cam/cgi?usr=a&pwd=hunter2&x=1", "http://cam/cgi?usr=a&pwd=***&x=1", "cgi"),
        ("https://h/v.mp4?token=hunter2", "https://h/v.mp4?token=***", "v"),
        ("https://h/v.mp4?X-Amz-Signature=hunter2", "https://h/v.mp4?X-Amz-Signature=***", "v"),
        # Nothing to hide.
        ("rtsp://cam:554/a@b", "rtsp://cam:554/a@b", "a_b"),
        ("http://[::1]:80/x", "http://[::1]:80/x", "x"),
        ("clips/password=a@b.mp4", "clips/password=a@b.mp4", "password=a@b"),
        ("0", "0", "0"),
    ],
)
def test_an_address_is_shown_without_its_password(address, as_shown, name):
    assert shown(address) == as_shown
    assert short_name(address) == name
    sentence = f"the stream {address} cannot be opened"
    assert without_passwords(sentence) == f"the stream {as_shown} cannot be opened"
    assert str(InputError(sentence)) == f"the stream {as_shown} cannot be opened"
    assert shown_values({"a": [address, 1, None]}) == {"a": [as_shown, 1, None]}


PASSWORDS = st.text(st.characters(codec="ascii", categories="LN", include_characters="!$%&+,;@~"))


@given(PASSWORDS, st.sampled_from(["rtsp", "http", "https", "rtmp", "srt"]))
def test_no_password_is_left(password, scheme):
    address = f"{scheme}://admin:begin{password}end@cam.local:554/main"
    for words in (shown(address), str(InputError(f"{address} and {address}: no"))):
        assert "begin" not in words and "end@" not in words
        assert "cam.local:554/main" in words


@pytest.mark.parametrize(
    "text", ["y", "ab://x:y", "http://h/?", "key", "/_", "http://h:p", "a:/", "ab://@", "1a.-"]
)
def test_a_long_text_of_another_program_is_read_in_a_moment(text):
    began = time.process_time()
    long = f"http://h/?{text * (100_000 // len(text))}"
    assert SECRET not in str(InputError(f"{long[10:]} {long} rtsp://admin:{SECRET}@cam/1"))
    assert time.process_time() - began < 10


def test_an_error_is_the_same_in_another_process():
    assert str(pickle.loads(pickle.dumps(InputError("a b")))) == "a b"
