# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files replaced by --output and --fourier: older results, other files with --force, never an input."""

import base64
import errno
import json
import os
import zlib
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("bpy")
import bpy
from body_moments.command.files import inputs, own_results
from body_moments.command.measure import measuring
from body_moments.core.files import file_lock
from body_moments.core.files.file_lock import locked
from body_moments.core.files.whole_file import whole_file
from body_moments.core.measurement import documents
from body_moments.operators import batch

from tests.blender import batch_files as files
from tests.core.scan_files import nrrd

pytestmark = pytest.mark.usefixtures("scene")
WAVES = ("--grid", "2", "--qmax", "1")
# A layer from usd-core with the sublayer ./shape.usda.
CRATE = zlib.decompress(
    base64.b85decode(
        "c-jky2+|D=c5!ClU;u;Hj0{u(j5yc`@WCD?4zijX%1(gNaWG|Hm92F(85nX?OHzx915%4Z^D;{qq8LgG94j)58T9mvGZG6@^-7CV5*dn1lY9~@"
        "fy%fTK8X3Jr4^@^6f^jjWTX}`6clCVI%j0&q!gv*F%%c1CTFH)0)=5NU<G0}D4Ppra|08QaA09%)PadC01DbOFmO6B19cj3J4CQEI5HS9q;N188Z"
        "y*yFf7o7D%5g-1}6g#TrbEj#t??zY`>VGLQF{hhj<>W28quO;xn?t_yPZcfCz1DSd3x$5A$G%zqhMjFd`y4pmZ6O4h{+O^m9ij_=n~dH&0g|7bN"
        "{$&`|V4k#`M&DT#o}%fNi$7~+AXouLFOZx6FSz||R9elt|w0?G#fxaUTS"
    )
)


@pytest.fixture
def main(capfd):
    """The command line in this process: its exit code, and what it said of it."""

    def run(*words):
        with open(os.devnull, "wb") as nowhere:
            kept = os.dup(1)
            try:
                code = batch.main(files.in_process("measure", *words), channel=nowhere.fileno())
            finally:
                os.dup2(kept, 1)
                os.close(kept)
        return code, capfd.readouterr().err

    return run


@pytest.fixture
def no_measuring(monkeypatch):
    def measure(*_):
        raise AssertionError("an hour is lost")

    files.measure_with(monkeypatch, measure)


def foreign():
    ours = {"schema": "body-moments/1", "objects": []}
    yield "notes", b"old"
    yield "json", json.dumps({"schema": "body-moments/10"}).encode()
    yield "lines", "{}\n{}\n".format(json.dumps(ours), json.dumps({"mine": 1})).encode()
    yield "array", json.dumps([ours, {"mine": 1}]).encode()
    yield "cut", json.dumps(ours).encode()[:-1]
    yield "csv", b"file,frame,name,mass\n"
    yield "csv_edited", b"x," + "".join(documents.to_csv([])).encode()


@pytest.mark.parametrize("content", [pytest.param(content, id=name) for name, content in foreign()])
@pytest.mark.parametrize("option", ["--output", "--fourier"])
def test_foreign_file_is_kept_before_measuring(tmp_path, main, no_measuring, option, content):
    part = files.box_file(tmp_path / "part.stl")
    target = tmp_path / "target"
    target.write_bytes(content)
    code, said = main(part, option, target, *(WAVES if option == "--fourier" else ()))
    assert code == 2 and str(target) in said and "--force" in said
    assert target.read_bytes() == content


def test_foreign_arrays_are_kept(tmp_path, main, no_measuring):
    part = files.box_file(tmp_path / "part.stl")
    target = tmp_path / "target.npz"
    np.savez(target, q=1, F=2, error=3, input=4, method=5, frame=6, mine=7)
    kept = target.read_bytes()
    assert main(part, "--fourier", target, *WAVES)[0] == 2
    np.savez(target, q=1, F=2, error=3, input=4, method=5, frame=6)
    assert main(part, "--output", target)[0] == 2
    target.write_bytes(kept)
    assert main(part, "--output", target)[0] == 2 and target.read_bytes() == kept


def test_force_replaces_a_foreign_file(tmp_path, main):
    part = files.box_file(tmp_path / "part.stl")
    target, arrays = tmp_path / "out.json", tmp_path / "out.npz"
    target.write_text("old")
    arrays.write_text("old")
    code, _ = main(part, "--force", "--output", target, "--fourier", arrays, *WAVES)
    assert code == 0 and json.loads(target.read_text())["objects"] and np.load(arrays)["F"].shape == (8,)


def test_older_results_are_replaced_and_keep_their_mode(tmp_path, main):
    part = files.box_file(tmp_path / "part.stl")
    target, arrays = tmp_path / "out", tmp_path / "out.npz"
    target.touch()  # mktemp creates such files.
    target.chmod(0o600)
    for words in (
        (part,),
        (part, part),
        (part, part, "--format", "jsonl"),
        (part, "--format", "csv"),
        (part, "--format", "csv", "--order", "1", "--pose"),
    ):
        assert main(*words, "--output", target)[0] == 0
        before = target.read_bytes()
    assert main(part, "--output", target)[0] == 0 and target.read_bytes() != before
    for _ in range(2):
        assert main(part, "--fourier", arrays, *WAVES)[0] == 0
    if os.name == "posix":
        assert target.stat().st_mode & 0o777 == 0o600
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "out.npz", "part.stl"]


