# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in steps, run to its end."""


def run(steps):
    """Return the value of a generator, whose shares grow from 0 to 1 at most."""
    shares = []
    while True:
        try:
            shares.append(next(steps))
        except StopIteration as done:
            assert shares == sorted(shares)
            assert all(0.0 <= share <= 1.0 for share in shares)
            return done.value
