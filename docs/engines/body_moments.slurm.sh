#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Slurm: the parts of a list are the tasks of an array. A task that is requeued goes on where it was. Then one more job,
# with the number of the array, joins the results. They are in FOLDER/NUMBER.
#
#     python3 operators/batch.py manifest parts/ --parts 4 --output files.list
#     export ADDON=. BLENDER=blender MANIFEST=files.list FOLDER=results
#     job=$(sbatch --parsable --requeue --array=1-4 body_moments.slurm.sh)
#     sbatch --dependency=afterok:$job body_moments.slurm.sh $job
#
#SBATCH --job-name=body_moments
#SBATCH --cpus-per-task=2
#SBATCH --mem=8G
#SBATCH --time=04:00:00
set -eu
results=$FOLDER/${1:-$SLURM_ARRAY_JOB_ID}
batch() { "${PYTHON:-python3}" "$ADDON/operators/batch.py" "$@"; }
if [ $# -gt 0 ]; then
    batch merge --force --manifest "$MANIFEST" --output "$results/all.jsonl" "$results"/part-*.jsonl
    exit
fi
mkdir -p "$results"
jobs=${SLURM_CPUS_PER_TASK:-2}
memory=$((${SLURM_MEM_PER_NODE:-8192} * 8 / 10 / jobs))  # MB for one file, of the job's own memory
batch measure --blender "${BLENDER:-blender}" --manifest "$MANIFEST" --part "$SLURM_ARRAY_TASK_ID" --jobs "$jobs" \
    --timeout "${TIMEOUT:-600}" --memory-mb "$memory" --resume --errors-exit-0 --format jsonl \
    --output "$results/part-$SLURM_ARRAY_TASK_ID.jsonl" ${OPTIONS:-}