def scan(folder):
    head, samples = nrrd(np.ones((2, 2, 2), "f4"), "data file: my samples.raw").split(b"\n\n", 1)
    (folder / "scan.nhdr").write_bytes(head + b"\n\n")
    (folder / "my samples.raw").write_bytes(samples)
    return "scan.nhdr", "my samples.raw"


def textured(folder, name):
    """A box with a picture on it, exported."""
    image = bpy.data.images.new("picture", 1, 1)
    image.filepath_raw, image.file_format = str(folder / "a picture.png"), "PNG"
    image.save()
    material = bpy.data.materials.new("painted")
    if bpy.app.version < (5, 0):
        material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    shader = next(one for one in material.node_tree.nodes if one.type == "BSDF_PRINCIPLED")
    material.node_tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    files.add_box().data.materials.append(material)
    files.save(folder / name)


def companion(kind, folder):
    """A file to measure, and one that is read with it."""
    if kind == "nrrd":
        return scan(folder)
    if kind.startswith("gltf"):
        textured(folder, "my part.gltf")
        return "my part.gltf", next(path.name for path in folder.glob("*.bin" if kind == "gltf" else "a*.png"))
    if kind.startswith("obj"):
        textured(folder, "part.obj")
        return "part.obj", "part.mtl" if kind == "obj" else "a picture.png"
    if kind == "usda":
        files.write_text(folder / "shape.usda", files.usda_text(1.0))
        files.write_text(folder / "layer.usda", "#usda 1.0\n(subLayers = [@./shape.usda@])\n")
        files.write_text(folder / "part.usda", '#usda 1.0\ndef "A" (references = @layer.usda@</Tetra>) {}\n')
        return "part.usda", "shape.usda"
    if kind == "usdc":
        files.write_text(folder / "shape.usda", files.usda_text(1.0))
        (folder / "part.usdc").write_bytes(CRATE)
        return "part.usdc", "shape.usda"
    if kind == "tiles":
        image = bpy.data.images.new("tiles", 1, 1, tiled=True)
        image.filepath, image.use_fake_user = str(folder / "tile.<UDIM>.png"), True
        (folder / "tile.1001.png").write_bytes(b"a tile")
        files.add_box()
        files.save(folder / "part.blend")
        return "part.blend", "tile.1001.png"
    library = files.box_file(folder / "library.blend")
    files.empty_scene()
    with bpy.data.libraries.load(library, link=True, relative=True) as (_, wanted):
        wanted.objects = [files.BOX_NAME]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    files.save(folder / "part.blend")
    return "part.blend", "library.blend"


@pytest.mark.parametrize("option", ["--output", "--fourier"])
@pytest.mark.parametrize("kind", ["nrrd", "gltf", "gltf image", "obj", "obj image", "blend", "tiles", "usda", "usdc"])
def test_force_keeps_files_read_with_the_input(tmp_path, main, no_measuring, kind, option):
    if "usd" in kind and not bpy.app.usd.supported:
        pytest.skip("this Blender is built without USD")
    part, other = companion(kind, tmp_path)
    files.empty_scene()
    path, link = tmp_path / other, tmp_path / "link"
    os.link(path, link)  # another name of it
    kept = path.read_bytes()
    waves = WAVES if option == "--fourier" else ()
    assert main(tmp_path / part, option, path, *waves)[0] == 2
    for target in (path, link):
        code, said = main("--force", tmp_path / part, option, target, *waves)
        assert code == 2 and str(target) in said and "Use another name" in said and "--force" not in said
    assert path.read_bytes() == kept


def test_force_keeps_libraries_of_the_open_file(tmp_path, main, no_measuring):
    part, library = companion("blend", tmp_path)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / part))
    kept = (tmp_path / library).read_bytes()
    assert main("--force", "--output", tmp_path / library)[0] == 2
    assert main("--force", "--output", tmp_path / part)[0] == 2
    assert (tmp_path / library).read_bytes() == kept


