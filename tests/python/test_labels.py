# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of labels beside motion files: metadata.csv."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
import sparse_mocap
from sparse_mocap import FormatError, MotionDatabase
from sparse_mocap.labels import Labels, find_labels, read_labels


def motion_file(folder: Path, name: str) -> str:
    """Makes a file that is there, which is all that finding labels asks of it."""
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch()
    return str(path)


def found(folder: Path, table: bytes) -> tuple[dict[str, Labels], list[str]]:
    """What a table says of the files in a folder, by their names in it."""
    (folder / "metadata.csv").write_bytes(table)
    labels, warnings = find_labels([folder])
    return {Path(path).relative_to(folder).as_posix(): said for path, said in labels.items()}, (
        warnings
    )


def test_files_are_named_by_path_name_or_stem_in_any_case(tmp_path: Path) -> None:
    for name in ("deep/walk.bvh", "other/walk.bvh", "deep/RUN.amc", "walk.amc", "jump.bvh"):
        motion_file(tmp_path, name)
    labels, warnings = found(
        tmp_path, b"file,actor\nDeep/Walk.bvh,path\nwalk.BVH,name\nrun,stem\n./JUMP.bvh,dot\n"
    )
    assert {name: said.actor for name, said in labels.items()} == {
        "deep/walk.bvh": "path",
        "other/walk.bvh": "name",
        "deep/RUN.amc": "stem",
        "jump.bvh": "dot",
    }
    assert warnings == []


def test_what_is_left_empty_is_not_said(tmp_path: Path) -> None:
    motion_file(tmp_path, "x.bvh")
    motion_file(tmp_path, "deep/y.bvh")
    labels, _ = found(
        tmp_path,
        b"license, SOURCE ,class,actor,file\r\n"
        b"CC0,,,anna,x.bvh\r\n\r\n  ,studio, walk ,,deep\\y.bvh\r\n",
    )
    assert labels == {
        "x.bvh": Labels(actor="anna", license="CC0"),
        "deep/y.bvh": Labels(motion_class="walk", origin="studio"),
    }


def test_quotes_and_a_byte_order_mark_are_read(tmp_path: Path) -> None:
    motion_file(tmp_path, "a,b.bvh")
    table = b'\xef\xbb\xbffile,"license"\n"a,b.bvh","CC BY 4.0, ""as is"""\n'
    assert found(tmp_path, table)[0] == {"a,b.bvh": Labels(license='CC BY 4.0, "as is"')}


def test_letters_of_every_language_are_compared_in_any_case(tmp_path: Path) -> None:
    motion_file(tmp_path, "\u00dcbung.bvh")
    labels, warnings = found(tmp_path, "file,actor\n\u00fcbung,J\u00f6rg\n".encode())
    assert labels == {"\u00dcbung.bvh": Labels(actor="J\u00f6rg")}
    assert warnings == []


@pytest.mark.parametrize(
    ("table", "complaint"),
    [
        ("file,actr\n", ':1: unknown column "actr"; did you mean "actor"?'),
        ("file,licence\n", 'did you mean "license"? Known are file, actor, class, source, license'),
        ("clip,actor\n", ':1: unknown column "clip"; '),
        ("actor,class\n", ':1: the column "file" is missing; the header is file,actor,'),
        ("file,actor,File\n", ':1: the column "file" occurs twice; leave one out'),
        ("file,actor\na,b\nc\n", ":3: has 1 fields, the header has 2; put text that"),
        ("file,actor\na,b,\n", ":2: has 3 fields, the header has 2; "),
        ('file,actor\nx,"b\ny,c"\n', ":2: a quote is not closed on its line; "),
        ('file,actor\n"x"y,b\n', ":2: text follows a quoted field; put a comma"),
        ("file,actor\n" + "x" * 140_000 + ",b\n", ":2: is not a line of CSV (field larger than"),
        ("actor,file\nb,\n", ":2: names no file; write its name"),
        ("actor,file\na,x\nb,y\nc,X\n", ':4: "X" is described in line 2 already; leave one'),
        ("", ": is empty; the header is file,"),
        ("\n  \n", ": is empty; the header is file,"),
        ("file\0actor", ":1: contains a NUL byte"),
    ],
)
def test_a_table_at_fault_says_where_and_what_to_do(
    tmp_path: Path, table: str, complaint: str
) -> None:
    path = tmp_path / "metadata.csv"
    path.write_text(table, encoding="utf-8")
    with pytest.raises(FormatError) as caught:
        read_labels(path)
    line = str(caught.value)
    assert line.startswith(f"{path}{complaint}" if complaint.startswith(":") else str(path))
    assert complaint in line
    assert "\n" not in line


