#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# GNU parallel: the parts of a list, on this machine or, with --sshlogin, on others that share its storage.
#
#     python3 operators/batch.py manifest parts/ --parts 4 --output files.list
#     ADDON=. BLENDER=blender MANIFEST=files.list FOLDER=results body_moments.parallel.sh --jobs 2
#
# The results are in FOLDER/JOB. JOB is the time, or a name: a run of the same name goes on with its results.
set -eu
export ADDON BLENDER MANIFEST PYTHON=${PYTHON:-python3} TIMEOUT=${TIMEOUT:-600} OPTIONS=${OPTIONS:-}
export RESULTS=$FOLDER/${JOB:-$(date +%Y-%m-%d-%H%M%S)}
mkdir -p "$RESULTS"
parts=$("$PYTHON" -c 'import json, sys; print(json.loads(open(sys.argv[1]).readline()).get("parts", 1))' "$MANIFEST")
seq 1 "$parts" | parallel --env ADDON --env BLENDER --env MANIFEST --env PYTHON --env TIMEOUT --env OPTIONS --env RESULTS \
    "$@" \
    '"$PYTHON" "$ADDON/operators/batch.py" measure --blender "$BLENDER" --manifest "$MANIFEST" --part {} --jobs 1 \
        --timeout "$TIMEOUT" --resume --errors-exit-0 --format jsonl --output "$RESULTS/part-{}.jsonl" $OPTIONS'
"$PYTHON" "$ADDON/operators/batch.py" merge --force --manifest "$MANIFEST" --output "$RESULTS/all.jsonl" \
    "$RESULTS"/part-*.jsonl
