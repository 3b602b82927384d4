"""Bytes of files and pipes, and the text in them."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import pytest

from des_cli.errors import FileAccessError, ProfileError
from des_cli.profiles_in.source import decode, decode_table, label_of, read_source


def test_a_file_is_read_as_it_is(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(b"\xef\xbb\xbfa\r\nb\x00\xff")
    assert read_source(path, "x", None) == b"\xef\xbb\xbfa\r\nb\x00\xff"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_a_pipe_is_read_to_its_end_where_somebody_writes_it(tmp_path: Path) -> None:
    path = tmp_path / "pipe"
    os.mkfifo(path)
    with pytest.raises(FileAccessError, match="x: is a pipe, not a file"):
        read_source(path, "x", None)
    with pytest.raises(FileAccessError, match="x: is a pipe that nobody writes to"):
        read_source(path, "x", None, pipes=True)
    # Open on both sides: there is a writer, which has written nothing yet.
    held = os.open(path, os.O_RDWR)

    def write() -> None:
        path.write_bytes(b"0,1\n" * 50_000)
        os.close(held)

    writer = threading.Timer(0.05, write)
    writer.daemon = True
    writer.start()
    assert read_source(path, "x", None, pipes=True) == b"0,1\n" * 50_000
    writer.join()


def test_a_file_is_read_no_further_than_its_cap(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(bytes(1 << 20))
    assert len(read_source(path, "x", 1)) == 1 << 20
    path.write_bytes(bytes((1 << 20) + 1))
    with pytest.raises(FileAccessError, match=r"^x: is larger than 1 MiB; --max-mib reads more$"):
        read_source(path, "x", 1)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("none.csv", "cannot be read: No such file or directory"),
        (".", "is a folder, not a file"),
        ("/dev/null", "is a device, not a file"),
        ("loop", "cannot be read: Too many levels of symbolic links"),
        ("x" * 5000, "cannot be read: File name too long"),
        ("a\0b", "cannot be read: is not a file name"),
    ],
)
def test_what_is_no_file_is_said_of_its_label(tmp_path: Path, name: str, words: str) -> None:
    (tmp_path / "loop").symlink_to("loop")
    with pytest.raises(FileAccessError) as caught:
        read_source(tmp_path / name, "the log", None)
    assert str(caught.value) == f"the log: {words}"


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="here every file is readable")
def test_a_file_without_permission_is_named(tmp_path: Path) -> None:
    path = tmp_path / "closed.yaml"
    path.write_bytes(b"a: 1\n")
    path.chmod(0)
    with pytest.raises(FileAccessError, match=r"^x: cannot be read: Permission denied$"):
        read_source(path, "x", None)


@pytest.mark.parametrize("data", [b"\xef\xbb\xbfn: \xc3\xa9\n", b"n: \xc3\xa9\n"])
def test_utf_8_is_read_with_and_without_a_byte_order_mark(data: bytes) -> None:
    assert decode(data, "x") == "n: é\n"
    assert decode_table(data, "x") == ("n: é\n", ())


@pytest.mark.parametrize(
    ("data", "complaint"),
    [
        (b"a\nb\n\xe9t\xe9\n", "x:3: is not UTF-8 text (byte 0xe9); save it as UTF-8"),
        (b"\xef\xbb\xbfa\n\x80", "x:2: is not UTF-8 text (byte 0x80); save it as UTF-8"),
        (b"a\r\n\xc3", "x:2: is not UTF-8 text (byte 0xc3); save it as UTF-8"),
        ("a\n".encode("utf-16"), "x:1: is not UTF-8 text (byte 0xff); save it as UTF-8"),
        (b"a\n\n b\0", "x:3: holds a NUL byte; it is not a text file"),
    ],
)
def test_what_is_not_text_is_named_by_its_line_and_byte(data: bytes, complaint: str) -> None:
    with pytest.raises(ProfileError) as caught:
        decode(data, "x")
    assert str(caught.value) == complaint


def test_a_table_in_latin_1_is_read_and_told() -> None:
    assert decode_table(b"t_s\n0\nT (\xb0C), \xfc\n", "x") == (
        "t_s\n0\nT (°C), ü\n",
        ("the file is not UTF-8 (byte 0xb0 in line 3): it is read as Latin-1",),
    )


def test_a_byte_order_mark_is_no_part_of_a_table_in_latin_1() -> None:
    marked = b"\xef\xbb\xbft_s\n0\nT (\xb0C)\n"
    assert decode_table(marked, "x") == (
        "t_s\n0\nT (°C)\n",
        ("the file is not UTF-8 (byte 0xb0 in line 3): it is read as Latin-1",),
    )


@pytest.mark.parametrize(
    ("data", "complaint"),
    [
        (b"\xff\xfe" + "t_s\n".encode("utf-16-le"), "x: is UTF-16 text; save it as UTF-8"),
        (b"\xfe\xff" + "t_s\n".encode("utf-16-be"), "x: is UTF-16 text; save it as UTF-8"),
        ("t\n0".encode("utf-16-le"), "x:1: holds a NUL byte; it is not a text file"),
        (b"\xb0\n\0", "x:2: holds a NUL byte; it is not a text file"),
    ],
)
def test_a_table_that_is_no_text_is_refused(data: bytes, complaint: str) -> None:
    with pytest.raises(ProfileError) as caught:
        decode_table(data, "x")
    assert str(caught.value) == complaint


def test_a_label_is_the_path_on_one_line() -> None:
    long = "folder/" * 30 + "my löG.csv"
    assert label_of(Path(long)) == label_of(long) == long
    assert label_of("a\nb\x1b[1m") == r"'a\nb\x1b[1m'"
    assert label_of("") == "''"
