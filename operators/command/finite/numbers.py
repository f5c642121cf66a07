# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What all formats share: files as bytes, tables of numbers, and the numbers that may be large in a text."""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ....core.streams.misread import MAX_FLOAT32, Data
from ....core.verdict.finding import FileError, Finding
from ....core.verdict.number_text import parse_number

BLOCK = 1 << 18  # bytes of text at a time, and numbers, so that what is computed of them stays in the cache
_THREADS = min(4, os.cpu_count() or 1)
OVERLAP = 64  # bytes that blocks of text share, so that none cuts what makes a number suspicious
MALFORMED = (ValueError, KeyError, IndexError, TypeError, AttributeError, RecursionError, struct.error, zlib.error)


def refuse(count: int, place: Finding) -> None:
    if count:
        raise FileError("non_finite_coordinates", count=count, place=place.as_record())


# Tables of numbers


def bad_in_table(rows: NDArray) -> tuple[int, int]:
    """How many numbers of (n, k) are not finite in float32, and the first row that has one."""
    if rows.dtype.kind != "f":
        return 0, 0
    count, first = 0, 0
    step = max(1, BLOCK // (8 * rows.shape[1]))
    with np.errstate(over="ignore", invalid="ignore"):
        for start in range(0, len(rows), step):
            block = np.ascontiguousarray(rows[start : start + step])
            # A block's smallest and largest are NaN where one of its numbers is.
            if block.max() < MAX_FLOAT32 and block.min() > -MAX_FLOAT32:
                continue
            bad = ~(np.abs(block) < MAX_FLOAT32)
            if not count:
                first = start + int(np.argmax(bad.any(axis=1)))
            count += int(np.count_nonzero(bad))
    return count, first


# Text


def suspicious(data: Data) -> Iterator[int]:
    """Places in a text, ascending, of what may be a number that is not finite: nan, inf, 1.#IND, and large exponents
    or many digits, of which there is little in a sound file.
    """
    view = np.frombuffer(data, np.uint8)
    with ThreadPoolExecutor(_THREADS) as threads:
        for places in threads.map(partial(_suspicious_in_block, view), range(0, len(view), BLOCK)):
            yield from places


def _suspicious_in_block(view: NDArray[np.uint8], begin: int) -> list[int]:
    text = view[begin : begin + BLOCK + OVERLAP]
    if len(text) < BLOCK + OVERLAP:
        text = np.concatenate([text, np.zeros(OVERLAP, np.uint8)])
    lower = text | np.uint8(0x20)
    places = np.unique(np.concatenate([_words(text, lower), _large(text, lower)]))
    # At BLOCK too: the next block does not see what is before its first byte.
    return (begin + places[places <= BLOCK]).tolist()


def _words(text: NDArray[np.uint8], lower: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Where the n of nan or inf is, or the # of 1.#IND and its like."""
    at = 1 + np.flatnonzero(lower[1:-2] == ord("n"))
    after = lower[at + 1]
    nan, inf = at[after == ord("a")], at[after == ord("f")]
    nan, inf = nan[lower[nan + 2] == ord("n")], inf[lower[inf - 1] == ord("i")]
    at = 1 + np.flatnonzero(text[1:] == ord("#"))
    return np.concatenate([nan, inf, at[text[at - 1] == ord(".")]])


def _large(text: NDArray[np.uint8], lower: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Where numbers of 1e38 and more may be: those with an exponent of at least 9, or with 31 digits in a row."""
    digit = (text - ord("0")) < 10  # uint8: what is below wraps around
    plus = text == ord("+")
    at = np.flatnonzero((lower[:-4] == ord("e")) & (digit | plus)[1:-3])
    after = at + 1 + plus[at + 1]
    one, two, three = (digit[after + shift] for shift in range(3))
    small = one & ~two | two & ~three & (text[after] == ord("0")) & (text[after + 1] != ord("9"))
    exponents = at[one & ~small]
    whole = np.flatnonzero(digit[: len(digit) // 8 * 8].view(np.uint64) == 0x0101010101010101)
    runs = whole[:-2][whole[2:] == whole[:-2] + 2]  # 31 digits hold three words of eight
    return np.concatenate([exponents, 8 * runs])


def is_finite(word: bytes) -> bool:
    try:
        return abs(parse_number(word.decode("utf-8", "replace"))) < MAX_FLOAT32
    except ValueError:
        return False


def count_bytes(data: Data, byte: bytes, begin: int, end: int) -> int:
    view = np.frombuffer(data, np.uint8, end - begin, begin)
    return sum(int(np.count_nonzero(view[i : i + BLOCK] == byte[0])) for i in range(0, len(view), BLOCK))
