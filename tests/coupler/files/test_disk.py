"""Files are whole or not there, and a change of one bit of a sealed one is found."""

import errno
import os
from pathlib import Path

import pytest

from quintet.coupler.files.disk import is_sound, seal, write_at_last, write_whole
from quintet.coupler.files.table_file import TableFile
from quintet.interfaces.errors import DiskError


def no_room(*_):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_every_bit_and_every_length_of_a_sealed_file_matters(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(bytes(range(64)))
    seal(path)
    sealed = path.read_bytes()
    assert is_sound(path)
    for bit in range(8 * len(sealed)):
        flipped = bytearray(sealed)
        flipped[bit // 8] ^= 1 << bit % 8
        path.write_bytes(flipped)
        assert not is_sound(path)
    for length in range(len(sealed)):
        path.write_bytes(sealed[:length])
        assert not is_sound(path)


def test_a_file_that_cannot_be_written_whole_stays_as_it_was(tmp_path, monkeypatch):
    path = tmp_path / "a.json"
    write_whole(path, "before")
    monkeypatch.setattr(os, "fsync", no_room)
    with pytest.raises(DiskError, match=r"a\.json: it cannot be written, as the disk at / is full"):
        write_whole(path, "after")
    assert path.read_text() == "before" and [entry.name for entry in tmp_path.iterdir()] == [
        "a.json"
    ]


def test_what_must_be_kept_goes_elsewhere_where_there_is_no_room(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(os, "fsync", no_room)
    path = write_at_last(tmp_path / "results.json", "{}")
    assert path.read_text() == "{}" and not list(tmp_path.iterdir())
    assert f"It is kept as {path}." in capsys.readouterr().err


def test_results_go_elsewhere_where_a_disk_may_only_be_read(tmp_path, monkeypatch, capsys):
    def read_only(self, *_, **__):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(self))

    monkeypatch.setattr(Path, "unlink", read_only)
    monkeypatch.setattr(Path, "replace", read_only)
    path = write_at_last(tmp_path / "results.json", "{}")
    assert path.read_text() == "{}" and path.parent != tmp_path
    assert "may only be read" in capsys.readouterr().err
    monkeypatch.setattr(Path, "write_text", read_only)
    with pytest.raises(
        DiskError, match=r"results\.json: it cannot be written, .* may only be read"
    ):
        write_at_last(tmp_path / "results.json", "{}")


def test_a_table_has_whole_rows_only(tmp_path, monkeypatch):
    path = tmp_path / "t.csv"
    table = TableFile(path)
    table.write(["a", 1])
    assert table.flush() == path.stat().st_size == 5
    table.write(["b", 2])
    monkeypatch.setattr(os, "pwrite", lambda file, data, offset: no_room() if offset > 5 else 3)
    with pytest.raises(DiskError):
        table.flush()
    monkeypatch.undo()
    table.close()
    assert path.read_bytes() == b"a,1\r\n"
    reopened = TableFile(path, 5)
    reopened.write(["c", 3])
    reopened.close()
    assert path.read_bytes() == b"a,1\r\nc,3\r\n"
