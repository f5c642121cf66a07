#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Slurm: ranges of a list are the tasks of an array. A task that is requeued goes on where it was.
#
#     export SCRIPT=operators/batch.py BLENDER=blender MANIFEST=files.list FOLDER=results SIZE=100
#     job=$(sbatch --parsable --requeue --array=0-3 body_moments.slurm.sh)   # four tasks: files 0 to 399
#     sbatch --dependency=afterok:$job --wrap \
#         'ls $FOLDER/part-*.jsonl | sort -V | xargs python3 $SCRIPT merge --force --output $FOLDER/all.jsonl'
#
#SBATCH --job-name=body_moments
#SBATCH --cpus-per-task=2
set -u
begin=$((SLURM_ARRAY_TASK_ID * ${SIZE:-100}))
"${PYTHON:-python3}" "$SCRIPT" measure --blender "${BLENDER:-blender}" --manifest "$MANIFEST" \
    --range "$begin:$((begin + ${SIZE:-100}))" --jobs "${SLURM_CPUS_PER_TASK:-2}" --resume --errors-exit-0 \
    --format jsonl --output "$FOLDER/part-$SLURM_ARRAY_TASK_ID.jsonl" ${OPTIONS:-}
