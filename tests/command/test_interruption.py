# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl+C and other signals."""

import os
import signal

import numpy as np
import pytest
from body_moments.command.interruption import check_interruption, interruptible
from body_moments.operators import batch

from tests.blender.batch_files import add_box

pytestmark = [
    pytest.mark.usefixtures("scene"),
    pytest.mark.skipif(os.name == "nt", reason="not on this system: signals"),
]
STOPPING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP) if os.name != "nt" else ()


@pytest.fixture(autouse=True)
def handlers():
    """Restore the handlers after a test.

    Ctrl+C has its handler even in the background of a shell.
    """
    before = {number: signal.getsignal(number) for number in STOPPING}
    signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


def test_ctrl_c_raises_and_is_remembered():
    noted = []
    signal.signal(signal.SIGINT, lambda *_: noted.append(1))
    with interruptible():
        check_interruption()
        try:
            signal.raise_signal(signal.SIGINT)
        except KeyboardInterrupt:
            noted.append(2)
        with pytest.raises(KeyboardInterrupt):  # an importer has made an error of its own of it
            check_interruption()
    signal.raise_signal(signal.SIGINT)
    assert noted == [2, 1]
    with interruptible():
        check_interruption()  # the next one begins anew


def test_ignored_signals_stay_ignored():
    for number in STOPPING:
        signal.signal(number, signal.SIG_IGN)
    with interruptible():
        for number in STOPPING:
            signal.raise_signal(number)
    assert {signal.getsignal(number) for number in STOPPING} == {signal.SIG_IGN}


@pytest.mark.parametrize("number", STOPPING)
def test_second_signal_does_not_disturb_the_cleanup(number):
    before = {one: signal.signal(one, lambda *_: None) for one in STOPPING}
    own = {one: signal.getsignal(one) for one in STOPPING}
    with pytest.raises(KeyboardInterrupt), interruptible():
        try:
            signal.raise_signal(number)
        finally:
            for other in STOPPING:
                signal.raise_signal(other)
    assert {one: signal.getsignal(one) for one in STOPPING} == own and len(before) == 3


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="not on this system: /dev/full")
def test_unwritable_result_fails_every_command(tmp_path, capsys):
    """Each gives 0 where there is room; a fault of the program is one all the same."""
    add_box("Other"), add_box("Box")
    result = tmp_path / "a.jsonl"
    link = (
        '<link name="a"><visual><geometry><box size="2 2 2"/></geometry></visual><inertial><mass '
        'value="8000"/>'
    )
    link += '<inertia ixx="5333.3333" iyy="5333.3333" izz="5333.3333"/></inertial></link>'
    (tmp_path / "a.urdf").write_text("<robot>{}</robot>".format(link))
    (tmp_path / "list").write_text("")
    np.savez(tmp_path / "a.npz", points=np.eye(3, 2), simplices=[[0, 1, 2]])
    np.save(tmp_path / "a.npy", np.ones((2, 2, 2)))
    assert (
        batch.main(
            ["measure", "--signature", "--format", "jsonl", "--output", str(result)], channel=-1
        )
        == 0
    )
    commands = [
        *(
            ["measure"],
            ["--help"],
            ["measure", "-h"],
            ["audit", tmp_path / "a.urdf"],
            ["simplex", tmp_path / "a.npz"],
        ),
        *(
            ["similar", result, "--to", "Box"],
            ["summary", result],
            ["merge", result],
            ["to-csv", result],
        ),
        *(["report", result], ["compare", result, result], ["manifest", tmp_path / "a.npy"]),
    ]
    with open("/dev/full", "wb") as full, open(tmp_path / "out", "wb") as out:
        for words in commands:
            words = [*map(str, words)]
            assert batch.main(words, channel=out.fileno()) == 0, words
            assert "usage" not in capsys.readouterr().err
            assert batch.main(words, channel=full.fileno()) == 1, words
            assert "cannot be written: No space left on device" in capsys.readouterr().err