def test_text_that_is_no_utf8_says_where(tmp_path: Path) -> None:
    path = tmp_path / "metadata.csv"
    path.write_bytes(b"file,actor\nx,J\xf6rg\n")
    with pytest.raises(FormatError, match=r"metadata\.csv:2: is not UTF-8 text; save it as UTF-8"):
        read_labels(path)


def test_rows_that_name_no_file_are_warned_of(tmp_path: Path) -> None:
    for name in ("x.bvh", "sub/y.bvh", "sub/z.bvh"):
        motion_file(tmp_path, name)
    _, warnings = found(tmp_path, b"file\nx\nghost.bvh\ny.bvh\nDeep/z.bvh\n")
    table = tmp_path / "metadata.csv"
    assert warnings == [
        f'{table}:3: no motion file is called "ghost.bvh"',
        f'{table}:5: no motion file is called "Deep/z.bvh"',
    ]


def test_a_folders_own_table_holds_for_its_files_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("a/x.bvh", "b/x.bvh", "b/y.bvh"):
        motion_file(tmp_path, name)
    (tmp_path / "a" / "metadata.csv").write_text("file,actor\nx,anna\ny,nobody\n")
    monkeypatch.chdir(tmp_path / "a")
    labels, warnings = find_labels([Path("."), Path("../b")])
    assert labels == {"x.bvh": Labels(actor="anna")}
    assert warnings == ['metadata.csv:3: no motion file is called "y"']
    for_all = tmp_path / "all.csv"
    for_all.write_text("file,actor\ny,berta\n")
    labels, warnings = find_labels([Path("."), Path("../b")], metadata=for_all)
    assert labels == {str(Path("../b/y.bvh")): Labels(actor="berta")}
    assert warnings == []


def test_databases_hold_what_tables_say(library: Path, tmp_path: Path) -> None:
    folder, path = tmp_path / "in", tmp_path / "db.smdb"
    folder.mkdir()
    for name in ("ada_walk_01.bvh", "bruno_walk_01.bvh"):
        shutil.copy(library / name, folder)
    (folder / "metadata.csv").write_text(
        "file,actor,class,source,license\nada_walk_01,Ada L.,stroll,studio,CC0\nghost,,,,\n"
    )
    report = sparse_mocap.build_database([folder], path, tempo_copies=())
    assert [line for line in report.warnings if "ghost" in line] == report.warnings[:1]
    clips = {clip.source: clip for clip in MotionDatabase(path).clips}
    ada, bruno = clips["ada_walk_01.bvh"], clips["bruno_walk_01.bvh"]
    said = (ada.actor, ada.motion_class, ada.origin, ada.license)
    assert said == ("Ada L.", "stroll", "studio", "CC0")
    assert (bruno.actor, bruno.origin, bruno.license) == ("bruno", "", "")
    more = tmp_path / "more.csv"
    more.write_text("file,class\nbruno_walk_01.bvh,march\n")
    report = sparse_mocap.add_to_database(path, [folder], metadata=more)
    assert report.num_known == 2
    clips = {clip.source: clip for clip in MotionDatabase(path).clips}
    assert clips["bruno_walk_01.bvh"].motion_class == "march"
    assert clips["ada_walk_01.bvh"].motion_class == "stroll"
