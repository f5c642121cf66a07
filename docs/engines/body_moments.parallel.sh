#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# GNU parallel: ranges of a list, on this machine or, with --sshlogin, on others that share its storage.
#
#     SCRIPT=operators/batch.py BLENDER=blender MANIFEST=files.list FOLDER=results COUNT=400 SIZE=100 \
#         body_moments.parallel.sh --jobs 2
#
set -eu
export SCRIPT BLENDER MANIFEST FOLDER SIZE PYTHON=${PYTHON:-python3} OPTIONS=${OPTIONS:-}
seq 0 "$SIZE" $((COUNT - 1)) | parallel --env SCRIPT --env BLENDER --env MANIFEST --env FOLDER --env SIZE --env PYTHON \
    --env OPTIONS "$@" \
    '"$PYTHON" "$SCRIPT" measure --blender "$BLENDER" --manifest "$MANIFEST" --range {}:$(({} + SIZE)) --jobs 1 --resume \
        --errors-exit-0 --format jsonl --output "$FOLDER/part-{}.jsonl" $OPTIONS'
ls "$FOLDER"/part-*.jsonl | sort -V | xargs "$PYTHON" "$SCRIPT" merge --force --output "$FOLDER/all.jsonl"