@pytest.mark.parametrize("force", [(), ("--force",)])
@pytest.mark.parametrize("option", ["--output", "--fourier"])
def test_file_appearing_meanwhile_and_result_are_both_kept(tmp_path, main, monkeypatch, option, force):
    part = files.box_file(tmp_path / "part.stl")
    target = tmp_path / "out.npz"
    real = measuring.measure_object

    def measure(*rest):
        target.write_text("somebody's")
        return real(*rest)

    files.measure_with(monkeypatch, measure)
    code, said = main(part, *force, option, target, *(WAVES if option == "--fourier" else ()))
    assert code == 1 and target.read_text() == "somebody's"
    kept = tmp_path / "out.1.npz"
    assert str(kept) in said
    assert np.load(kept)["F"].shape == (8,) if option == "--fourier" else json.loads(kept.read_text())["objects"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.1.npz", "out.npz", "part.stl"]


@pytest.mark.skipif(not Path("/dev/stdout").exists(), reason="not on this system: devices")
def test_standard_output_follows_its_redirection(tmp_path):
    from tests.command.test_process import script

    part = files.box_file(tmp_path / "part.stl")
    with open(tmp_path / "log", "w") as log:
        log.write("before\n")
        log.flush()
        words = ("measure", part, "--format", "jsonl", "--output", "/dev/stdout")
        ended = script(*words, stdout=log, stderr=log)
    lines = (tmp_path / "log").read_text().splitlines()
    assert ended.returncode == 0 and lines[0] == "before" and json.loads(lines[-1])["objects"]


def crate(tokens, name=b"TOKENS", sections=1, before=0):
    """A binary USD layer of nothing but words, packed so: its table of sections, some of which come before."""
    others = b"".join(b"OTHER".ljust(16, b"\0") + bytes(16) for _ in range(before))
    place = 8 + 32 * (before + 1)
    table = (sections + before).to_bytes(8, "little") + others + name.ljust(16, b"\0")
    table += (24 + place).to_bytes(8, "little") + bytes(8)
    words = (1).to_bytes(8, "little") + bytes(8) + len(tokens).to_bytes(8, "little") + tokens
    return b"PXR-USDC" + bytes(8) + (24).to_bytes(8, "little") + table + words


def literals(text, more=b""):
    """An LZ4 block of these bytes and what follows, as USD packs one block alone."""
    assert len(text) < 15
    return bytes([0, len(text) << 4]) + text + more


@pytest.mark.parametrize(
    "data",
    [
        crate(literals(b"\0a.usda\0"), b"TOKEN"),
        crate(literals(b"\0a.usda\0"), sections=0),
        crate(literals(b"\0a.usda\0"), b"OTHER", 60)[:200],
        crate(literals(b"\0a.usda\0", bytes([9, 0]))),  # a match of what is before the beginning
        crate(literals(b"\0a.usda\0", bytes([0, 0]))),  # and of nothing
        crate(literals(b"\0a.usda\0", bytes([1]))),
        crate(literals(b"\0a.usda\0", bytes([1, 0, 0xF0]))),
        crate(bytes([2]) + (11).to_bytes(4, "little") + literals(b"\0a.usda\0")[1:]),
        b"PXR-USDC",
        b"PXR-USDC" + bytes(8) + b"\xff" * 16,
    ],
)
def test_a_damaged_binary_layer_refers_to_nothing(tmp_path, data):
    (tmp_path / "a.usda").touch()
    (tmp_path / "part.usdc").write_bytes(data)
    assert [*inputs.references(str(tmp_path / "part.usdc"), False)] == []


def test_unreadable_file_is_not_replaced(tmp_path, main, no_measuring, monkeypatch):
    """Refuse a file that may or may not be a result."""
    part, target = files.box_file(tmp_path / "part.stl"), tmp_path / "out"
    target.write_text("mine")

    def fail(*_):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(own_results, "open", fail, raising=False)
    expected = files.sentence("usage_not_replaceable", option="output", path=str(target), error="Input/output error")
    for words in ((), ("--force",)):
        code, said = main(part, "--output", target, *words)
        assert code == 2 and said.endswith("error: {}\n".format(expected)) and target.read_text() == "mine"


def test_file_is_written_without_lock_support(tmp_path, monkeypatch):
    """And what the system refuses otherwise is an error. No descriptor stays open."""
    opened = len(os.listdir("/proc/self/fd")) if Path("/proc/self/fd").exists() else None

    def fail(number):
        def flock(*_):
            raise OSError(number, "no")

        monkeypatch.setattr(file_lock.fcntl, "flock", flock)

    for number in sorted(file_lock._WITHOUT_LOCKS):
        fail(number)
        with locked(tmp_path / "a") as alone:
            assert not alone
        (tmp_path / ".b.1234.partial").touch()  # perhaps of a process that is writing it
        with whole_file(tmp_path / "b") as file:
            file.write(b"x")
        assert {path.name for path in tmp_path.iterdir()} == {"b", ".b.1234.partial"}
    fail(errno.EIO)
    with pytest.raises(OSError) as refused, locked(tmp_path / "a"):
        pass
    assert refused.value.errno == errno.EIO and not isinstance(refused.value, file_lock.Busy)
    assert opened is None or len(os.listdir("/proc/self/fd")) == opened


def test_a_lock_that_another_user_has_left_is_taken(tmp_path, monkeypatch):
    real, flags = os.open, []

    def refuse(path, how, *rest, **more):
        if str(path).endswith(".lock"):
            flags.append(how & (os.O_RDWR | os.O_RDONLY))
            if how & os.O_RDWR:
                raise PermissionError(13, "Permission denied")
        return real(path, how, *rest, **more)

    monkeypatch.setattr(file_lock.os, "open", refuse)
    with locked(tmp_path / "a") as alone:
        assert alone and flags == [os.O_RDWR, os.O_RDONLY]
    assert [*tmp_path.iterdir()] == []
